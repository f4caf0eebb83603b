//! The rigs whose diagnosis is timed.

use std::path::Path;
use switchback_io::rig;
use switchback_lab::generate::{Family, MakeRig, Plan, RequestedFault, Shape};
use switchback_model::rig::Rig;

/// A rig to be diagnosed.
pub(crate) struct BenchRig {
    /// Its name in the table.
    pub(crate) name: String,
    /// Its records.
    pub(crate) rig: Rig,
    /// Whether it is one of the ten that the median is over.
    pub(crate) counts: bool,
}

/// The ten rigs of others that the figures in reports are about.
const MEASURED: [&str; 10] = [
    "made-coloured_noise",
    "made-none",
    "field/clt-wall",
    "field/robot-arm",
    "pneumatic-seal",
    "mr-damper",
    "made-extra_pole",
    "made-backlash",
    "field/mr-rates-0A",
    "piezo-stage",
];

/// Some 20,000 samples.
const PLAN: Plan = Plan { step: 1500, periods: 120, sweep: 6000, drive: 4000, repeat_periods: 40 };
/// Ten times as many.
const LONG: Plan = Plan { step: 15_000, periods: 1200, sweep: 60_000, drive: 40_000, repeat_periods: 400 };

/// Rigs made here: borders that jump, two effects, no order declared. Of a short list for a trial run only the first.
pub(crate) fn made(is_measured: bool) -> Vec<BenchRig> {
    let pairs: [(&str, &[&str], Plan); 6] = [
        ("jumping-none", &[], PLAN),
        ("jumping-backlash-pole", &["backlash", "extra_pole"], PLAN),
        ("jumping-rate-drift", &["rate_dependence", "sensor_drift"], PLAN),
        ("jumping-wear-colour", &["border_wear", "coloured_noise"], PLAN),
        ("jumping-transition-clip", &["gradual_transition", "sensor_saturation"], PLAN),
        ("jumping-backlash-pole-long", &["backlash", "extra_pole"], LONG),
    ];
    let family = Family { order: Some(2), shape: Some(Shape::Discontinuous) };
    let wanted = if is_measured { pairs.len() } else { 1 };
    let make = |(name, effects, plan): &(&str, &[&str], Plan)| {
        let plain = MakeRig::new(20_261_125).family(family).plan(*plan);
        let size = |effect: &&str| RequestedFault::plain(effect, 2.0).expect("an effect of the maker");
        let recipe = effects.iter().map(size).fold(plain, MakeRig::with);
        let mut rig = recipe.make().expect("a rig can be made of this seed").rig;
        rig.order = None;
        BenchRig { name: (*name).to_owned(), rig, counts: false }
    };
    pairs[..wanted].iter().map(make).collect()
}

/// Measured rigs, and rigs made by others, where their folder is there.
pub(crate) fn measured() -> Vec<BenchRig> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/rigs");
    if !folder.is_dir() {
        println!("{} is absent: no measured rigs", folder.display());
        return Vec::new();
    }
    let read = |name: &&str| {
        let rig = rig::read(&folder.join(name).join("rig.toml")).expect("a readable rig");
        BenchRig { name: (*name).to_owned(), rig, counts: true }
    };
    MEASURED.iter().map(read).collect()
}
