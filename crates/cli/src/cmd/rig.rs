//! `switchback rig [--field] --effect EFFECT --size 2 --seed 7 --out DIR`

use crate::failure::{CommandResult, Outcome};
use crate::options::Output;
use schemars::{JsonSchema, Schema};
use serde::Serialize;
use std::fmt::Write as _;
use std::path::PathBuf;
use switchback_diagnose::Stage;
use switchback_io::diagnosis::Units;
use switchback_io::output::{print, stamped, stamped_schema};
use switchback_io::rig;
use switchback_io::values::{number, whole};
use switchback_lab::generate::{
    EFFECTS, FOREIGN, Family, Key, MadeRig, MakeError, MakeRig, RecipeError, RequestedFault, Setting,
    TrueEffect, laws_of,
};
use switchback_model::rig::Rig;

/// Make a rig with a chosen effect: records as a user would take them, and on stdout what was put in.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// Effect to put in; may be given more than once; none makes a rig without a gap.
    #[arg(long, value_name = "EFFECT")]
    effect: Vec<String>,

    /// Which law of the effects, 0 being the plain one; `--list` shows them.
    #[arg(long, default_value_t = 0, value_parser = whole::<usize>(0..=u64::from(u32::MAX)))]
    law: usize,

    /// A rig as the field has them: nothing declared, no designed experiment, coloured noise, and what machines have besides.
    #[arg(long)]
    field: bool,

    /// What each effect leaves after the best nominal re-fit, in standard deviations of the noise; with `--field` what survives
    /// identification anew, over what the model of the rig without it leaves on held-out records.
    #[arg(long, default_value_t = 1.0, value_parser = number)]
    size: f64,

    /// Everything else is drawn from this.
    #[arg(long, default_value_t = 1, value_parser = whole::<u64>(0..=u64::MAX))]
    seed: u64,

    /// Order of the linear part, 1 to 3 [default: drawn].
    #[arg(long, value_parser = whole::<u8>(1..=3))]
    order: Option<u8>,

    /// Folder for rig.toml and the records.
    #[arg(long, value_name = "DIR", required_unless_present = "list")]
    out: Option<PathBuf>,

    /// Print what was put in, or the list, as JSON.
    #[arg(long)]
    json: bool,

    /// List effects and laws instead.
    #[arg(long)]
    list: bool,

    #[command(flatten)]
    output: Output,
}

/// Makes the rig, writes its folder, prints its key.
///
/// # Errors
/// An unknown effect or law, a size that is none, or a folder that cannot be written.
pub(crate) fn run(args: &Args) -> CommandResult {
    if args.list {
        print(&if args.json { stamped(LIST_SCHEMA, &list_file()) } else { list() })?;
        return Ok(Outcome::Done);
    }
    let recipe = recipe(args).map_err(RecipeError::from)?;
    let folder = args.output.force.claim_if_asked(args.out.as_deref(), &[rig::RIG_FILE], &[])?;
    let made = recipe.make().map_err(RecipeError::from)?;
    if let Some(folder) = folder {
        folder.commit(&rig::artefacts(&made.rig))?;
    }
    args.output.quiet.describe_or(args.json, || stamped(SCHEMA, &key_file(&made)), || reported(&made))?;
    Ok(Outcome::Done)
}

fn recipe(args: &Args) -> Result<MakeRig, MakeError> {
    let family = Family { order: args.order.map(usize::from), shape: None };
    let setting = if args.field { Setting::Field } else { Setting::Laboratory };
    let mut recipe = MakeRig::new(args.seed).family(family).setting(setting);
    for effect in args.effect.iter().filter(|name| *name != "none") {
        recipe = recipe.with(RequestedFault::with_law(effect, args.law, args.size)?);
    }
    Ok(recipe)
}

/// Name and version of the layout of what was put in.
const SCHEMA: &str = "switchback/rig/1";

/// The same of the list of effects.
const LIST_SCHEMA: &str = "switchback/rig-list/1";

/// The magnitude of an effect and its unit: lengths along the input in the input's own.
fn measured(effect: &TrueEffect, (rig, key): (&Rig, &Key)) -> (f64, String) {
    let length = effect.length(key.interval);
    length.map_or_else(|| (effect.magnitude, effect.unit.to_owned()), |x| (x, Units::of(rig).input))
}

fn reported(MadeRig { rig, key, .. }: &MadeRig) -> String {
    let between = if key.curved { " curved between the levels" } else { "" };
    let mut text =
        format!("order {}, {} borders{between}, noise sd {:.4}\n", key.order, key.borders, key.noise_sd);
    if key.setting == Setting::Field {
        let _ = writeln!(text, "of the field: by itself it has {}", in_a_row(&key.base));
    }
    let survives = match key.setting {
        Setting::Laboratory => "the best nominal re-fit with {} noise sd",
        Setting::Field => "identification anew with {} times what the model leaves without it",
    };
    for e in &key.effects {
        let (magnitude, unit) = measured(e, (rig, key));
        let quantity = e.quantity.map_or_else(String::new, |quantity| format!("{quantity} "));
        let _ = writeln!(
            text,
            "{} ({}, {}): {quantity}{magnitude:.4} {unit}; survives {}",
            e.effect,
            e.law,
            e.stage.name(),
            survives.replace("{}", &format!("{:.2}", e.size))
        );
        if (e.size / e.wanted - 1.0).abs() > 0.05 {
            let _ = writeln!(text, "  (asked for {}; this system and law go no closer)", e.wanted);
        }
    }
    if key.effects.is_empty() {
        text.push_str("no effect\n");
    }
    text
}

fn in_a_row(names: &[&str]) -> String {
    match names {
        [] => "nothing".to_owned(),
        [one] => (*one).to_owned(),
        [others @ .., last] => format!("{} and {last}", others.join(", ")),
    }
}

/// What was put into a made rig: `rig --json`.
///
/// Keys stand in the order of the alphabet.
#[derive(Serialize, JsonSchema)]
struct KeyFile<'a> {
    /// `a₁…aₙ`.
    a: &'a [f64],
    /// `b₁…bₙ`.
    b: &'a [f64],
    /// Effects that the machine has by itself.
    base: &'a [&'static str],
    /// Shape of the borders.
    borders: &'static str,
    /// Whether they are curved between the levels.
    curved: bool,
    /// The effects.
    effects: Vec<EffectFile>,
    /// Standard deviation of the noise.
    #[schemars(range(min = 0))]
    noise_sd: f64,
    /// Order of the linear part.
    order: usize,
    /// Its seed.
    seed: u64,
    /// Where the rig stands.
    #[schemars(with = "Setting")]
    setting: &'static str,
    /// Size of all effects together.
    #[schemars(range(min = 0))]
    size: f64,
}

/// An effect that was put in.
#[derive(Serialize, JsonSchema)]
struct EffectFile {
    /// The effect's name.
    effect: &'static str,
    /// Its law.
    law: &'static str,
    /// Its magnitude.
    magnitude: f64,
    /// Whether the law is the plain one.
    plain: bool,
    /// What the magnitude is.
    quantity: Option<&'static str>,
    /// Size reached.
    #[schemars(range(min = 0))]
    size: f64,
    /// Where it acts.
    #[schemars(with = "Stage")]
    stage: &'static str,
    /// Its unit.
    unit: String,
    /// Size asked for.
    #[schemars(range(min = 0))]
    wanted_size: f64,
}

/// Effects that rigs can be made with: `rig --list --json`.
#[derive(Serialize, JsonSchema)]
struct ListFile {
    /// Effects that the diagnosis knows.
    effects: Vec<LawsFile>,
    /// Effects that it does not know.
    foreign: Vec<LawsFile>,
}

/// The laws of an effect.
#[derive(Serialize, JsonSchema)]
struct LawsFile {
    /// The effect's name.
    effect: &'static str,
    /// Names of its laws, the plain one first.
    laws: Vec<&'static str>,
}

/// The JSON Schemas of what was put in and of the list of effects.
pub(crate) fn schemas() -> [Schema; 2] {
    [stamped_schema::<KeyFile<'_>>(SCHEMA), stamped_schema::<ListFile>(LIST_SCHEMA)]
}

fn key_file(MadeRig { rig, key, .. }: &MadeRig) -> KeyFile<'_> {
    let effect = |e: &TrueEffect| {
        let (magnitude, unit) = measured(e, (rig, key));
        EffectFile {
            effect: e.effect,
            law: e.law,
            magnitude,
            plain: e.plain,
            quantity: e.quantity,
            size: e.size,
            stage: e.stage.name(),
            unit,
            wanted_size: e.wanted,
        }
    };
    KeyFile {
        a: &key.a,
        b: &key.b,
        base: &key.base,
        borders: key.borders,
        curved: key.curved,
        effects: key.effects.iter().map(effect).collect(),
        noise_sd: key.noise_sd,
        order: key.order,
        seed: key.seed,
        setting: key.setting.name(),
        size: key.size,
    }
}

fn list() -> String {
    let mut text = String::new();
    for (title, names) in [("effects", EFFECTS.as_slice()), ("in no library of causes", FOREIGN.as_slice())] {
        let _ = writeln!(text, "{title}:");
        for name in names {
            let laws: Vec<_> =
                laws_of(name).iter().enumerate().map(|(i, law)| format!("{i} {}", law.name())).collect();
            let quantity = laws_of(name).first().and_then(|law| law.quantity());
            let quantity =
                quantity.map_or_else(String::new, |quantity| format!(" ({quantity}, in input units)"));
            let _ = writeln!(text, "  {name:22} {}{quantity}", laws.join(", "));
        }
    }
    text
}

fn list_file() -> ListFile {
    let laws = |names: &[&'static str]| -> Vec<LawsFile> {
        let laws = |name| laws_of(name).iter().map(|law| law.name()).collect();
        names.iter().map(|name| LawsFile { effect: name, laws: laws(name) }).collect()
    };
    ListFile { effects: laws(&EFFECTS), foreign: laws(&FOREIGN) }
}
