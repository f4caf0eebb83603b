//! The scenario of a field examination.
//!
//! ```toml
//! study = "field"
//! question = "Does the diagnosis find known faults in records that nobody designed?"
//! seed = 1
//! rigs = "../shared/rigs"      # optional: measured bases, every folder below with a rig.toml; from the scenario's folder or the working one
//! effects = ["backlash"]       # optional: the faults; all that can be made if left out
//! sizes = [1.0, 2.0, 4.0]      # what survives identification anew, over what the base's model leaves
//! seeds = 1                    # faults a cell of base × effect × size
//! made = 8                     # made bases that faults are put into
//! none = 100                   # made bases without fault
//! resampled = 8                # a measured base: its model's simulation with resampled residuals, so many times
//! outside = 100                # faults that no library of causes knows
//! slice = 40                   # optional: a random part of the design, this many diagnoses, two a rig
//!
//! [expect]                     # optional: what must come out, see `Expect`
//! exact = 0.6
//! ```

use crate::examination::{ScenarioError, effects_listed, refuse_large_design, refuse_more_than, study_of};
use serde::Deserialize;
use std::path::{Path, PathBuf};
use switchback_io::input::{TomlError, TomlFile, TwoNumbers, stream};
use toml::Spanned;

/// A field examination that can be run.
#[derive(Debug, Clone)]
pub struct Study {
    /// The file's stem; names the report folder.
    pub name: String,
    /// What it is to answer.
    pub question: String,
    /// Seed of everything.
    pub seed: u64,
    /// Folder of measured rigs, as the scenario has it.
    pub rigs: Option<PathBuf>,
    /// Folder of the scenario, which `rigs` may be relative to.
    pub folder: PathBuf,
    /// Faults put in.
    pub effects: Vec<&'static str>,
    /// Sizes asked for; positive, at least one of them 2 or more.
    pub sizes: Vec<f64>,
    /// Faults a cell of base × effect × size.
    pub seeds: usize,
    /// Made bases that faults are put into.
    pub made: usize,
    /// Made bases without fault.
    pub none: usize,
    /// Draws of resampled residuals a measured base.
    pub resampled: usize,
    /// Faults that the diagnosis does not know.
    pub outside: usize,
    /// Diagnoses to run, drawn from the design; all of it if none.
    pub slice: Option<usize>,
    /// What must come out.
    pub expect: Expect,
}

/// What must come out; each figure is optional and a share unless said otherwise. "Large" is a fault of size 2 at least.
#[derive(Debug, Clone, Copy, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Expect {
    /// Least share of large faults with the right class, the base's model given.
    pub model_class: Option<f64>,
    /// Least share of these named exactly.
    pub model_exact: Option<f64>,
    /// Least share of large faults with the right class, no model given.
    pub class: Option<f64>,
    /// Least share of these named exactly.
    pub exact: Option<f64>,
    /// Largest share of named causes that are wrong.
    pub wrong: Option<f64>,
    /// Largest share of made bases without fault for which a cause is named.
    pub false_alarm_made: Option<f64>,
    /// Largest share of measured bases with resampled residuals for which a cause is named that the base does not show.
    pub false_alarm_resampled: Option<f64>,
    /// Largest share of foreign faults for which a cause is named.
    pub outside_named: Option<f64>,
    /// Largest share of effects named alone that harm a held-out record beyond its error.
    pub degrades_validation: Option<f64>,
    /// Largest calibration error over what perfect calibration would show on as many rigs.
    pub calibration: Option<f64>,
    /// Least and largest coverage of the 90 % closure intervals.
    #[serde(default, deserialize_with = "TwoNumbers::optional")]
    pub coverage: Option<[f64; 2]>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct WireStudy {
    study: Spanned<String>,
    question: String,
    seed: u64,
    rigs: Option<PathBuf>,
    effects: Option<Vec<Spanned<String>>>,
    sizes: Spanned<Vec<f64>>,
    seeds: Spanned<usize>,
    made: Spanned<usize>,
    none: Spanned<usize>,
    resampled: Option<Spanned<usize>>,
    outside: Spanned<usize>,
    slice: Option<Spanned<usize>>,
    #[serde(default)]
    expect: Expect,
}

/// From this size on causes must be named.
pub(super) const LARGE: f64 = 2.0;

/// Whether a file calls itself a field examination; one that cannot be read or parsed does not.
pub fn is_field(path: &Path) -> bool {
    study_of(path).as_deref() == Some("field")
}

/// Reads and checks a scenario with `study = "field"`.
///
/// # Errors
/// [`ScenarioError`] if it cannot be read, holds unknown keys or impossible values; content errors name the place.
pub fn read(path: &Path) -> Result<Study, ScenarioError> {
    checked(path, &TomlFile::read(path)?)
}

fn checked(path: &Path, file: &TomlFile) -> Result<Study, ScenarioError> {
    let wire: WireStudy = file.parse()?;
    check(file, &wire)?;
    let effects = effects_listed(file, wire.effects.as_deref())?;
    refuse_large(file, &wire, effects.len())?;
    Ok(Study {
        name: stream::stem(path).unwrap_or_else(|| "field".to_owned()),
        question: wire.question,
        seed: wire.seed,
        rigs: wire.rigs,
        folder: stream::folder(path).to_owned(),
        effects,
        sizes: wire.sizes.into_inner(),
        seeds: wire.seeds.into_inner(),
        made: wire.made.into_inner(),
        none: wire.none.into_inner(),
        resampled: wire.resampled.map_or(0, Spanned::into_inner),
        outside: wire.outside.into_inner(),
        slice: wire.slice.map(Spanned::into_inner),
        expect: wire.expect,
    })
}

/// Most bases of a kind, all of which are made before anything else and held in memory.
const MOST_BASES: u64 = 5000;

fn refuse_large(file: &TomlFile, wire: &WireStudy, effects: usize) -> Result<(), TomlError> {
    let WireStudy { seeds, made, none, resampled, outside, .. } = wire;
    for count in [("made", made), ("none", none)] {
        refuse_more_than(file, MOST_BASES, count)?;
    }
    let resampled = resampled.as_ref().map(|count| ("resampled", count));
    let counts: Vec<_> = [("seeds", seeds), ("outside", outside)].into_iter().chain(resampled).collect();
    refuse_large_design(file, &counts, || {
        let of = |count: &Spanned<usize>| *count.get_ref() as u64;
        // A measured base at least, where there may be some.
        let bases = of(made) + u64::from(wire.rigs.is_some());
        let injected = [of(seeds), bases, wire.sizes.get_ref().len() as u64, effects as u64];
        injected.into_iter().fold(1, u64::saturating_mul).saturating_add(of(none) + of(outside))
    })
}

fn check(file: &TomlFile, wire: &WireStudy) -> Result<(), TomlError> {
    if wire.study.get_ref() != "field" {
        let message = format!("study = \"{}\" is not a field examination", wire.study.get_ref());
        return Err(file.error(wire.study.span(), message, "write study = \"field\""));
    }
    let sizes = wire.sizes.get_ref();
    if let Some(bad) = sizes.iter().find(|s| !(s.is_finite() && **s > 0.0)) {
        let message = format!("{bad} is no size of a fault");
        let remedy =
            "give positive numbers: what survives identification anew, over what the base's model leaves";
        return Err(file.error(wire.sizes.span(), message, remedy));
    }
    if !sizes.iter().any(|s| *s >= LARGE) {
        let message = "no size reaches 2, where causes must be named";
        let remedy = "add a size of at least 2, e.g. sizes = [1, 2, 4]";
        return Err(file.error(wire.sizes.span(), message, remedy));
    }
    if wire.rigs.is_none() && *wire.made.get_ref() == 0 {
        let message = "made = 0 without `rigs` leaves no base that a fault could be put into";
        return Err(file.error(
            wire.made.span(),
            message,
            "make at least 1, or name a folder of measured rigs",
        ));
    }
    if let Some(slice) = wire.slice.as_ref().filter(|s| *s.get_ref() == 0) {
        let remedy = "give a number of diagnoses, or leave the key out";
        return Err(file.error(slice.span(), "slice = 0 leaves no rig", remedy));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refused(change: (&str, &str)) -> String {
        let text = "study = \"field\"\nquestion = \"q\"\nseed = 1\nsizes = [1.0, 2.0]\nseeds = 1\nmade = 2\nnone = 3\noutside = 3\n";
        let path = Path::new("field.toml");
        let file = TomlFile::from_text(path, &text.replace(change.0, change.1));
        checked(path, &file).unwrap_err().to_string()
    }

    #[test]
    fn every_refusal_names_the_place() {
        assert!(refused(("seeds", "sedes")).contains(":5:1: unknown key `sedes`"));
        assert!(refused(("\"field\"", "\"blind\"")).contains(":1:9: study = \"blind\" is not"));
        assert!(refused(("[1.0, 2.0]", "[1.0]")).contains(":4:9: no size reaches 2"));
        assert!(refused(("[1.0, 2.0]", "[0.0, 2.0]")).contains(":4:9: 0 is no size"));
        assert!(refused(("made = 2", "made = 0")).contains(":6:8: made = 0 without `rigs`"));
        assert!(refused(("outside = 3", "outside = 3\nslice = 0")).contains(":9:9: slice = 0"));
        let listing = |list: &str| refused(("seeds = 1", &format!("seeds = 1\neffects = {list}")));
        assert!(listing("[\"crep\"]").contains(":6:12: `crep` is no effect"));
        assert!(listing("[\"creep\", \"creep\"]").contains(":6:21: `creep` is listed twice"));
    }
}
