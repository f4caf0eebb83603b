//! Samples that have no say in a fit.

use std::sync::Arc;

use crate::assembly::{Assembly, Saturation};
use crate::campaign::{Track, WARM_UP};
use crate::motion::{ReversalRule, settled};
use crate::whitener::LEAD;

/// A play that takes a larger share of a record to show where it stood is not waited for.
const WAITED: f64 = 0.25;

/// Which counted samples have no say, where there are any: those before it is known where the play stands, as the first samples of
/// every record have none, and those with an output at a limit of the sensor.
pub(crate) fn masked(track: &Track, assembly: &Assembly, rule: ReversalRule) -> Option<Arc<[bool]>> {
    let mut out = vec![false; track.y.len() - track.from];
    let known = if assembly.play.is_none() { 0 } else { settled(&track.v, assembly.play, rule) + WARM_UP };
    let waited = known.saturating_sub(track.from);
    if (waited as f64) < WAITED * out.len() as f64 {
        out[..waited].fill(true);
    }
    if let Some(limits) = assembly.saturation {
        let at_a_limit = limited(track, limits, assembly.noise.reach());
        out.iter_mut().zip(at_a_limit).for_each(|(masked, limited)| *masked |= limited);
    }
    out.contains(&true).then(|| out.into())
}

/// Which counted samples have an output at a limit among those the equation needs: it reaches back by its order, its errors by what
/// whitens them.
fn limited(track: &Track, limits: Saturation, whitener: usize) -> impl Iterator<Item = bool> {
    let reach = limits.order.saturating_add(whitener).min(LEAD);
    let at: Vec<bool> = track.y.iter().map(|y| *y <= limits.low || *y >= limits.high).collect();
    (track.from..track.y.len()).map(move |t| at[t - reach..=t].iter().any(|c| *c))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::Play;
    use crate::testing::small_campaign;

    #[test]
    fn a_play_is_waited_for_until_it_was_crossed_but_not_for_long() {
        let (campaign, _) = small_campaign();
        let track = campaign.fit().next().expect("a track");
        let of = |width: f64, v: &[f64]| {
            let assembly = Assembly { play: Play { width, taper: 0.0 }, ..Assembly::default() };
            masked(&Track { v: v.to_vec(), ..track.clone() }, &assembly, campaign.rule)
        };
        // Slowly down from the middle: a play of a tenth is crossed at sample 51.
        let count = track.v.len();
        let slow: Vec<f64> = (0..count).map(|t| 0.5 - 0.002 * t.min(200) as f64).collect();
        let mask = of(0.1, &slow).expect("samples without a say");
        let waited = mask.iter().take_while(|masked| **masked).count();
        assert!(mask[waited..].iter().all(|masked| !masked));
        assert!((waited + track.from).abs_diff(51 + WARM_UP) <= 1, "{waited} after {}", track.from);
        assert!(of(0.0, &slow).is_none());
        // Never crossed.
        assert!(of(0.7, &slow).is_none());
    }
}
