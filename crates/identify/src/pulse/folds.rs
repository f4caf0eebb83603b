//! A periodic record folded over its period: what `instrumental` needs of it.

/// How many lags of the noise's autocovariance are kept beyond the order `n` of the system: its autoregression has order `n + MORE_LAGS`.
const MORE_LAGS: usize = 5;

/// Means of a periodic experiment's output over its periods, and the autocovariance of what they leave.
///
/// ```text
/// ȳ_p  = Σ_{t ≡ p mod T} y(t) / K_p                                   p = 0…T−1
/// V_k  = Σ_t (y(t) − ȳ_p(t)) (y(t−k) − Σ_{s ≡ p(t)} y(s−k)/K_p(t))    k = 0…L
/// ```
///
/// The response to a periodic input is the same in every period, so that it drops out of `V`: `V_k/(N − T)` estimates the autocovariance of the
/// output's noise, whatever its colour. `y` is taken about the reference of the [`PulseData`](super::PulseData) that holds the folds.
#[derive(Debug, Clone, PartialEq)]
pub struct Folds {
    /// The level (from 0) that the input visits at each phase; `None` where it rests at the satellite.
    pub visits: Vec<Option<usize>>,
    /// `ȳ`, `T` of them.
    pub means: Vec<f64>,
    /// `V_0…V_L`.
    pub within: Vec<f64>,
    /// `N`.
    pub samples: f64,
}

impl Folds {
    /// The lags `L` that [`PulseMethod::Instrumental`](super::PulseMethod::Instrumental) asks for where the system has order `order`.
    pub const fn lags(order: usize) -> usize {
        order + MORE_LAGS
    }

    /// `T`.
    pub(crate) fn period(&self) -> usize {
        self.means.len()
    }

    /// Folds a record from sample `first` on, by the definition: `visits(t)` is the level that the input visits at `t`. `None` if the
    /// visits do not repeat, or not twice.
    ///
    /// As many samples as there are lags must precede `first`.
    pub(super) fn of_record(
        y: &[f64],
        (first, lags): (usize, usize),
        reference: f64,
        visits: impl Fn(usize) -> Option<usize>,
    ) -> Option<Self> {
        let seen: Vec<Option<usize>> = (first..y.len()).map(&visits).collect();
        let period = period_of(&seen)?;
        let mut sums = vec![0.0; period * (lags + 1)];
        let mut counts = vec![0.0; period];
        let mut within = vec![0.0; lags + 1];
        for t in first..y.len() {
            let p = (t - first) % period;
            counts[p] += 1.0;
            for k in 0..=lags {
                sums[p * (lags + 1) + k] += y[t - k] - reference;
            }
        }
        for t in first..y.len() {
            let p = (t - first) % period;
            let left = |k: usize| y[t - k] - reference - sums[p * (lags + 1) + k] / counts[p];
            let now = left(0);
            within.iter_mut().enumerate().for_each(|(k, v)| *v += now * left(k));
        }
        Some(Self {
            visits: seen[..period].to_vec(),
            means: (0..period).map(|p| sums[p * (lags + 1)] / counts[p]).collect(),
            within,
            samples: seen.len() as f64,
        })
    }

    /// The same output about another level.
    pub(super) fn shifted(&self, level: f64) -> Self {
        Self { means: self.means.iter().map(|mean| mean - level).collect(), ..self.clone() }
    }
}

/// The shortest period of a sequence that has visits and repeats at least once in whole.
fn period_of(seen: &[Option<usize>]) -> Option<usize> {
    let first = seen.iter().position(Option::is_some)?;
    let again = (first + 1..seen.len()).filter(|t| seen[*t] == seen[first]);
    let mut periods = again.map(|t| t - first).take_while(|period| 2 * period <= seen.len());
    periods.find(|&period| seen[period..].iter().zip(seen).all(|(later, earlier)| later == earlier))
}
