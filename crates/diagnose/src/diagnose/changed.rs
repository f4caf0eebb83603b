//! What has changed since a model was right: effects on top of it, the model itself held.
//!
//! Identifying the model anew takes much of a fault into its parameters. Where the model of the sound machine is given there is no need to: its
//! `A`, `B` and borders stay, and only what an effect adds is fitted. A model of another form is stood in for by a nominal model that is
//! identified from its predictions on these records, where that does as it does.

use switchback_model::rig::Rig;

use super::given_model::{GivenModel, predicted};
use super::nominal::Nominal;
use super::plan::{Plan, judged_scaled_records, note_what_the_records_lack};
use crate::attribution::PairEffort;
use crate::attribution::explain::Hypothesis;
use crate::error::DiagnoseError;
use crate::export::Exporter;
use crate::likelihood::engine::{Fit, FitContext, fit};
use crate::model::augmented::AugmentedModel;
use crate::nominal::given::scaled;
use crate::nominal::order::{Structure, best_simulator};
use crate::records::dataset::{Criterion, Dataset};
use crate::residuals::score::innovations;
use crate::residuals::spectrum::{independent_share, mean_square};
use crate::settings::{Model, Settings};
use crate::simulation::simulate::free_run;
use crate::workers::Workers;

/// Mean square by which what stands in for a model may differ from its predictions, over that by which these miss the records: an effect as
/// large as what was missed before changes ten times as much.
const FAITHFUL: f64 = 0.1;

/// The plan of a diagnosis on a given model that stays as it is; nothing where no model was given, or none that a nominal model can stand in
/// for.
///
/// # Errors
/// [`DiagnoseError`] where the given model is none.
pub(super) fn plan(
    workers: &impl Workers,
    (rig, model): (&Rig, &Model),
    records: &Dataset,
    settings: &Settings,
) -> Result<Option<Plan>, DiagnoseError> {
    let known = match model {
        Model::Identify => return Ok(None),
        Model::Given(model) => Some((Structure::of_order(model.a.len()), scaled(records, model)?)),
        Model::Predicted => standing_in(workers, (rig, records), settings),
    };
    let Some((structure, known)) = known else { return Ok(None) };
    let led = structure.applied(records).with_nominal_fixed(&known.grid);
    let Some((dataset, nominal)) = compared_by_simulation(&led, &known) else { return Ok(None) };
    let mut limitations =
        vec!["effects were added to the given model, whose own parameters stayed as they are".to_owned()];
    let judged = judged_scaled_records(&dataset, &mut limitations);
    let Some(given) = GivenModel::of(model, rig, records, &judged)? else { return Ok(None) };
    note_what_the_records_lack(&dataset, &mut limitations);
    let mut settings = Settings { max_effects: 1, ..settings.clone() };
    // Noise moves no simulation, and the given borders have the refinements that they have.
    settings.effects.retain(|e| !e.moves_no_simulation() && !e.card().lies_in_the_grid);
    let plain = Hypothesis::nominal(nominal);
    Ok(Some(Plan {
        runs: given.runs.clone(),
        settings,
        nominal: Nominal { detailed: plain.clone(), plain },
        given: Some(given),
        judged,
        structure,
        pair_effort: PairEffort::Forward,
        owns_colour: true,
        is_calibrated: false,
        limitations,
        exporter: Exporter::new(rig),
        dataset,
    }))
}

/// A nominal model that does on these records what the predictions in them say; nothing where none does, or where a record has none.
fn standing_in(
    workers: &impl Workers,
    (rig, records): (&Rig, &Dataset),
    settings: &Settings,
) -> Option<(Structure, Fit)> {
    let predictions: Vec<Vec<f64>> = predicted(rig, records).into_iter().collect::<Option<_>>()?;
    let mut simulated = records.clone();
    for (scaled, predicted) in simulated.scaled_records.iter_mut().zip(&predictions) {
        scaled.y = predicted.clone().into();
    }
    let chosen = best_simulator(workers, &simulated, settings)?;
    let (mut differs, mut missed) = (Vec::new(), Vec::new());
    for (number, (scaled, sim)) in
        records.scaled_records.iter().zip(&chosen.dataset.scaled_records).enumerate()
    {
        let run = free_run(&chosen.dataset, &chosen.fit, number, sim);
        differs.push(sim.y.iter().zip(&run).skip(sim.from).map(|(y, x)| y - x).collect());
        missed.push(scaled.y.iter().zip(&sim.y).skip(sim.from).map(|(y, x)| y - x).collect());
    }
    (mean_square(&differs) < FAITHFUL * mean_square(&missed)).then_some((chosen.structure, chosen.fit))
}

/// The records and the known model on them, to be compared by free runs; nothing where the model has none.
fn compared_by_simulation(led: &Dataset, known: &Fit) -> Option<(Dataset, Fit)> {
    let on = |dataset: &Dataset| {
        let context = FitContext { dataset, grid: &known.grid, known: None };
        fit(context, &|_| AugmentedModel::default(), &[], &known.linear, 0)
    };
    let first = led.judged_by(Criterion::Simulation { share: 1.0 });
    let errors = innovations(&first, &on(&first)?, |t| t.is_fit());
    let dataset = led.judged_by(Criterion::Simulation { share: independent_share(&errors) });
    let nominal = on(&dataset)?;
    Some((dataset, nominal))
}
