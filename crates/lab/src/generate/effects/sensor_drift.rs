//! `sensor_drift`: the sensor's zero wanders.

use super::card;
use super::envelope::Envelope;
use crate::generate::law::{Law, Scene};

pub(super) static LAWS: [&dyn Law; 4] = [
    &Drift { envelope: Envelope::Ramp },
    &Drift { envelope: Envelope::Sinusoid },
    &Drift { envelope: Envelope::RandomWalk },
    &Reset,
];

/// `y'(t) = y(t) + x·σ·g(t)` with an envelope `g` over dataset time.
#[derive(Debug)]
struct Drift {
    envelope: Envelope,
}

impl Law for Drift {
    fn effect(&self) -> &'static str {
        "sensor_drift"
    }
    fn name(&self) -> &'static str {
        self.envelope.name()
    }
    fn stage(&self) -> crate::generate::law::Stage {
        crate::generate::law::Stage::Sensor
    }
    fn unit(&self) -> &'static str {
        "noise sd"
    }
    fn limit(&self) -> f64 {
        2000.0
    }

    fn sensor(&self, scene: &mut Scene<'_>, y: &mut [f64]) {
        let clock = (0..y.len()).map(|t| scene.passage.clock(t));
        let course = self.envelope.course(&scene.amount, clock);
        let scale = scene.x() * scene.machine.noise_sd;
        y.iter_mut().zip(course).for_each(|(y, g)| *y += scale * g);
    }
}

/// A zero that is set before each record and relaxes from then on: `y' = y + x·σ·(1 − e^{−t/τ})`, τ 300 to 2,000 samples.
#[derive(Debug)]
struct Reset;

impl Law for Reset {
    card!("sensor_drift", "relaxation after each reset", Sensor, "noise sd", 2000.0);

    fn sensor(&self, scene: &mut Scene<'_>, y: &mut [f64]) {
        let time = scene.amount.between(0, 300.0, 2000.0);
        let scale = scene.x() * scene.machine.noise_sd;
        for (t, y) in y.iter_mut().skip(scene.passage.lead).enumerate() {
            *y += scale * (1.0 - (-(t as f64) / time).exp());
        }
    }
}
