//! Foreign code in processes of its own: co-simulation FMUs over the records of a rig, and commands that answer line by line.
//!
//! The library of an FMU is foreign code. Three processes keep its accidents apart from the diagnosis:
//!
//! | process | file | purpose |
//! |---|---|---|
//! | the diagnosis | `predict`, `process` | sends the inputs, reads outputs and messages within bounds, waits no longer than its patience |
//! | the guard, `fmu-host` | `guard` | owns the folder of the FMU and all its processes; removes both when the FMU or the diagnosis ends, however it ends |
//! | the simulation, `fmu-host --inside` | `simulation`, `functions` | unpacks the FMU, reads its description, loads its library, within limits |
//!
//! A command that answers (`worker`) has two: its guard, and itself; `service` is its side where it is one of ours.
//!
//! `messages` is what they say to each other, `archive` and `description` read the FMU, `map` chooses its variables, `system` are calls of
//! the operating system.

mod archive;
mod description;
mod error;
mod folder;
mod functions;
mod guard;
mod map;
mod messages;
mod predict;
mod process;
mod reporter;
mod service;
mod simulation;
mod system;
mod worker;

pub use error::FmuError;
pub use guard::become_command;
pub use guard::guard;
pub use guard::guard_command;
pub use map::Map;
pub use map::map;
pub use messages::{End, heard};
pub use predict::Simulator;
pub use predict::predictions;
pub use process::stop;
pub use service::numbers;
pub use service::serve;
pub use simulation::simulate;
pub use worker::Heard;
pub use worker::Worker;
