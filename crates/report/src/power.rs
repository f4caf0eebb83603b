//! The files of what a measurement of power found.

use crate::plots;
use switchback_io::output::Artefacts;
use switchback_lab::power::{self, Context, Power};

/// `power.json`, `power.csv`, `power.txt` and the figure.
pub fn artefacts(power: &Power, context: &Context<'_>) -> Artefacts {
    let mut artefacts = Artefacts::default();
    artefacts.add("power.json", power::json(power, context));
    artefacts.add("power.csv", power::csv(power));
    artefacts.add("power.txt", power::words(power, context));
    artefacts.add("power.svg", plots::power::figure(power, &context.rig().name));
    artefacts
}
