//! A run whose first border the first move shows.

use crate::step::Machine;

/// A machine from its start on.
///
/// Where a model runs on the border of its first move and it is unknown which, two runs go on side by side until the input shows: what is
/// shown until then is the one on the ascending border.
#[derive(Debug, Clone)]
pub struct Run {
    shown: Machine,
    falling: Option<Machine>,
}

impl Run {
    /// Begins at rest at an input, on the ascending border for a `branch` of +1, on the descending one for −1, by itself for 0.
    pub fn start(machine: &Machine, v: f64, branch: f64) -> Self {
        let started = |branch: f64| {
            let mut machine = machine.clone();
            machine.start(v, branch);
            machine
        };
        let waits = branch == 0.0 && machine.first_direction().is_some();
        Self { shown: started(branch), falling: waits.then(|| started(-1.0)) }
    }

    /// The output after one more sample of the input.
    pub fn step(&mut self, v: f64) -> f64 {
        let mut y = self.shown.step(v);
        if let Some(falling) = &mut self.falling {
            let other = falling.step(v);
            match self.shown.first_direction() {
                Some(0.0) => return y,
                Some(first) if first < 0.0 => {
                    std::mem::swap(&mut self.shown, falling);
                    y = other;
                }
                _ => {}
            }
            self.falling = None;
        }
        y
    }

    /// The last output; that of rest after a start.
    pub fn output(&self) -> f64 {
        self.shown.output()
    }

    /// The next output, where it does not depend on the next input.
    ///
    /// # Panics
    /// If it does: see [`Program::direct`](crate::step::Program::direct).
    pub fn foreseen(&mut self, v: f64) -> f64 {
        assert!(!self.shown.program().direct, "the next output depends on the next input");
        let memory = self.shown.memory().clone();
        let y = self.shown.step(v);
        self.shown.restore(memory);
        y
    }
}
