//! The predictions of an FMU for every record of a rig.

use super::archive::unpack;
use super::description::Description;
use super::error::FmuError;
use super::job::{Job, Line};
use super::map::Map;
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::thread;
use std::time::{Duration, Instant};
use switchback_model::rig::Rig;

/// An FMU and how it is run.
#[derive(Debug, Clone)]
pub struct Simulator<'a> {
    /// The archive.
    pub fmu: &'a Path,
    /// Which of its variables are the input and the output.
    pub map: Map,
    /// It is given up where nothing happens for so long.
    pub patience: Duration,
}

/// From one look at the process to the next.
const LOOK: Duration = Duration::from_millis(5);

/// The rig with the FMU's outputs as predictions of all its records.
///
/// # Errors
/// [`FmuError`] where it is no co-simulation FMU 2.0 for this platform, has not the variables, crashes, refuses, or does not return.
pub fn predictions(mut rig: Rig, simulator: &Simulator<'_>) -> Result<Rig, FmuError> {
    let fmu = simulator.fmu;
    let fail = |what: String| FmuError::new(fmu, what, "free some space, or set TMPDIR to another folder");
    let folder =
        tempfile::tempdir().map_err(|error| fail(format!("no folder to unpack it into: {error}")))?;
    let unpacked = folder.path().join("fmu");
    unpack(fmu, &unpacked)?;
    let description = Description::read(fmu, &unpacked)?;
    let ports = simulator.map.find(fmu, &description)?;
    ports.check_units(fmu, &rig)?;
    let job = Job {
        library: description.library,
        resources: unpacked.join("resources"),
        guid: description.guid,
        input: ports.input.reference,
        output: ports.output.reference,
        delay: ports.delay,
        sample_time: rig.sample_time,
        inputs: rig.records.iter().map(|record| record.record.v().to_vec()).collect(),
    };
    let place = folder.path().join("job.json");
    let text = serde_json::to_string(&job).expect("numbers and words are JSON");
    fs::write(&place, text).map_err(|error| fail(error.to_string()))?;
    let names: Vec<String> = rig.records.iter().map(|record| record.name.clone()).collect();
    let runs = Process { simulator, place, names: &names }.outputs()?;
    for (record, y) in rig.records.iter_mut().zip(runs) {
        record.predicted = Some(y);
    }
    Ok(rig)
}

/// The process of an FMU.
struct Process<'a> {
    simulator: &'a Simulator<'a>,
    /// The job; what the process shows and says is beside it.
    place: PathBuf,
    names: &'a [String],
}

/// How it ended.
enum End {
    /// By itself.
    Itself(ExitStatus),
    /// It was ended, for nothing had happened for too long.
    Silent,
}

impl Process<'_> {
    fn outputs(&self) -> Result<Vec<Vec<f64>>, FmuError> {
        let child =
            self.start().map_err(|error| self.error(format!("its process does not start: {error}")))?;
        let end = self.wait(child).map_err(|error| self.error(format!("its process is lost: {error}")))?;
        let (mut runs, mut at) = (Vec::new(), None);
        for line in self.lines() {
            match line {
                Line::At(record, sample) => at = Some((record, sample)),
                Line::Ran(_, y) => runs.push(y),
                Line::Failed(why) => return Err(self.stopped(at, &why)),
            }
        }
        match end {
            End::Silent => {
                let patience = self.simulator.patience.as_secs_f64();
                Err(self.stopped(at, &format!("it did not return within {patience} s and was ended")))
            }
            End::Itself(_) if runs.len() == self.names.len() => Ok(runs),
            End::Itself(status) => Err(self.stopped(at, &format!("it crashed ({status})"))),
        }
    }

    fn start(&self) -> std::io::Result<Child> {
        let said = File::create(self.place.with_extension("said"))?;
        Command::new(std::env::current_exe()?)
            .arg("fmu-host")
            .arg(&self.place)
            .current_dir(self.place.parent().unwrap_or(Path::new(".")))
            .stdin(Stdio::null())
            .stdout(said.try_clone()?)
            .stderr(said)
            .spawn()
    }

    fn wait(&self, mut child: Child) -> std::io::Result<End> {
        let reported = self.place.with_extension("lines");
        let (mut size, mut since) = (0, Instant::now());
        loop {
            if let Some(status) = child.try_wait()? {
                return Ok(End::Itself(status));
            }
            let now = fs::metadata(&reported).map_or(0, |reported| reported.len());
            if now != size {
                (size, since) = (now, Instant::now());
            }
            if since.elapsed() > self.simulator.patience {
                child.kill()?;
                child.wait()?;
                return Ok(End::Silent);
            }
            thread::sleep(LOOK);
        }
    }

    fn lines(&self) -> Vec<Line> {
        let text = fs::read_to_string(self.place.with_extension("lines")).unwrap_or_default();
        // A process that was ended may have left half a line.
        text.lines().map_while(|line| serde_json::from_str(line).ok()).collect()
    }

    /// It stopped in a record.
    fn stopped(&self, at: Option<(usize, usize)>, why: &str) -> FmuError {
        let place = match at {
            Some((record, sample)) => {
                let name = self.names.get(record).map_or("?", String::as_str);
                format!("in the record {name}, at sample {sample} or soon after, ")
            }
            None => String::new(),
        };
        self.error(format!("{place}{why}{}", self.said()))
    }

    /// The last words of the FMU.
    fn said(&self) -> String {
        let text = fs::read(self.place.with_extension("said")).unwrap_or_default();
        let text = String::from_utf8_lossy(&text).into_owned();
        let last: Vec<&str> = text.lines().filter(|line| !line.trim().is_empty()).collect();
        let last = &last[last.len().saturating_sub(3)..];
        if last.is_empty() { String::new() } else { format!("; it said: {}", last.join(" / ")) }
    }

    fn error(&self, what: String) -> FmuError {
        let remedy = format!(
            "try it in the simulator that exported it, with a step of the records' sample time; `--patience SECONDS` waits longer than {} s",
            self.simulator.patience.as_secs_f64()
        );
        FmuError::new(self.simulator.fmu, what, remedy)
    }
}
