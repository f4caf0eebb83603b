//! The files of what a measurement of power found.

use crate::plots;
use switchback_io::output::Artefacts;
use switchback_lab::power::{self, Ground, Power};

/// `power.json`, `power.csv`, `power.txt` and the figure.
pub fn artefacts(power: &Power, ground: &Ground<'_>) -> Artefacts {
    let mut artefacts = Artefacts::default();
    artefacts.add("power.json", power::json(power, ground));
    artefacts.add("power.csv", power::csv(power));
    artefacts.add("power.txt", power::words(power, ground));
    artefacts.add("power.svg", plots::power::figure(power, &ground.rig().name));
    artefacts
}
