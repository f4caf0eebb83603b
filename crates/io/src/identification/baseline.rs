//! An identification beside what a user would otherwise pick.

use super::flag::Flag;
use switchback_identify::Method;
use switchback_identify::statistics::MeanInterval;

/// How well another model simulates the held-out records.
#[derive(Debug, Clone, PartialEq)]
pub struct Baseline {
    /// Its method.
    pub method: Method,
    /// Fit of its free runs over all held-out records, per cent.
    pub fit_percent: f64,
    /// The same of the identification, over the same samples.
    pub own_fit_percent: f64,
    /// Mean over those samples of the identification's squared error less this one's, as a share of the output's variance there, with its 95 %
    /// interval; `None` where the held-out records are too short for their memory.
    pub excess: Option<MeanInterval>,
}

impl Baseline {
    /// Points of held-out fit that the identification has above this one.
    pub(crate) fn lead(&self) -> f64 {
        self.own_fit_percent - self.fit_percent
    }

    /// Speaks up where the identification simulates worse than this, and says whether beyond chance.
    pub(super) fn flag(&self, own: Method) -> Option<Flag> {
        if self.lead() >= 0.0 {
            return None;
        }
        let Self { method, fit_percent, own_fit_percent, .. } = self;
        let (kind, verdict) = match self.excess {
            Some(excess) if excess.low > 0.0 => (
                "worse_than_yardstick",
                format!("beyond chance (block bootstrap, 95 %): prefer `--method {method}`"),
            ),
            Some(_) => (
                "no_better_than_yardstick",
                format!(
                    "within chance (block bootstrap, 95 %): nothing held out speaks for `{own}`, so prefer the simpler `--method {method}`"
                ),
            ),
            None => (
                "no_better_than_yardstick",
                "but too little is held out to say whether by chance: hold out more".to_owned(),
            ),
        };
        let fits =
            format!("{own_fit_percent:.1} % of fit on the held-out records against {fit_percent:.1} %");
        Some(Flag::new(kind, self.lead(), format!("`{own}` reaches {fits} by `{method}`, {verdict}")))
    }
}
