//! `gain_drift`: the gain of the linear part changes over the dataset.

use super::envelope::Envelope;
use crate::generate::law::{Injection, Law, Scene};

pub(super) static LAWS: [&dyn Law; 4] = [
    &Drift { envelope: Envelope::Ramp },
    &Drift { envelope: Envelope::WarmUp },
    &Drift { envelope: Envelope::Sinusoid },
    &Drift { envelope: Envelope::RandomWalk },
];

/// `u'(t) = (1 + x·g(t))·u(t)` with an envelope `g` over dataset time.
#[derive(Debug)]
struct Drift {
    envelope: Envelope,
}

impl Law for Drift {
    fn effect(&self) -> &'static str {
        "gain_drift"
    }
    fn name(&self) -> &'static str {
        self.envelope.name()
    }
    fn stage(&self) -> crate::generate::law::Stage {
        crate::generate::law::Stage::Dynamics
    }
    fn unit(&self) -> &'static str {
        "share of the gain over the dataset"
    }
    fn limit(&self) -> f64 {
        0.8
    }

    fn injection(&self) -> Injection {
        Injection::Gain
    }

    fn dynamics(&self, scene: &mut Scene<'_>, u: &mut [f64]) {
        let clock = (0..u.len()).map(|t| scene.passage.clock(t));
        let course = self.envelope.course(&scene.amount, clock);
        u.iter_mut().zip(course).for_each(|(u, g)| *u += scene.amount.magnitude * g * *u);
    }
}
