//! The scenario of an examination.
//!
//! ```toml
//! study = "blind"              # in the laboratory, or "field"
//! question = "Does the diagnosis name what was put in, and stay silent otherwise?"
//! seed = 1
//! effects = ["backlash"]       # optional: the effects put in; all that can be made if left out
//! sizes = [0.5, 1.0, 2.0, 4.0] # what survives identification anew: noise sd; in the field over what the base's model leaves
//! seeds = 20                   # rigs a cell of effect × size × system or base
//! none = 300                   # rigs without effect; in the field made bases without fault
//! outside = 300                # effects that no library of causes knows, in the laboratory also taken out of it
//! slice = 100                  # optional: a random part of the design: rigs; in the field diagnoses, two a rig
//!
//! # In the laboratory
//! systems = 3                  # families of nominal systems: orders 1, 2, 3, 1, …
//! pairs = 200                  # rigs with two effects
//!
//! # In the field
//! rigs = "../shared/rigs"      # optional: measured bases, every folder below with a rig.toml; from the scenario's folder or the working one
//! made = 8                     # made bases that faults are put into
//! resampled = 8                # optional, a measured base: its model's simulation with resampled residuals, so many times
//!
//! [expect]                     # optional: what must come out, by the keys of the measures
//! exact = 0.9
//! ```

use super::design::Design;
use super::measure::{Bound, Expect, Target};
use super::{field, laboratory};
use crate::generate::{EFFECTS, Plan};
use miette::Diagnostic;
use serde::Deserialize;
use std::collections::BTreeMap;
use std::ops::Range;
use std::path::{Path, PathBuf};
use switchback_io::input::{FileError, TomlError, TomlFile, TwoNumbers, closest, stream};
use thiserror::Error;
use toml::Spanned;

/// An examination that can be run. What only the other design has is 0 or none.
#[derive(Debug, Clone)]
pub struct Study {
    /// The file's stem; names the report folder.
    pub name: String,
    /// What it is to answer.
    pub question: String,
    /// Where the rigs stand.
    pub design: Design,
    /// Seed of everything.
    pub seed: u64,
    /// Effects put in.
    pub effects: Vec<&'static str>,
    /// Sizes asked for; positive, at least one of them large.
    pub sizes: Vec<f64>,
    /// Rigs a cell of effect × size × system or base.
    pub seeds: usize,
    /// Rigs without effect; in the field made bases without fault.
    pub none: usize,
    /// Rigs whose effect the diagnosis does not know.
    pub outside: usize,
    /// Rigs to run, in the field diagnoses, drawn from the design; all of it if none.
    pub slice: Option<usize>,
    /// What must come out.
    pub expect: Expect,
    /// Laboratory: families of nominal systems, at least 1.
    pub systems: usize,
    /// Laboratory: rigs with two effects.
    pub pairs: usize,
    /// Laboratory: records of each rig.
    pub plan: Plan,
    /// Field: folder of measured rigs, as the scenario has it.
    pub rigs: Option<PathBuf>,
    /// Folder of the scenario, which `rigs` may be relative to.
    pub folder: PathBuf,
    /// Field: made bases that faults are put into.
    pub made: usize,
    /// Field: draws of resampled residuals a measured base.
    pub resampled: usize,
}

/// Why a file is no scenario of an examination.
#[derive(Debug, Error, Diagnostic)]
#[non_exhaustive]
pub enum ScenarioError {
    /// The file cannot be read.
    #[error(transparent)]
    #[diagnostic(transparent)]
    File(#[from] FileError),
    /// Its content is refused.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Content(Box<TomlError>),
}

impl From<TomlError> for ScenarioError {
    fn from(error: TomlError) -> Self {
        Self::Content(Box::new(error))
    }
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct WireStudy {
    study: Spanned<String>,
    question: String,
    seed: u64,
    effects: Option<Vec<Spanned<String>>>,
    sizes: Spanned<Vec<f64>>,
    seeds: Spanned<usize>,
    none: Spanned<usize>,
    outside: Spanned<usize>,
    slice: Option<Spanned<usize>>,
    systems: Option<Spanned<usize>>,
    pairs: Option<Spanned<usize>>,
    rigs: Option<Spanned<PathBuf>>,
    made: Option<Spanned<usize>>,
    resampled: Option<Spanned<usize>>,
    #[serde(default)]
    expect: BTreeMap<Spanned<String>, Spanned<toml::Value>>,
}

/// Most rigs of a design: a year of diagnoses on any machine, and more than memory holds once they are made.
const MOST_RIGS: u64 = 1_000_000;
/// Most bases of a kind, all of which are made before anything else and held in memory.
const MOST_BASES: u64 = 5000;

/// The design of a scenario file; none of one that cannot be read or parsed, or is of another study.
pub fn design_of(path: &Path) -> Option<Design> {
    let table: toml::Table = TomlFile::read(path).ok()?.parse().ok()?;
    let study = table.get("study")?.as_str()?;
    Design::ALL.into_iter().find(|design| design.study() == study)
}

/// Reads and checks the scenario of an examination.
///
/// # Errors
/// [`ScenarioError`] if it cannot be read, holds unknown keys or impossible values; content errors name the place.
pub fn read(path: &Path) -> Result<Study, ScenarioError> {
    checked(path, &TomlFile::read(path)?)
}

fn checked(path: &Path, file: &TomlFile) -> Result<Study, ScenarioError> {
    let wire: WireStudy = file.parse()?;
    let Some(design) = Design::ALL.into_iter().find(|design| design.study() == wire.study.get_ref()) else {
        let message = format!("study = \"{}\" is no examination", wire.study.get_ref());
        return Err(file.error(wire.study.span(), message, "write study = \"blind\" or \"field\"").into());
    };
    let check = Check { file, wire: &wire, design };
    check.keys_of_the_design()?;
    check.sizes()?;
    check.population()?;
    let effects = check.effects()?;
    check.is_not_too_large(effects.len() as u64)?;
    let expect = check.expect()?;
    let count = |count: Option<Spanned<usize>>| count.map_or(0, Spanned::into_inner);
    Ok(Study {
        name: stream::stem(path).unwrap_or_else(|| design.study().to_owned()),
        question: wire.question,
        design,
        seed: wire.seed,
        effects,
        sizes: wire.sizes.into_inner(),
        seeds: wire.seeds.into_inner(),
        none: wire.none.into_inner(),
        outside: wire.outside.into_inner(),
        slice: wire.slice.map(Spanned::into_inner),
        expect,
        systems: count(wire.systems),
        pairs: count(wire.pairs),
        plan: Plan::default(),
        rigs: wire.rigs.map(Spanned::into_inner),
        folder: stream::folder(path).to_owned(),
        made: count(wire.made),
        resampled: count(wire.resampled),
    })
}

/// A key that may be left out: its name, where it stands, what it counts.
type Given = (&'static str, Option<(Range<usize>, u64)>);

fn given(name: &'static str, count: Option<&Spanned<usize>>) -> Given {
    (name, count.map(|count| (count.span(), *count.get_ref() as u64)))
}

/// What is checked of a file.
struct Check<'w> {
    file: &'w TomlFile,
    wire: &'w WireStudy,
    design: Design,
}

impl Check<'_> {
    fn refuse(&self, span: Range<usize>, message: &str, remedy: &str) -> Result<(), TomlError> {
        Err(self.file.error(span, message, remedy))
    }

    /// Those of the other design are unknown, and its own must be there.
    fn keys_of_the_design(&self) -> Result<(), TomlError> {
        let WireStudy { systems, pairs, rigs, made, resampled, .. } = self.wire;
        let laboratory = [given("systems", systems.as_ref()), given("pairs", pairs.as_ref())];
        let rigs = rigs.as_ref().map(|rigs| (rigs.span(), 1));
        let field = [given("made", made.as_ref()), ("rigs", rigs), given("resampled", resampled.as_ref())];
        let (needed, foreign): (&[Given], &[Given]) = match self.design {
            Design::Laboratory => (&laboratory, &field),
            Design::Field => (&field[..1], &laboratory),
        };
        for (key, given) in foreign {
            if let Some((span, _)) = given {
                let message = format!("unknown key `{key}` of {}", self.design.article_and_name());
                self.refuse(span.clone(), &message, "remove it")?;
            }
        }
        match needed.iter().find(|(_, given)| given.is_none()) {
            Some((key, _)) => self.refuse(0..0, &format!("missing key `{key}`"), &format!("add `{key} = …`")),
            None => Ok(()),
        }
    }

    fn sizes(&self) -> Result<(), TomlError> {
        let (sizes, span, large) = (self.wire.sizes.get_ref(), self.wire.sizes.span(), self.design.large());
        if let Some(bad) = sizes.iter().find(|s| !(s.is_finite() && **s > 0.0)) {
            let remedy = "give positive numbers: what survives identification anew, over the noise or what the base's model leaves";
            self.refuse(span.clone(), &format!("{bad} is no size of an effect"), remedy)?;
        }
        if !sizes.iter().any(|s| *s >= large) {
            let message = format!("no size reaches {large}, where causes must be named");
            self.refuse(span, &message, &format!("add a size of at least {large}, e.g. sizes = [1, 2, 4]"))?;
        }
        Ok(())
    }

    /// Something must be left to make.
    fn population(&self) -> Result<(), TomlError> {
        let WireStudy { slice, systems, rigs, made, .. } = self.wire;
        let is_zero = |count: &&Spanned<usize>| *count.get_ref() == 0;
        if let Some(systems) = systems.as_ref().filter(is_zero) {
            self.refuse(systems.span(), "systems = 0 leaves nothing to make", "give at least 1")?;
        }
        if let Some(made) = made.as_ref().filter(|made| is_zero(made) && rigs.is_none()) {
            let message = "made = 0 without `rigs` leaves no base that a fault could be put into";
            self.refuse(made.span(), message, "make at least 1, or name a folder of measured rigs")?;
        }
        if let Some(slice) = slice.as_ref().filter(is_zero) {
            let remedy = "give a number of rigs, or leave the key out";
            self.refuse(slice.span(), "slice = 0 leaves no rig", remedy)?;
        }
        Ok(())
    }

    /// The effects listed, by the names of the catalogue; all that can be made where no list is given. Where pairs are wanted, they must be
    /// possible.
    fn effects(&self) -> Result<Vec<&'static str>, TomlError> {
        let mut effects = Vec::new();
        for name in self.wire.effects.iter().flatten() {
            let Some(effect) = EFFECTS.into_iter().find(|known| known == name.get_ref()) else {
                let remedy = closest(name.get_ref(), EFFECTS).map_or_else(
                    || format!("known are {}", EFFECTS.join(", ")),
                    |near| format!("did you mean `{near}`?"),
                );
                let message = format!("`{}` is no effect that can be made", name.get_ref());
                return Err(self.file.error(name.span(), message, remedy));
            };
            if effects.contains(&effect) {
                self.refuse(name.span(), &format!("`{effect}` is listed twice"), "name each effect once")?;
            }
            effects.push(effect);
        }
        if self.wire.effects.is_none() {
            effects = EFFECTS.to_vec();
        }
        let any_pair =
            effects.iter().any(|one| effects.iter().any(|other| !laboratory::same_class(one, other)));
        if let Some(pairs) = self.wire.pairs.as_ref().filter(|pairs| *pairs.get_ref() > 0 && !any_pair) {
            let message =
                "no two of the effects listed may be put in together: all are confounded with each other";
            self.refuse(pairs.span(), message, "set pairs = 0, or list more effects")?;
        }
        Ok(effects)
    }

    /// No key of a design, nor all of it, may ask for more rigs than can be run.
    fn is_not_too_large(&self, effects: u64) -> Result<(), TomlError> {
        let WireStudy { sizes, seeds, none, outside, systems, pairs, rigs, made, resampled, .. } = self.wire;
        let most_made = if self.design == Design::Field { MOST_BASES } else { MOST_RIGS };
        let limited = [
            (given("made", made.as_ref()), MOST_BASES),
            (given("none", Some(none)), most_made),
            (given("seeds", Some(seeds)), MOST_RIGS),
            (given("systems", systems.as_ref()), MOST_RIGS),
            (given("outside", Some(outside)), MOST_RIGS),
            (given("pairs", pairs.as_ref()), MOST_RIGS),
            (given("resampled", resampled.as_ref()), MOST_RIGS),
        ];
        for ((key, count), most) in limited {
            if let Some((span, count)) = count.filter(|(_, count)| *count > most) {
                let message = format!("`{key} = {count}` is beyond what can be run");
                self.refuse(span, &message, &format!("give {most} or less"))?;
            }
        }
        let of = |count: Option<&Spanned<usize>>| count.map_or(0, |count| *count.get_ref() as u64);
        // A measured base at least, where there may be some.
        let contexts = of(systems.as_ref()) + of(made.as_ref()) + u64::from(rigs.is_some());
        let cells = [of(Some(seeds)), contexts, sizes.get_ref().len() as u64, effects];
        let others = of(Some(none)) + of(Some(outside)) + of(pairs.as_ref());
        let rigs = cells.into_iter().fold(1, u64::saturating_mul).saturating_add(others);
        if rigs <= MOST_RIGS {
            return Ok(());
        }
        let message = format!("effects, sizes and counts make {rigs} rigs in all");
        let remedy = format!("lower the counts, so that there are {MOST_RIGS} or less");
        self.refuse(seeds.span(), &message, &remedy)
    }

    /// What is expected of measures that can be bounded.
    fn expect(&self) -> Result<Expect, TomlError> {
        let targets = match self.design {
            Design::Laboratory => laboratory::targets(),
            Design::Field => field::targets(),
        };
        let known: Vec<&str> =
            targets.iter().filter(|(_, t)| *t != Target::Reported).map(|(key, _)| *key).collect();
        let mut expect = Expect::new();
        for (key, value) in &self.wire.expect {
            let name = key.get_ref();
            let Some((_, target)) = targets.iter().find(|(of, _)| of == name && known.contains(of)) else {
                let listed: Vec<String> = known.iter().map(|key| format!("`{key}`")).collect();
                let message = format!("unknown key `{name}`, expected one of {}", listed.join(", "));
                let remedy = closest(name, known.iter().copied()).map_or_else(
                    || "remove it or use one of the names listed".to_owned(),
                    |near| format!("did you mean `{near}`?"),
                );
                return Err(self.file.error(key.span(), message, remedy));
            };
            let bound = bound(*target, value.get_ref().clone()).map_err(|error| {
                let (message, remedy) = self.file.explain(&error);
                self.file.error(value.span(), message, remedy)
            })?;
            expect.insert(name.clone(), bound);
        }
        Ok(expect)
    }
}

/// A bound of a scenario, on the side of the target.
fn bound(target: Target, value: toml::Value) -> Result<Bound, toml::de::Error> {
    Ok(match target {
        Target::Must(Bound::Within(..)) => {
            let TwoNumbers([low, high]) = value.try_into()?;
            Bound::Within(low, high)
        }
        Target::Must(Bound::AtLeast(_)) => Bound::AtLeast(value.try_into()?),
        Target::Must(Bound::AtMost(_)) | Target::BoundedAbove | Target::Reported => {
            Bound::AtMost(value.try_into()?)
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const COMMON: &str = "question = \"q\"\nseed = 1\nsizes = [0.5, 2.0]\nseeds = 2\nnone = 3\noutside = 3\n";

    fn text(design: Design) -> String {
        let own = match design {
            Design::Laboratory => "systems = 3\npairs = 2\n",
            Design::Field => "made = 2\n",
        };
        format!("study = \"{}\"\n{COMMON}{own}", design.study())
    }

    fn scenario(text: &str) -> Result<Study, ScenarioError> {
        let path = Path::new("a.toml");
        checked(path, &TomlFile::from_text(path, text))
    }

    fn refused(design: Design, change: (&str, &str)) -> String {
        scenario(&text(design).replace(change.0, change.1)).unwrap_err().to_string()
    }

    #[test]
    fn every_refusal_names_the_place() {
        for design in Design::ALL {
            let refused = |from: &str, to: &str| refused(design, (from, to));
            assert!(refused("seeds", "sedes").contains(":5:1: unknown key `sedes`"));
            assert!(refused(design.study(), "consistency").contains(":1:9: study = \"consistency\" is no"));
            assert!(refused("[0.5, 2.0]", "[0.5]").contains(":4:9: no size reaches"));
            assert!(refused("[0.5, 2.0]", "[-1.0, 2.0]").contains(":4:9: -1 is no size"));
            assert!(refused("outside = 3", "outside = 3\nslice = 0").contains(":8:9: slice = 0"));
            let listing = |list: &str| refused("seeds = 2", &format!("seeds = 2\neffects = {list}"));
            assert!(listing("[\"crep\"]").contains(":6:12: `crep` is no effect"));
            assert!(listing("[\"creep\", \"creep\"]").contains(":6:21: `creep` is listed twice"));
            assert!(
                refused("none = 3", "none = 300000000000000").contains(":6:8: `none = 300000000000000` is")
            );
            assert!(refused("seeds = 2", "seeds = 1000000").contains(":5:9: effects, sizes and counts make"));
        }
    }

    #[test]
    fn each_design_has_keys_of_its_own() {
        let blind = |from: &str, to: &str| refused(Design::Laboratory, (from, to));
        assert!(blind("systems = 3", "systems = 0").contains(":8:11: systems = 0"));
        assert!(
            blind("pairs = 2", "pairs = 200000000000000")
                .contains(":9:9: `pairs = 200000000000000` is beyond")
        );
        assert!(blind("pairs = 2", "pairs = 2\nmade = 2").contains(":10:8: unknown key `made`"));
        assert!(blind("pairs = 2\n", "").contains("missing key `pairs`"));
        let listing = |list: &str| blind("seeds = 2", &format!("seeds = 2\neffects = {list}"));
        assert!(listing("[\"creep\"]").contains("all are confounded with each other"));
        assert!(listing("[]").contains("all are confounded with each other"));
        let field = |from: &str, to: &str| refused(Design::Field, (from, to));
        assert!(field("made = 2", "made = 0").contains(":8:8: made = 0 without `rigs`"));
        assert!(field("made = 2", "systems = 2\nmade = 2").contains(":8:11: unknown key `systems`"));
        assert!(field("[0.5, 2.0]", "[1.0]").contains("no size reaches 2"));
    }

    #[test]
    fn expectations_are_bounds_of_measures() {
        let expecting = |design: Design, line: &str| scenario(&format!("{}[expect]\n{line}\n", text(design)));
        let expect = |line: &str| expecting(Design::Field, line).unwrap().expect;
        assert_eq!(expect("exact = 1")["exact"], Bound::AtLeast(1.0));
        assert_eq!(expect("outside_named = 0.1")["outside_named"], Bound::AtMost(0.1));
        assert_eq!(expect("coverage = [0.8, 1]")["coverage"], Bound::Within(0.8, 1.0));
        let refused = |line: &str| expecting(Design::Field, line).unwrap_err().to_string();
        assert!(
            refused("phantom = 0.1").contains(":10:1: unknown key `phantom`, expected one of `model_class`")
        );
        assert!(refused("ece = 0.1").contains("unknown key `ece`"));
        assert!(refused("coverage = [0.8]").contains(":10:12: expected two numbers"));
        assert!(refused("exact = \"all\"").contains(":10:9: expected a number"));
        assert!(expecting(Design::Laboratory, "phantom = 0.1").is_ok());
    }
}
