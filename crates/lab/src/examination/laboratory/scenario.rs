//! The scenario of a blind study.
//!
//! ```toml
//! study = "blind"
//! question = "Does the diagnosis name what was put in, and stay silent otherwise?"
//! seed = 1
//! systems = 3                  # families of nominal systems: orders 1, 2, 3, 1, …
//! sizes = [0.5, 1.0, 2.0, 4.0] # surviving gap in noise sd
//! effects = ["backlash"]       # optional: the effects put in; all that can be made if left out
//! seeds = 20                   # rigs a cell of effect × size × system
//! none = 300                   # rigs without effect
//! outside = 300                # effects foreign to the library or taken out of it
//! pairs = 200                  # rigs with two effects
//! slice = 100                  # optional: a random part of the design, this many rigs
//!
//! [expect]                     # optional: what must come out, see `Expect`
//! exact = 0.9
//! ```

use super::confounded_effects::same_class;
use crate::examination::{ScenarioError, effects_listed, refuse_large_design, study_of};
use crate::generate::Plan;
use serde::Deserialize;
use std::path::Path;
use switchback_io::input::{TomlError, TomlFile, TwoNumbers, stream};
use toml::Spanned;

/// A blind study that can be run.
#[derive(Debug, Clone)]
pub struct Study {
    /// The file's stem; names the report folder.
    pub name: String,
    /// What it is to answer.
    pub question: String,
    /// Seed of everything.
    pub seed: u64,
    /// Families of nominal systems, at least 1.
    pub systems: usize,
    /// Surviving gaps in noise sd; positive, at least one of them 1 or more.
    pub sizes: Vec<f64>,
    /// Effects put in.
    pub effects: Vec<&'static str>,
    /// Rigs a cell of effect × size × system.
    pub seeds: usize,
    /// Rigs without effect.
    pub none: usize,
    /// Rigs whose effect the diagnosis does not know.
    pub outside: usize,
    /// Rigs with two effects.
    pub pairs: usize,
    /// Rigs to run, drawn from the design; all of it if none.
    pub slice: Option<usize>,
    /// Records of each rig.
    pub plan: Plan,
    /// What must come out.
    pub expect: Expect,
}

/// What must come out; each figure is optional and a share unless said otherwise.
#[derive(Debug, Clone, Copy, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Expect {
    /// Least share of plain single effects of size ≥ 1 named exactly.
    pub exact: Option<f64>,
    /// Least share of these with the right class.
    pub class: Option<f64>,
    /// Least share of single effects under a law of their own, size ≥ 1, with the right class.
    pub mismatch_class: Option<f64>,
    /// Largest share of rigs without effect for which a cause is named.
    pub false_alarm: Option<f64>,
    /// Least share of named causes that are right.
    pub precision: Option<f64>,
    /// Largest share of outsiders for which a cause is named.
    pub outside_named: Option<f64>,
    /// Largest expected calibration error.
    pub ece: Option<f64>,
    /// Least F1 of the cells flagged.
    pub where_f1: Option<f64>,
    /// Least and largest coverage of the 90 % closure intervals.
    #[serde(default, deserialize_with = "TwoNumbers::optional")]
    pub coverage: Option<[f64; 2]>,
    /// Largest mean error of the closure at size ≥ 1.
    pub closure_error: Option<f64>,
    /// Least share of pairs found exactly.
    pub pairs_exact: Option<f64>,
    /// Largest share of single effects for which a second is named.
    pub phantom: Option<f64>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct WireStudy {
    study: Spanned<String>,
    question: String,
    seed: u64,
    systems: Spanned<usize>,
    sizes: Spanned<Vec<f64>>,
    effects: Option<Vec<Spanned<String>>>,
    seeds: Spanned<usize>,
    none: Spanned<usize>,
    outside: Spanned<usize>,
    pairs: Spanned<usize>,
    slice: Option<Spanned<usize>>,
    #[serde(default)]
    expect: Expect,
}

/// Whether a file calls itself a blind study; one that cannot be read or parsed does not.
pub fn is_blind(path: &Path) -> bool {
    study_of(path).as_deref() == Some("blind")
}

/// Reads and checks a scenario with `study = "blind"`.
///
/// # Errors
/// [`ScenarioError`] if it cannot be read, holds unknown keys or impossible values; content errors name the place.
pub fn read(path: &Path) -> Result<Study, ScenarioError> {
    checked(path, &TomlFile::read(path)?)
}

fn checked(path: &Path, file: &TomlFile) -> Result<Study, ScenarioError> {
    let wire: WireStudy = file.parse()?;
    check(file, &wire)?;
    let effects = effects(file, &wire)?;
    refuse_large(file, &wire, effects.len())?;
    Ok(Study {
        name: stream::stem(path).unwrap_or_else(|| "blind".to_owned()),
        question: wire.question,
        seed: wire.seed,
        systems: wire.systems.into_inner(),
        sizes: wire.sizes.into_inner(),
        effects,
        seeds: wire.seeds.into_inner(),
        none: wire.none.into_inner(),
        outside: wire.outside.into_inner(),
        pairs: wire.pairs.into_inner(),
        slice: wire.slice.map(Spanned::into_inner),
        plan: Plan::default(),
        expect: wire.expect,
    })
}

fn check(file: &TomlFile, wire: &WireStudy) -> Result<(), TomlError> {
    if wire.study.get_ref() != "blind" {
        let message = format!("study = \"{}\" is not a blind study", wire.study.get_ref());
        return Err(file.error(wire.study.span(), message, "write study = \"blind\""));
    }
    if *wire.systems.get_ref() == 0 {
        return Err(file.error(wire.systems.span(), "systems = 0 leaves nothing to make", "give at least 1"));
    }
    let sizes = wire.sizes.get_ref();
    if let Some(bad) = sizes.iter().find(|s| !(s.is_finite() && **s > 0.0)) {
        let message = format!("size {bad} is no surviving gap");
        return Err(file.error(wire.sizes.span(), message, "give positive numbers of noise sd"));
    }
    if !sizes.iter().any(|s| *s >= 1.0) {
        let message = "no size reaches 1 noise sd, where causes must be named";
        return Err(file.error(
            wire.sizes.span(),
            message,
            "add a size of at least 1, e.g. sizes = [0.5, 1, 2, 4]",
        ));
    }
    if let Some(slice) = wire.slice.as_ref().filter(|s| *s.get_ref() == 0) {
        return Err(file.error(
            slice.span(),
            "slice = 0 leaves no rig",
            "give a number of rigs, or leave the key out",
        ));
    }
    Ok(())
}

fn refuse_large(file: &TomlFile, wire: &WireStudy, effects: usize) -> Result<(), TomlError> {
    let WireStudy { systems, seeds, none, outside, pairs, .. } = wire;
    let counts =
        [("seeds", seeds), ("systems", systems), ("none", none), ("outside", outside), ("pairs", pairs)];
    refuse_large_design(file, &counts, || {
        let of = |count: &Spanned<usize>| *count.get_ref() as u64;
        let single = [of(seeds), of(systems), wire.sizes.get_ref().len() as u64, effects as u64];
        single.into_iter().fold(1, u64::saturating_mul).saturating_add(of(none) + of(outside) + of(pairs))
    })
}

/// The effects asked for, where pairs can be made of them if any are wanted.
fn effects(file: &TomlFile, wire: &WireStudy) -> Result<Vec<&'static str>, TomlError> {
    let effects = effects_listed(file, wire.effects.as_deref())?;
    let any_pair = effects.iter().any(|one| effects.iter().any(|other| !same_class(one, other)));
    if *wire.pairs.get_ref() > 0 && !any_pair {
        let message = "no two of the effects listed may be put in together: all are twins";
        return Err(file.error(wire.pairs.span(), message, "set pairs = 0, or list more effects"));
    }
    Ok(effects)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refused(change: (&str, &str)) -> String {
        let text = "study = \"blind\"\nquestion = \"q\"\nseed = 1\nsystems = 3\nsizes = [0.5, 1.0]\nseeds = 2\nnone = 3\noutside = 3\npairs = 2\n";
        let path = Path::new("blind.toml");
        let file = TomlFile::from_text(path, &text.replace(change.0, change.1));
        checked(path, &file).unwrap_err().to_string()
    }

    #[test]
    fn every_refusal_names_the_place() {
        assert!(refused(("seeds", "sedes")).contains(":6:1: unknown key `sedes`"));
        assert!(refused(("\"blind\"", "\"consistency\"")).contains(":1:9:"));
        assert!(refused(("[0.5, 1.0]", "[0.5]")).contains(":5:9: no size reaches 1"));
        assert!(refused(("[0.5, 1.0]", "[-1.0, 2.0]")).contains("size -1"));
        assert!(refused(("systems = 3", "systems = 0")).contains(":4:11:"));
        let listing = |list: &str| refused(("seeds = 2", &format!("seeds = 2\neffects = {list}")));
        assert!(listing("[\"crep\"]").contains(":7:12: `crep` is no effect"));
        assert!(listing("[\"creep\", \"creep\"]").contains(":7:21: `creep` is listed twice"));
        assert!(listing("[\"creep\"]").contains("all are twins"));
        assert!(listing("[]").contains("all are twins"));
        let large = |key: &str| refused((key, &format!("{key}00000000000000")));
        assert!(large("none = 3").contains(":7:8: `none = 300000000000000` is beyond"));
        assert!(large("pairs = 2").contains(":9:9: `pairs = 200000000000000` is beyond"));
        assert!(refused(("seeds = 2", "seeds = 1000000")).contains(":6:9: effects, sizes and counts make"));
    }
}
