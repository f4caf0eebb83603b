//! The structure that cross-validation of the free run chooses, as a start of a simulator.

use super::structure::{PRESENT, ROUNDS, SIMULATION, Structure};
use crate::evidence::nominal;
use crate::likelihood::engine::{Fit, FitContext, fit};
use crate::model::augmented::AugmentedModel;
use crate::nominal::given::scaled;
use crate::nominal_model::NominalModel;
use crate::records::dataset::Dataset;
use switchback_model::hysteresis::Branch;
use switchback_model::rig::Rig;

/// Order and lead by the identifier, and its model.
#[derive(Debug)]
pub(crate) struct Identified {
    pub(crate) structure: Structure,
    model: NominalModel,
}

impl Identified {
    /// Of the fit records of a rig; none where they show no model, or one without poles.
    pub(crate) fn of(rig: &Rig) -> Option<Self> {
        let records: Vec<_> = rig.fit_records().map(|r| &r.record).collect();
        let of = |delay| nominal(&records, (None, delay)).ok()?;
        let free = of(None)?;
        // No machine answers before its input: effects hide behind a model that does.
        let system = if 1 - free.linear.lag() > PRESENT { of(Some(-PRESENT))? } else { free };
        let a = system.linear.a().to_vec();
        let structure = Structure { lead: 1 - system.linear.lag(), ..Structure::of_order(a.len()) };
        let mut b = system.linear.b();
        b.resize(a.len(), 0.0);
        let border = |branch| system.borders.points(branch).collect();
        let (descending, ascending) = (border(Branch::Descending), border(Branch::Ascending));
        (!a.is_empty()).then_some(Self { structure, model: NominalModel { a, b, descending, ascending } })
    }

    /// Its fit as a simulator, on its own knots.
    pub(crate) fn simulator(&self, dataset: &Dataset) -> Option<Fit> {
        let led = self.structure.applied(dataset).judged_by(SIMULATION);
        let start = scaled(&led, &self.model).ok()?;
        let context = FitContext { dataset: &led, grid: &start.grid, known: None };
        fit(context, &|_| AugmentedModel::default(), &[], &start.linear, ROUNDS)
    }
}
