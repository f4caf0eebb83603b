//! Our methods behind the interface of those of others.

use switchback_identify::Method;
use switchback_identify::excitation::Direction;
use switchback_identify::pulse::{PulseData, PulseMethod};
use switchback_model::Record;
use switchback_model::hysteresis::Branch;
use switchback_study::foreign::{Design, Estimates, ForeignError, ForeignEstimator, Records};

/// One of our methods that need both pulse experiments and nothing else, as an estimator sees it that knows records alone.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct OwnMethod(Method);

impl OwnMethod {
    /// Those that there are.
    pub const ALL: [Method; 5] =
        [Method::Joint, Method::Efficient, Method::Instrumental, Method::LinearArx, Method::Memoryless];

    /// The method; `None` where it needs other experiments.
    pub fn new(method: Method) -> Option<Self> {
        Self::ALL.contains(&method).then_some(Self(method))
    }

    fn estimates(self, design: &Design, records: &Records<'_>) -> Result<Estimates, String> {
        let data = |k: usize| -> Result<PulseData, String> {
            let experiment = &design.experiments[k];
            let branch = match experiment.direction {
                Direction::Descendant => Branch::Descending,
                Direction::Ascendant => Branch::Ascending,
            };
            let record = Record::new(experiment.v.clone(), records.y[k].to_vec());
            let record = record.map_err(|error| error.to_string())?;
            PulseData::from_record(&record, branch, design.order, 0).map_err(|error| error.to_string())
        };
        let (descendant, ascendant) = (data(0)?, data(1)?);
        let both = [&descendant, &ascendant];
        let method = match self.0 {
            Method::Efficient => PulseMethod::Efficient(&both),
            Method::Instrumental => PulseMethod::Instrumental(&both),
            Method::LinearArx => PulseMethod::LinearArx(&both),
            Method::Memoryless => PulseMethod::Memoryless(&both),
            Method::Joint | Method::Free | Method::PaperDescendant | Method::PaperAscendant => {
                PulseMethod::Joint { descendant: &descendant, ascendant: &ascendant }
            }
        };
        let fit = method.fit().map_err(|error| error.to_string())?;
        let named = names(design.order, [descendant.points(), ascendant.points()]).zip(fit.parameters());
        let found: Vec<(String, (f64, f64))> = named.map(|(name, x)| (name, (x.value, x.se))).collect();
        let asked = |name: &String| {
            let parameter = found.iter().find(|(found, _)| found == name);
            parameter.map(|(_, x)| *x).ok_or_else(|| format!("it has no parameter {name}"))
        };
        design.parameters.iter().map(asked).collect()
    }
}

/// The names of all parameters of both borders.
fn names(order: usize, points: [usize; 2]) -> impl Iterator<Item = String> {
    let coefficients = |letter: char| (1..=order).map(move |i| format!("{letter}{i}"));
    let border = |(label, points)| (1..=points).map(move |j| format!("F_{label}(V{j})"));
    let borders = ["desc", "asc"].into_iter().zip(points).flat_map(border);
    coefficients('a').chain(coefficients('b')).chain(borders)
}

impl ForeignEstimator for OwnMethod {
    fn begin(&self) -> Result<String, ForeignError> {
        Ok(env!("CARGO_PKG_VERSION").to_owned())
    }

    fn estimate(&self, design: &Design, records: &[Records<'_>]) -> Vec<Result<Estimates, String>> {
        records.iter().map(|records| self.estimates(design, records)).collect()
    }
}
