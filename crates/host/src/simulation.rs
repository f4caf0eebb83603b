//! The process in which an FMU runs.

use crate::archive::unpack;
use crate::description::Description;
use crate::error::FmuError;
use crate::functions::run;
use crate::map::Ports;
use crate::messages::{Job, Line};
use crate::reporter::Reporter;
use crate::system;
use std::io::{self, BufRead};
use std::path::Path;

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
    let mut reporter = Reporter::on_standard_output()?;
    let unpacked = Path::new("fmu");
    match opened(fmu, unpacked, &job, &mut reporter) {
        Ok((description, ports)) => {
            system::limit();
            let ended = run(&description, &ports, (&job, unpacked), &mut reporter);
            ended.or_else(|why| reporter.report(&Line::Failed(why)))
        }
        Err(error) => reporter.report(&Line::Refused(error.what, error.remedy)),
    }
}

fn opened(
    fmu: &Path,
    folder: &Path,
    job: &Job,
    reporter: &mut Reporter,
) -> Result<(Description, Ports), FmuError> {
    unpack(fmu, folder, |bytes| drop(reporter.report_sometimes(&Line::Unpacked(bytes))))?;
    let description = Description::read(fmu, folder)?;
    let ports = job.map.find(fmu, &description)?;
    ports.check_units(fmu, &job.labels)?;
    Ok((description, ports))
}
