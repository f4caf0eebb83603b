//! From what a command found to the model file that it writes.

use super::file::{Added, Header, ModelFile, Parameter};
use super::system::System;
use super::{Domain, Machine, PortableModel};
use crate::diagnosis::{Report, Units, reported};
use crate::identification::{Found, Identification};
use switchback_diagnose::{Effect, FittedParameter};
use switchback_model::rig::Rig;

/// The model of an identification; none where the estimate cannot run.
pub fn identified(rig: &Rig, identification: &Identification) -> Option<ModelFile> {
    let (system, threshold) = match identification.model.clone()? {
        Found::Curves(curves) => {
            let threshold = curves.reversal_threshold();
            (System::Curves(curves), threshold)
        }
        Found::Points(points) => (System::Points(points), 0.0),
    };
    let method = Some(identification.method.name().to_owned());
    Some(ModelFile { header: header(rig, "identified", method, Domain::of(rig, threshold)), system })
}

/// The models of a diagnosis with the names of their files: the one under diagnosis, where more than its predictions are known, and the
/// same with what was found added.
pub fn diagnosed(report: &Report) -> Vec<(&'static str, ModelFile)> {
    let Some(models) = &report.diagnosis.models else { return Vec::new() };
    let nominal =
        models.nominal.as_ref().map(|model| ("nominal.json", of_gap(report, "nominal", model, &[])));
    let augmented = of_gap(report, "augmented", &models.augmented, &models.added);
    nominal.into_iter().chain([("augmented.json", augmented)]).chain(aligned(report)).collect()
}

/// The source with the values of the machine, where one was compared.
fn aligned(report: &Report) -> Option<(&'static str, ModelFile)> {
    let found = report.diagnosis.differences.as_ref()?;
    let identified_on = Domain::of(&report.rig, found.aligned.rule.threshold);
    let machine = Machine::new(found.aligned.clone(), found.noise);
    let header = header(&report.rig, "aligned", None, identified_on);
    Some(("aligned.json", ModelFile { header, system: System::Machine(Box::new(machine)) }))
}

fn of_gap(
    report: &Report,
    part: &str,
    model: &PortableModel,
    added: &[(Effect, Vec<FittedParameter>)],
) -> ModelFile {
    let rig = &report.rig;
    let units = Units::of(rig);
    let effects = added.iter().map(|(effect, parameters)| Added {
        effect: effect.name().to_owned(),
        parameters: parameters.iter().map(|p| parameter(p, &units)).collect(),
    });
    let mut header = header(rig, part, None, Domain::of(rig, model.reversal_threshold()));
    header.effects = effects.collect();
    ModelFile { header, system: System::Switched(Box::new(model.clone())) }
}

fn parameter(fitted: &FittedParameter, units: &Units) -> Parameter {
    let reported = reported(fitted, units);
    let known = |x: f64| x.is_finite().then_some(x);
    Parameter {
        name: reported.name,
        value: known(reported.value),
        ci90: reported.ci90.map(known),
        unit: reported.unit,
    }
}

fn header(rig: &Rig, part: &str, method: Option<String>, identified_on: Domain) -> Header {
    Header {
        part: part.to_owned(),
        rig: rig.name.clone(),
        method,
        input: rig.input_label.clone(),
        output: rig.output_label.clone(),
        sample_time: rig.sample_time,
        identified_on,
        effects: Vec::new(),
    }
}
