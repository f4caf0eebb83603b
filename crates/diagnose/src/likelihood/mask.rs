//! Samples that have no say in a fit.

use std::sync::Arc;

use crate::likelihood::whitener::LEAD;
use crate::model::augmented::{AugmentedModel, Saturation};
use crate::records::dataset::{ScaledRecord, WARM_UP};
use crate::records::motion::{ReversalRule, settled};

/// A play that takes a larger share of a record to show where it stood is not waited for.
const WAITED: f64 = 0.25;

/// Which counted samples of a record have no say.
#[derive(Debug, Clone, Default)]
pub(crate) struct Mask {
    /// By sample, where any has none.
    pub(crate) out: Option<Arc<[bool]>>,
    /// Those whose error is known, but not the errors before it that predict it.
    pub(crate) innovation_share: Arc<[usize]>,
}

/// Without a say are the samples before it is known where the play stands, as the first samples of every record are, and those with
/// an output at a limit of the sensor.
pub(crate) fn masked(scaled: &ScaledRecord, augmented: &AugmentedModel, rule: ReversalRule) -> Mask {
    let mut out = vec![false; scaled.y.len() - scaled.from];
    let mut innovation_share = Vec::new();
    if !augmented.play.is_none() {
        // What comes later is not waited for.
        let longest = (WAITED * out.len() as f64).ceil() as usize;
        let initial_condition = &scaled.v[..(scaled.from + longest).min(scaled.v.len())];
        let waited = (settled(initial_condition, augmented.play, rule) + WARM_UP).saturating_sub(scaled.from);
        if waited < longest {
            out[..waited].fill(true);
        }
    }
    if let Some(limits) = augmented.saturation {
        // The equation reaches back by its order, its errors by what whitens them.
        let order = limits.order.min(LEAD);
        let reach = limits.order.saturating_add(augmented.noise.reach()).min(LEAD);
        let since = since_a_limit(scaled, limits).skip(scaled.from);
        for (k, (masked, since)) in out.iter_mut().zip(since).enumerate() {
            if since > order && since <= reach && !*masked {
                innovation_share.push(k);
            }
            *masked |= since <= reach;
        }
    }
    Mask { out: out.contains(&true).then(|| out.into()), innovation_share: innovation_share.into() }
}

/// Samples since the output was last at a limit, 0 where it is there.
fn since_a_limit(scaled: &ScaledRecord, limits: Saturation) -> impl Iterator<Item = usize> {
    scaled.y.iter().scan(usize::MAX, move |since, y| {
        let at_a_limit = *y <= limits.low || *y >= limits.high;
        *since = if at_a_limit { 0 } else { since.saturating_add(1) };
        Some(*since)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::augmented::NoiseLaw;
    use crate::records::motion::Play;
    use crate::testing::small_dataset;

    #[test]
    fn a_play_is_waited_for_until_it_was_crossed_but_not_for_long() {
        let (dataset, _) = small_dataset();
        let scaled = dataset.fit().next().expect("a record");
        let of = |width: f64, v: &[f64]| {
            let augmented = AugmentedModel { play: Play { width, taper: 0.0 }, ..AugmentedModel::default() };
            masked(&ScaledRecord { v: v.to_vec().into(), ..scaled.clone() }, &augmented, dataset.rule).out
        };
        // Slowly down from the middle: a play of a tenth is crossed at sample 51.
        let count = scaled.v.len();
        let slow: Vec<f64> = (0..count).map(|t| 0.5 - 0.002 * t.min(200) as f64).collect();
        let mask = of(0.1, &slow).expect("samples without a say");
        let waited = mask.iter().take_while(|masked| **masked).count();
        assert!(mask[waited..].iter().all(|masked| !masked));
        assert!((waited + scaled.from).abs_diff(51 + WARM_UP) <= 1, "{waited} after {}", scaled.from);
        assert!(of(0.0, &slow).is_none());
        // Never crossed.
        assert!(of(0.7, &slow).is_none());
    }

    #[test]
    fn errors_near_a_limit_are_known_where_their_past_is_not() {
        let (dataset, _) = small_dataset();
        let mut scaled = dataset.fit().next().expect("a record").clone();
        let at = scaled.from + 100;
        scaled.y.fill(0.0);
        scaled.y[at] = 9.0;
        let of = |ar: Vec<f64>| {
            let limits = Saturation { low: f64::NEG_INFINITY, high: 9.0, order: 2 };
            let noise = NoiseLaw { ar, ..NoiseLaw::default() };
            let augmented = AugmentedModel { saturation: Some(limits), noise, ..AugmentedModel::default() };
            let mask = masked(&scaled, &augmented, dataset.rule);
            let out = mask.out.expect("a sample at the limit");
            (out.iter().filter(|out| **out).count(), mask.innovation_share.to_vec())
        };
        assert_eq!(of(vec![]), (3, vec![]));
        assert_eq!(of(vec![0.5; 2]), (5, vec![103, 104]));
    }
}
