//! `deadband`: a drive that ignores commands near the last one that it obeyed.

use crate::generate::effects::card;
use crate::generate::law::{INTERVAL_WIDTHS, Law, Scene};

pub(super) static LAWS: [&dyn Law; 1] = [&LastObeyed];

/// The arriving input keeps its value until the command is more than `x` away, and then takes the command's.
#[derive(Debug)]
struct LastObeyed;

impl Law for LastObeyed {
    card!("deadband", "last command obeyed", Input, INTERVAL_WIDTHS, 0.2);

    fn drive(&self, scene: &mut Scene<'_>, v: &mut [f64]) {
        let band = scene.x() * scene.machine.interval.width();
        let mut obeyed = v[0];
        for now in v {
            if (*now - obeyed).abs() > band {
                obeyed = *now;
            }
            *now = obeyed;
        }
    }
}
