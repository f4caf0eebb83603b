//! What the model of the records as they are leaves, and what a fault adds to that.

use super::injection_error::InjectionError;
use switchback_identify::free::{FreeError, Identified, InputMap, Model, Settings, identify};
use switchback_model::record::Record;
use switchback_model::rig::{Rig, RigRecord};

/// A residual below this share of what the output moves is what the minimisation leaves.
const NOTHING: f64 = 1e-6;

/// The base's model and what it leaves on the judged records.
#[derive(Debug)]
pub(crate) struct Base {
    /// As it was identified.
    pub(super) identified: Identified,
    /// Those of a diagnosis' nominal model, the chosen structure fixed for every identification anew.
    settings: Settings,
    /// `r` of each judged record, from the first sample that is simulated.
    left: Vec<Vec<f64>>,
    /// Root mean square of all.
    pub(crate) residual: f64,
}

impl Base {
    pub(crate) fn new(rig: &Rig) -> Result<Self, InjectionError> {
        let open = Settings {
            order: rig.order,
            interval: rig.interval,
            whiten: false,
            undersmooth: false,
            input_noise: false,
            ..Settings::new(InputMap::Borders)
        };
        let identified = from_fit_records(rig, &open)?;
        let (structure, rule) = (identified.selection.structure, identified.model.rule());
        let settings = Settings {
            order: Some(structure.order),
            delay: Some(structure.delay),
            knots: Some(identified.selection.knots),
            threshold: Some(rule.threshold),
            timing: Some(rule.timing),
            ..open
        };
        Self::measured(rig, identified, settings)
    }

    /// The same of other records of the machine: identified anew as what was chosen here.
    pub(super) fn of_other(&self, rig: &Rig) -> Result<Self, InjectionError> {
        let settings = self.settings;
        Self::measured(rig, from_fit_records(rig, &settings)?, settings)
    }

    fn measured(rig: &Rig, identified: Identified, settings: Settings) -> Result<Self, InjectionError> {
        let left: Vec<Vec<f64>> = judged(rig).map(|r| missed(&identified.model, &r.record)).collect();
        let residual = root_mean_square(left.iter().flatten().copied());
        let moves = judged(rig).map(|r| {
            let y = r.record.y();
            let mean = y.iter().sum::<f64>() / y.len() as f64;
            root_mean_square(y.iter().map(|y| y - mean))
        });
        if residual <= NOTHING * moves.fold(0.0, f64::max) || residual.is_nan() {
            return Err(InjectionError::NoResidual);
        }
        Ok(Self { identified, settings, left, residual })
    }

    /// `rms(r' − r) / rms(r)` with the base's own model on the planted records.
    pub(super) fn raw(&self, injected: &Rig) -> f64 {
        self.added(&self.identified.model, injected)
    }

    /// The same with a model identified anew; infinite where there is none.
    pub(crate) fn surviving(&self, injected: &Rig) -> f64 {
        match from_fit_records(injected, &self.settings) {
            Ok(anew) => self.added(&anew.model, injected),
            Err(_) => f64::INFINITY,
        }
    }

    fn added(&self, model: &Model, injected: &Rig) -> f64 {
        let differences = judged(injected).zip(&self.left).flat_map(|(record, before)| {
            let now = missed(model, &record.record);
            // Both end with the record; a planted input may move later.
            let common = now.len().min(before.len());
            let (now, before) = (now[now.len() - common..].to_vec(), &before[before.len() - common..]);
            now.into_iter().zip(before).map(|(now, before)| now - before).collect::<Vec<f64>>()
        });
        root_mean_square(differences) / self.residual
    }
}

fn from_fit_records(rig: &Rig, settings: &Settings) -> Result<Identified, FreeError> {
    identify(&rig.fit_records().map(|r| &r.record).collect::<Vec<_>>(), settings)
}

/// The held-out records; without any, those that models are fitted to.
fn judged(rig: &Rig) -> Box<dyn Iterator<Item = &RigRecord> + '_> {
    match rig.holdout_records().next() {
        Some(_) => Box::new(rig.holdout_records()),
        None => Box::new(rig.fit_records()),
    }
}

/// `y − ŷ` from the first sample that is simulated.
fn missed(model: &Model, record: &Record) -> Vec<f64> {
    let run = model.free_run(record);
    record.y()[run.start..].iter().zip(&run.y[run.start..]).map(|(y, simulated)| y - simulated).collect()
}

fn root_mean_square(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0_usize), |(sum, count), x| (sum + x * x, count + 1));
    (sum / count.max(1) as f64).sqrt()
}
