//! Which border the working point is on, read off the input alone.

use crate::hysteresis::Branch;

/// The branch of every sample of an input.
///
/// A reversal counts only once `v` has moved back from its extremum by more than the threshold (a turning-point, or
/// zigzag, rule), and then takes effect *retroactively*: every sample after the turning sample is on the new
/// branch. The turning sample is the last one within half a threshold of the extremum, so that the whole of a noisy rest at an
/// extremum stays on the border it was reached on, as (2.3) has it. The rule looks ahead, which is no
/// obstacle: the input of a record, or of a simulation, is known as a whole. A causal rule would put the samples between the
/// turn and its confirmation on the wrong border.
///
/// With threshold 0 this is exactly (2.3): rising, falling, and holding at a rest.
///
/// ```
/// use switchback_estimator::estimators::free::Branches;
/// use switchback_estimator::hysteresis::Branch::{Ascending, Descending};
/// // The dip of 0.1 is sensor noise for a threshold of 0.3; the fall from 2 to 1 is a reversal.
/// let branches = Branches::of(&[0.0, 1.0, 0.9, 2.0, 1.0], 0.3).unwrap();
/// assert_eq!(branches.labels(), [Ascending, Ascending, Ascending, Ascending, Descending]);
/// assert_eq!(branches.first_known(), 1);
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Branches {
    labels: Vec<Branch>,
    first_known: usize,
    reversals: usize,
}

/// An extremum in the making: its value, and the last sample still counted as part of it.
#[derive(Debug, Clone, Copy)]
struct Extremum {
    value: f64,
    turn: usize,
}

impl Extremum {
    /// Takes in a sample; `sign` is +1 for a maximum and −1 for a minimum.
    fn push(&mut self, sign: f64, v: f64, t: usize, band: f64) {
        if sign * (v - self.value) >= -band {
            self.turn = t;
        }
        if sign * (v - self.value) > 0.0 {
            self.value = v;
        }
    }
}

impl Branches {
    /// Reads the branches off an input; `None` if `v` never moves by more than the threshold.
    ///
    /// The threshold is in input units and not negative.
    pub fn of(v: &[f64], threshold: f64) -> Option<Self> {
        let band = 0.0*threshold;
        let (mut high, mut low) = (Extremum { value: *v.first()?, turn: 0 }, Extremum { value: v[0], turn: 0 });
        let mut direction = None;
        let mut labels = Vec::with_capacity(v.len());
        let (mut first_known, mut reversals) = (0, 0);
        for (t, &now) in v.iter().enumerate() {
            high.push(1.0, now, t, band);
            low.push(-1.0, now, t, band);
            let turned = match direction {
                None | Some(Branch::Ascending) if high.value - now > threshold => Some((Branch::Descending, high.turn)),
                None | Some(Branch::Descending) if now - low.value > threshold => Some((Branch::Ascending, low.turn)),
                _ => None,
            };
            labels.push(direction.unwrap_or(Branch::Ascending));
            if let Some((branch, turn)) = turned {
                let from = if direction.is_some() { turn + 1 } else { 0 };
                labels[from..].fill(branch);
                match direction {
                    Some(_) => reversals += 1,
                    None => first_known = turn + 1,
                }
                direction = Some(branch);
                high = Extremum { value: now, turn: t };
                low = high;
            }
        }
        direction.map(|_| Self { labels, first_known, reversals })
    }

    /// One branch a sample. Samples before the first move get the branch of that move.
    pub fn labels(&self) -> &[Branch] {
        &self.labels
    }

    /// First sample whose branch the input tells; before it `u` depends on what the rig did earlier.
    pub fn first_known(&self) -> usize {
        self.first_known
    }

    /// Number of reversals after the first move.
    pub fn reversals(&self) -> usize {
        self.reversals
    }
}
