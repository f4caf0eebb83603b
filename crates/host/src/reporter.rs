//! Lines of a running simulation on its standard output.

use crate::messages::Line;
use crate::system;
use std::io::{self, Write};
use std::time::{Duration, Instant};

/// From one sign of life to the next.
const HEARTBEAT: Duration = Duration::from_millis(200);

/// Writes lines.
pub(crate) struct Reporter {
    #[cfg(unix)]
    lines: std::fs::File,
    #[cfg(not(unix))]
    lines: io::Stdout,
    last: Option<Instant>,
}

impl Reporter {
    /// Takes the standard output over, so that nothing else is written there.
    ///
    /// # Errors
    /// If the system refuses.
    pub(crate) fn on_standard_output() -> io::Result<Self> {
        Ok(Self { lines: system::take_standard_output()?, last: None })
    }

    /// Writes a line.
    pub(crate) fn report(&mut self, line: &Line) -> io::Result<()> {
        self.last = Some(Instant::now());
        let text = serde_json::to_string(line).expect("numbers and words are JSON");
        self.lines.write_all((text + "\n").as_bytes())?;
        self.lines.flush()
    }

    /// The same, unless another line was written a moment ago.
    pub(crate) fn report_sometimes(&mut self, line: &Line) -> io::Result<()> {
        if self.last.is_some_and(|last| last.elapsed() < HEARTBEAT) { Ok(()) } else { self.report(line) }
    }

    pub(crate) fn reached(&mut self, record: usize, sample: usize) -> io::Result<()> {
        let line = Line::At(record, sample);
        if sample == 0 { self.report(&line) } else { self.report_sometimes(&line) }
    }
}
