//! Samples that have no say in a fit.

use std::sync::Arc;

use crate::likelihood::whitener::LEAD;
use crate::model::assembly::{Assembly, Saturation};
use crate::records::campaign::{Track, WARM_UP};
use crate::records::motion::{ReversalRule, settled};

/// A play that takes a larger share of a record to show where it stood is not waited for.
const WAITED: f64 = 0.25;

/// Which counted samples of a track have no say.
#[derive(Debug, Clone, Default)]
pub(crate) struct Mask {
    /// By sample, where any has none.
    pub(crate) out: Option<Arc<[bool]>>,
    /// Those whose error is known, but not the errors before it that foretell it.
    pub(crate) unforetold: Arc<[usize]>,
}

/// Without a say are the samples before it is known where the play stands, as the first samples of every record are, and those with
/// an output at a limit of the sensor.
pub(crate) fn masked(track: &Track, assembly: &Assembly, rule: ReversalRule) -> Mask {
    let mut out = vec![false; track.y.len() - track.from];
    let mut unforetold = Vec::new();
    if !assembly.play.is_none() {
        // What comes later is not waited for.
        let longest = (WAITED * out.len() as f64).ceil() as usize;
        let beginning = &track.v[..(track.from + longest).min(track.v.len())];
        let waited = (settled(beginning, assembly.play, rule) + WARM_UP).saturating_sub(track.from);
        if waited < longest {
            out[..waited].fill(true);
        }
    }
    if let Some(limits) = assembly.saturation {
        // The equation reaches back by its order, its errors by what whitens them.
        let order = limits.order.min(LEAD);
        let reach = limits.order.saturating_add(assembly.noise.reach()).min(LEAD);
        let since = since_a_limit(track, limits).skip(track.from);
        for (k, (masked, since)) in out.iter_mut().zip(since).enumerate() {
            if since > order && since <= reach && !*masked {
                unforetold.push(k);
            }
            *masked |= since <= reach;
        }
    }
    Mask { out: out.contains(&true).then(|| out.into()), unforetold: unforetold.into() }
}

/// Samples since the output was last at a limit, 0 where it is there.
fn since_a_limit(track: &Track, limits: Saturation) -> impl Iterator<Item = usize> {
    track.y.iter().scan(usize::MAX, move |since, y| {
        let at_a_limit = *y <= limits.low || *y >= limits.high;
        *since = if at_a_limit { 0 } else { since.saturating_add(1) };
        Some(*since)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::assembly::NoiseLaw;
    use crate::records::motion::Play;
    use crate::testing::small_campaign;

    #[test]
    fn a_play_is_waited_for_until_it_was_crossed_but_not_for_long() {
        let (campaign, _) = small_campaign();
        let track = campaign.fit().next().expect("a track");
        let of = |width: f64, v: &[f64]| {
            let assembly = Assembly { play: Play { width, taper: 0.0 }, ..Assembly::default() };
            masked(&Track { v: v.to_vec().into(), ..track.clone() }, &assembly, campaign.rule).out
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

    #[test]
    fn errors_near_a_limit_are_known_where_their_past_is_not() {
        let (campaign, _) = small_campaign();
        let mut track = campaign.fit().next().expect("a track").clone();
        let at = track.from + 100;
        track.y.fill(0.0);
        track.y[at] = 9.0;
        let of = |ar: Vec<f64>| {
            let limits = Saturation { low: f64::NEG_INFINITY, high: 9.0, order: 2 };
            let noise = NoiseLaw { ar, ..NoiseLaw::default() };
            let assembly = Assembly { saturation: Some(limits), noise, ..Assembly::default() };
            let mask = masked(&track, &assembly, campaign.rule);
            let out = mask.out.expect("a sample at the limit");
            (out.iter().filter(|out| **out).count(), mask.unforetold.to_vec())
        };
        assert_eq!(of(vec![]), (3, vec![]));
        assert_eq!(of(vec![0.5; 2]), (5, vec![103, 104]));
    }
}
