//! What the functions of FMI do, without pointers.

use crate::fmi2::ValueReference;
use crate::package::{Package, references};
use std::fmt;
use std::sync::Arc;
use switchback_model::step::{Fault, Machine, Run};

/// Why a call is refused.
#[derive(Debug, Clone, PartialEq)]
pub enum Refusal {
    /// A function was called out of its turn.
    Turn {
        /// The function.
        function: &'static str,
        /// What state the instance is in.
        while_in: &'static str,
    },
    /// There is no such variable, or it cannot be set.
    Variable {
        /// Its number.
        reference: ValueReference,
        /// What was asked: `read` or `set`, and its type.
        asked: &'static str,
    },
    /// The input is no finite number.
    Input(f64),
    /// The border is none.
    Border(i32),
    /// The step is no multiple of the sample time.
    Step {
        /// Seconds asked for.
        step: f64,
        /// Seconds between samples.
        sample_time: f64,
    },
    /// The step does not begin where the last one ended.
    Point {
        /// Seconds at which it begins.
        point: f64,
        /// Where the instance stands.
        stands: f64,
    },
    /// The input runs along a border that the model does not know.
    Unknown(f64),
}

impl fmt::Display for Refusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Turn { function, while_in } => write!(f, "{function} cannot be called while {while_in}"),
            Self::Variable { reference, asked } => write!(f, "the variable {reference} cannot be {asked}"),
            Self::Input(v) => write!(f, "the input is {v}, which is no finite number"),
            Self::Border(border) => write!(f, "`border` is {border}, but must be -1, 0 or 1"),
            Self::Step { step, sample_time } => {
                write!(f, "a step of {step} s is no multiple of the sample time, {sample_time} s")
            }
            Self::Point { point, stands } => {
                write!(f, "a step begins at {point} s, but this instance stands at {stands} s")
            }
            Self::Unknown(v) => {
                write!(f, "at an input of {v} the model runs along a border that it does not know")
            }
        }
    }
}

impl std::error::Error for Refusal {}

/// Where an instance is in its life.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Phase {
    Instantiated,
    Initializing,
    Running,
    Terminated,
}

impl Phase {
    fn name(self) -> &'static str {
        match self {
            Self::Instantiated => "it is instantiated and not initialized",
            Self::Initializing => "it is initialized",
            Self::Running => "it runs",
            Self::Terminated => "it is terminated",
        }
    }
}

/// Share of the sample time within which times are the same.
const SAME: f64 = 1e-6;

/// An instance of an FMU.
#[derive(Debug, Clone)]
pub struct Instance {
    package: Arc<Package>,
    machine: Machine,
    phase: Phase,
    v: f64,
    y: f64,
    border: i32,
    begins: f64,
    samples: u64,
    run: Option<Run>,
    outside: bool,
}

impl Instance {
    /// A fresh one.
    ///
    /// # Errors
    /// [`Fault`] where the program cannot run.
    pub fn new(package: Arc<Package>) -> Result<Self, Fault> {
        let machine = Machine::new(Arc::new(package.program.clone()))?;
        let v = package.start;
        let phase = Phase::Instantiated;
        let mut instance = Self {
            package,
            machine,
            phase,
            v,
            y: 0.0,
            border: 0,
            begins: 0.0,
            samples: 0,
            run: None,
            outside: false,
        };
        instance.rest();
        Ok(instance)
    }

    /// As fresh again.
    pub fn reset(&mut self) {
        self.phase = Phase::Instantiated;
        (self.v, self.border, self.begins) = (self.package.start, 0, 0.0);
        self.rest();
    }

    /// When it begins, seconds.
    ///
    /// # Errors
    /// [`Refusal::Turn`] once it is initialized.
    pub fn set_up(&mut self, begins: f64) -> Result<(), Refusal> {
        self.only(Phase::Instantiated, "fmi2SetupExperiment")?;
        self.begins = begins;
        Ok(())
    }

    /// Begins its initialization.
    ///
    /// # Errors
    /// [`Refusal::Turn`] out of turn.
    pub fn enter_initialization(&mut self) -> Result<(), Refusal> {
        self.only(Phase::Instantiated, "fmi2EnterInitializationMode")?;
        self.phase = Phase::Initializing;
        Ok(())
    }

    /// Ends it: a run begins at rest at the input that was set.
    ///
    /// # Errors
    /// [`Refusal::Turn`] out of turn.
    pub fn exit_initialization(&mut self) -> Result<(), Refusal> {
        self.only(Phase::Initializing, "fmi2ExitInitializationMode")?;
        self.rest();
        self.phase = Phase::Running;
        Ok(())
    }

    /// Ends the run.
    ///
    /// # Errors
    /// [`Refusal::Turn`] where none runs.
    pub fn terminate(&mut self) -> Result<(), Refusal> {
        self.only(Phase::Running, "fmi2Terminate")?;
        self.phase = Phase::Terminated;
        Ok(())
    }

    /// Sets a real variable.
    ///
    /// # Errors
    /// [`Refusal`] where it is none that can be set, or the value no number.
    pub fn set_real(&mut self, reference: ValueReference, value: f64) -> Result<(), Refusal> {
        match reference {
            references::V if value.is_finite() => {
                self.v = value;
                if self.phase != Phase::Running {
                    self.rest();
                }
                Ok(())
            }
            references::V => Err(Refusal::Input(value)),
            _ => Err(Refusal::Variable { reference, asked: "set as a real" }),
        }
    }

    /// Sets an integer variable.
    ///
    /// # Errors
    /// [`Refusal`] where it is none that can be set, is out of its range, or comes too late.
    pub fn set_integer(&mut self, reference: ValueReference, value: i32) -> Result<(), Refusal> {
        match reference {
            references::BORDER if !(-1..=1).contains(&value) => Err(Refusal::Border(value)),
            references::BORDER if self.phase == Phase::Running => {
                Err(Refusal::Turn { function: "setting `border`", while_in: self.phase.name() })
            }
            references::BORDER => {
                self.border = value;
                self.rest();
                Ok(())
            }
            _ => Err(Refusal::Variable { reference, asked: "set as an integer" }),
        }
    }

    /// A real variable.
    ///
    /// # Errors
    /// [`Refusal::Variable`] where there is none of this number.
    pub fn real(&self, reference: ValueReference) -> Result<f64, Refusal> {
        let constant = reference.checked_sub(references::CONSTANTS).map(|k| k as usize);
        match reference {
            references::V => Ok(self.v),
            references::Y => Ok(self.y),
            _ => constant
                .and_then(|k| self.package.constants.get(k).copied())
                .ok_or(Refusal::Variable { reference, asked: "read as a real" }),
        }
    }

    /// An integer variable.
    ///
    /// # Errors
    /// [`Refusal::Variable`] where there is none of this number.
    pub fn integer(&self, reference: ValueReference) -> Result<i32, Refusal> {
        match reference {
            references::BORDER => Ok(self.border),
            references::OUTPUT_DELAY => Ok(self.package.output_delay() as i32),
            _ => Err(Refusal::Variable { reference, asked: "read as an integer" }),
        }
    }

    /// A boolean variable.
    ///
    /// # Errors
    /// [`Refusal::Variable`] where there is none of this number.
    pub fn boolean(&self, reference: ValueReference) -> Result<bool, Refusal> {
        match reference {
            references::OUTSIDE => Ok(self.outside),
            _ => Err(Refusal::Variable { reference, asked: "read as a boolean" }),
        }
    }

    /// A step of `step` seconds from `point` on, a whole number of samples at the input that was set.
    ///
    /// # Errors
    /// [`Refusal`] out of turn, for another step, or where the model does not know its border; it stands where it stood.
    pub fn step(&mut self, point: f64, step: f64) -> Result<(), Refusal> {
        self.only(Phase::Running, "fmi2DoStep")?;
        let sample_time = self.package.sample_time;
        let count = (step / sample_time).round();
        if !(count >= 1.0 && (step - count * sample_time).abs() <= SAME * sample_time) {
            return Err(Refusal::Step { step, sample_time });
        }
        let stands = self.time();
        if (point - stands).abs() > 0.5 * sample_time {
            return Err(Refusal::Point { point, stands });
        }
        let run = self.run.as_mut().expect("a run begins with the initialization");
        for _ in 0..count as u64 {
            self.y = run.step(self.v);
        }
        if self.package.output_delay() == 0 {
            self.y = run.foreseen(self.v);
        }
        self.samples += count as u64;
        let [low, high] = self.package.interval;
        self.outside |= self.v < low || self.v > high;
        match self.y.is_nan() {
            true => Err(Refusal::Unknown(self.v)),
            false => Ok(()),
        }
    }

    /// Seconds at which it stands.
    pub fn time(&self) -> f64 {
        self.begins + self.samples as f64 * self.package.sample_time
    }

    /// A run at its beginning.
    fn rest(&mut self) {
        let run = Run::start(&self.machine, self.v, f64::from(self.border));
        self.y = run.output();
        (self.run, self.samples, self.outside) = (Some(run), 0, false);
    }

    fn only(&self, phase: Phase, function: &'static str) -> Result<(), Refusal> {
        match self.phase == phase {
            true => Ok(()),
            false => Err(Refusal::Turn { function, while_in: self.phase.name() }),
        }
    }
}
