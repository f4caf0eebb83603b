//! `step_change`: a gain or the width of the loop changes at one instant.

use crate::generate::effects::motion::{directions, half_width};
use crate::generate::law::{Injection, Law, Scene, Stage};

pub(super) static LAWS: [&dyn Law; 4] = [
    &StepChange { of: Of::Gain, course: Course::Abrupt },
    &StepChange { of: Of::Loop, course: Course::Abrupt },
    &StepChange { of: Of::Gain, course: Course::Ramp },
    &StepChange { of: Of::Loop, course: Course::Ramp },
];

/// What changes.
#[derive(Debug)]
enum Of {
    /// `u' = (1 ± x·h)·u`: a setting of the actuator.
    Gain,
    /// Half-width × `(1 ± x·h)`, the mid-line stays: the tension of a belt, the load on a bearing.
    Loop,
}

/// How it changes from `h = 0` to `h = 1`, at 0.2 to 0.6 of the dataset: its last quarter are the records held out.
#[derive(Debug)]
enum Course {
    /// From one sample to the next.
    Abrupt,
    /// Over 20 to 200 samples.
    Ramp,
}

#[derive(Debug)]
struct StepChange {
    of: Of,
    course: Course,
}

impl StepChange {
    /// `h` at every sample of a passage.
    fn course(&self, scene: &Scene<'_>) -> Vec<f64> {
        let passage = scene.passage;
        let instant = scene.amount.between(0, 0.2, 0.6) * passage.total as f64;
        let samples = match self.course {
            Course::Abrupt => 1.0,
            Course::Ramp => scene.amount.between(1, 20.0, 200.0),
        };
        let h = |t: usize| (((passage.start + t) as f64 - instant) / samples).clamp(0.0, 1.0);
        (0..passage.v.len()).map(h).collect()
    }
}

impl Law for StepChange {
    fn effect(&self) -> &'static str {
        "step_change"
    }
    fn name(&self) -> &'static str {
        match (&self.of, &self.course) {
            (Of::Gain, Course::Abrupt) => "gain, abrupt",
            (Of::Loop, Course::Abrupt) => "loop, abrupt",
            (Of::Gain, Course::Ramp) => "gain, ramp",
            (Of::Loop, Course::Ramp) => "loop, ramp",
        }
    }
    fn stage(&self) -> Stage {
        Stage::Operator
    }
    fn unit(&self) -> &'static str {
        match self.of {
            Of::Gain => "share of the gain",
            Of::Loop => "half-widths of the loop",
        }
    }
    fn limit(&self) -> f64 {
        0.9
    }
    fn injection(&self) -> Injection {
        match self.of {
            Of::Gain => Injection::Gain,
            Of::Loop => Injection::Carried,
        }
    }

    fn operator(&self, scene: &mut Scene<'_>, v: &[f64], u: &mut [f64]) {
        let Of::Loop = self.of else { return };
        let change = scene.x() * scene.amount.sign(2);
        let directions = directions(scene.machine, v);
        for (t, h) in self.course(scene).into_iter().enumerate() {
            u[t] += change * h * directions[t] * half_width(scene.machine, v[t]);
        }
    }

    fn dynamics(&self, scene: &mut Scene<'_>, u: &mut [f64]) {
        let Of::Gain = self.of else { return };
        let change = scene.x() * scene.amount.sign(2);
        u.iter_mut().zip(self.course(scene)).for_each(|(u, h)| *u *= 1.0 + change * h);
    }
}
