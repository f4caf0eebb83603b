//! What is asked of a study beside its scenario.

use crate::scenario::{Engine, Scenario};
use std::path::Path;
use switchback_io::input::stream;

/// By which engine replicates are computed.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Request {
    /// The engine; else that of the scenario.
    pub engine: Option<Engine>,
}

impl Request {
    /// A scenario on the engine asked for.
    pub fn of(self, scenario: Scenario) -> Scenario {
        match self.engine {
            Some(engine) => scenario.on(engine),
            None => scenario,
        }
    }

    /// The command that makes the results of a scenario file again, without the place where this machine keeps it.
    pub fn command(self, file: &Path) -> String {
        let name = stream::file_name(file);
        let engine = self.engine.map_or_else(String::new, |engine| format!(" --engine {}", engine.name()));
        format!("switchback {name}{engine}")
    }
}
