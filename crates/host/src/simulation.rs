//! The process in which an FMU runs.

use crate::archive::unpack;
use crate::description::Description;
use crate::error::FmuError;
use crate::functions::run;
use crate::map::Ports;
use crate::messages::{Job, Line};
use crate::system;
use std::io::{self, BufRead, Write};
use std::path::Path;
use std::time::{Duration, Instant};

/// From one sign of life to the next.
const HEARTBEAT: Duration = Duration::from_millis(200);

/// Unpacks an FMU into the working folder and runs it over a job, the first line of standard input. What comes out goes to standard output; what
/// the FMU prints, to standard error.
///
/// # Errors
/// If the job cannot be read, or nothing can be reported.
pub fn simulate(fmu: &Path) -> io::Result<()> {
    system::end_with_parent();
    let mut job = String::new();
    io::stdin().lock().read_line(&mut job)?;
    let job: Job = serde_json::from_str(&job)?;
    let mut teller = Teller { lines: system::take_standard_output()?, last: None };
    let unpacked = Path::new("fmu");
    match opened(fmu, unpacked, &job, &mut teller) {
        Ok((description, ports)) => {
            system::limit();
            let ended = run(&description, &ports, (&job, unpacked), &mut teller);
            ended.or_else(|why| teller.tell(&Line::Failed(why)))
        }
        Err(error) => teller.tell(&Line::Refused(error.what, error.remedy)),
    }
}

fn opened(
    fmu: &Path,
    folder: &Path,
    job: &Job,
    teller: &mut Teller,
) -> Result<(Description, Ports), FmuError> {
    unpack(fmu, folder, |bytes| drop(teller.tell_sometimes(&Line::Unpacked(bytes))))?;
    let description = Description::read(fmu, folder)?;
    let ports = job.map.find(fmu, &description)?;
    ports.check_units(fmu, &job.labels)?;
    Ok((description, ports))
}

/// Writes lines.
pub(crate) struct Teller {
    #[cfg(unix)]
    lines: std::fs::File,
    #[cfg(not(unix))]
    lines: io::Stdout,
    last: Option<Instant>,
}

impl Teller {
    pub(crate) fn tell(&mut self, line: &Line) -> io::Result<()> {
        self.last = Some(Instant::now());
        let text = serde_json::to_string(line).expect("numbers and words are JSON");
        self.lines.write_all((text + "\n").as_bytes())?;
        self.lines.flush()
    }

    /// The same, unless another line was written a moment ago.
    fn tell_sometimes(&mut self, line: &Line) -> io::Result<()> {
        if self.last.is_some_and(|last| last.elapsed() < HEARTBEAT) { Ok(()) } else { self.tell(line) }
    }

    pub(crate) fn stands(&mut self, record: usize, sample: usize) -> io::Result<()> {
        let line = Line::At(record, sample);
        if sample == 0 { self.tell(&line) } else { self.tell_sometimes(&line) }
    }
}
