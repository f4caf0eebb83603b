//! What is asked of files of measurements, or of one rig file.

use super::assemble::Loaded;
use super::plan::{HELD_OUT, Plan, PlannedRecord};
use super::problem::{RigError, RigProblem};
use super::read::{load, load_plan};
use super::survey::{self, Survey};
use crate::input::{FileKind, stream};
use crate::output::{in_shell, path_in_shell};
use crate::values::is_positive;
use std::path::{Component, Path, PathBuf};
use switchback_model::rig::{Role, Usage};
use switchback_table::signals::{Between, ColumnNames, InputForm, NO_TIME, Sampling};

/// Files of measurements and how to read them, or one rig file, which says for itself what the other fields would.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Request {
    /// Files of measurements, one a record; or one rig file.
    pub data: Vec<PathBuf>,
    /// Names of columns.
    pub columns: ColumnNames,
    /// Seconds between samples; else reported by the time column.
    pub sample_time: Option<f64>,
    /// Samples a second, instead of the sample time.
    pub rate: Option<f64>,
    /// What models are judged on: a share of every record, at its end, or a file; else the last third of a single file, or the last file.
    pub holdout: Option<String>,
    /// Bring uneven rows to even ones in this way.
    pub resample: Option<Between>,
}

impl Request {
    /// Reads the rig. `verb` is the command's name, for remedies.
    ///
    /// # Errors
    /// [`RigError`] with all that is wrong.
    pub fn load(&self, verb: &str) -> Result<Loaded, RigError> {
        match self.source()? {
            Source::RigFile(path) => {
                self.refuse_flags(path)?;
                load(path)
            }
            Source::Files => load_plan(&self.plan(verb)?),
        }
    }

    /// What a rig file for these data says, without holding long files in memory.
    ///
    /// # Errors
    /// [`RigError`] with all that is wrong, of long files with what is wrong first.
    pub fn survey(&self, verb: &str) -> Result<Survey, RigError> {
        if let Source::Files = self.source()? {
            let plan = self.plan(verb)?;
            let found = if survey::is_for(&plan) { survey::look(&plan)? } else { None };
            if let Some(survey) = found {
                return Ok(survey);
            }
        }
        self.load(verb).map(Survey::from)
    }

    /// What messages that concern the whole rig should lead to.
    ///
    /// # Panics
    /// Where no data are given, which [`load`](Self::load) refuses.
    pub fn place(&self) -> &Path {
        &self.data[0]
    }

    /// Every file that was read.
    pub fn inputs<'a>(&'a self, plan: &'a Plan) -> Vec<&'a Path> {
        let records = plan.records.iter().map(|record| &record.path);
        self.data.iter().chain(records).map(PathBuf::as_path).collect()
    }

    fn source(&self) -> Result<Source<'_>, RigError> {
        let is_rig_file = |path: &&PathBuf| {
            let is_ending =
                |ending: &str| path.extension().is_some_and(|found| found.eq_ignore_ascii_case(ending));
            // A stream's name says nothing.
            let is_rig = || stream::is_stream(path) && FileKind::of(path) == Some(FileKind::Rig);
            is_ending("toml") || is_ending("json") || path.is_dir() || is_rig()
        };
        match (self.data.iter().find(is_rig_file), &self.data[..]) {
            (None, []) => Err(asked(
                "no DATA is given".to_owned(),
                "name files of measurements, one a record, or one rig file",
            )),
            (None, _) => Ok(Source::Files),
            (Some(path), [_]) => Ok(Source::RigFile(path)),
            (Some(path), _) => Err(asked(
                format!("{} cannot be given together with other files", path.display()),
                "give either one rig file, which names its records, or the files of measurements themselves",
            )),
        }
    }

    /// A rig file says for itself what the flags would.
    fn refuse_flags(&self, path: &Path) -> Result<(), RigError> {
        let flags = [
            (self.columns.input.is_some(), "--input", "columns = { input = \"…\" }"),
            (self.columns.output.is_some(), "--output", "columns = { output = \"…\" }"),
            (self.columns.time.is_some(), "--time", "columns = { time = \"…\" }"),
            (self.sample_time.is_some(), "--sample-time", "sample_time = …"),
            (self.rate.is_some(), "--rate", "sample_time = …"),
            (self.holdout.is_some(), "--holdout", "use = \"holdout\"` or `holdout = 0.3"),
            (self.resample.is_some(), "--resample", "resample = \"linear\""),
        ];
        match flags.into_iter().find(|(is_given, ..)| *is_given) {
            None => Ok(()),
            Some((_, flag, key)) => Err(asked(
                format!("{flag} belongs to files of measurements, but {} is a rig file", path.display()),
                &format!("write `{key}` in the rig file"),
            )),
        }
    }

    fn plan(&self, verb: &str) -> Result<Plan, RigError> {
        let sample_time = self.seconds()?;
        let hold = self.hold()?;
        let mut problems = Vec::new();
        for (k, path) in self.data.iter().enumerate() {
            if self.data[..k].iter().any(|other| is_same(other, path)) {
                problems.push(RigProblem::Asked {
                    message: format!("{} is given twice", path.display()),
                    remedy: "give each file once; a hold-out that is also fitted proves nothing".to_owned(),
                });
            }
        }
        let records = self.records(&hold);
        if records.iter().all(|record| record.usage == Usage::Holdout) {
            problems.push(RigProblem::Asked {
                message: "all is held out, so there is nothing to identify from".to_owned(),
                remedy: "give more files, or hold out a share, for instance `--holdout 0.3`".to_owned(),
            });
        }
        if !problems.is_empty() {
            return Err(RigError::new(problems));
        }
        let stem = stream::stem(&self.data[0]);
        Ok(Plan {
            name: stem.filter(|stem| !stem.trim().is_empty()).unwrap_or_else(|| "rig".to_owned()),
            columns: self.columns.clone(),
            sampling: Sampling { sample_time, resample: self.resample },
            order: None,
            interval: None,
            input_label: None,
            output_label: None,
            records,
            input_form: InputForm::CommandLine(self.command(verb)),
        })
    }

    /// The sample time, where it is given in one way or the other.
    fn seconds(&self) -> Result<Option<f64>, RigError> {
        let times = [("--sample-time", self.sample_time), ("--rate", self.rate)];
        let wrong = times.into_iter().find(|(_, time)| time.is_some_and(|time| !is_positive(time)));
        if let Some((option, _)) = wrong {
            return Err(asked(format!("{option} is no positive number"), "give seconds or hertz above zero"));
        }
        if self.sample_time.is_some() && self.rate.is_some() {
            let message = "the argument '--sample-time <SECONDS>' cannot be used with '--rate <HZ>'";
            return Err(asked(message.to_owned(), "give one of them: each shows the other"));
        }
        Ok(self.sample_time.or(self.rate.map(|rate| 1.0 / rate)))
    }

    fn hold(&self) -> Result<Hold, RigError> {
        let Some(holdout) = &self.holdout else {
            return Ok(if self.data.len() == 1 { Hold::Share(HELD_OUT) } else { Hold::Last });
        };
        match holdout.parse::<f64>() {
            Ok(share) if share > 0.0 && share < 1.0 => Ok(Hold::Share(share)),
            Ok(share) => Err(asked(
                format!("--holdout {share} is no share of a record"),
                "give a number between 0 and 1, the share of every record that is held out, or a file",
            )),
            Err(_) => Ok(Hold::File(PathBuf::from(holdout))),
        }
    }

    /// A file that is held out may be among the others or not.
    fn records(&self, hold: &Hold) -> Vec<PlannedRecord> {
        let mut files = self.data.clone();
        if let Hold::File(file) = hold
            && !files.iter().any(|other| is_same(other, file))
        {
            files.push(file.clone());
        }
        let count = files.len();
        let record = |(k, path): (usize, PathBuf)| {
            let is_held = match hold {
                Hold::Share(_) => false,
                Hold::Last => k + 1 == count,
                Hold::File(file) => is_same(file, &path),
            };
            PlannedRecord {
                named: path.display().to_string(),
                path,
                columns: ColumnNames::default(),
                role: Role::Free,
                usage: if is_held { Usage::Holdout } else { Usage::Fit },
                held_out: match hold {
                    Hold::Share(share) => Some(*share),
                    _ => None,
                },
            }
        };
        files.into_iter().enumerate().map(record).collect()
    }

    /// The command line as given, so that a remedy can be typed as it stands.
    fn command(&self, verb: &str) -> String {
        let mut words = vec!["switchback".to_owned(), verb.to_owned()];
        words.extend(self.data.iter().map(|path| path_in_shell(path)));
        let number = |x: Option<f64>| x.map(|x| x.to_string());
        let flags = [
            ("--time", self.columns.time.clone().filter(|name| name == NO_TIME)),
            ("--sample-time", number(self.sample_time)),
            ("--rate", number(self.rate)),
            ("--holdout", self.holdout.clone()),
        ];
        for (flag, value) in flags {
            words.extend(value.into_iter().flat_map(|value| [flag.to_owned(), in_shell(&value)]));
        }
        if let Some(between) = self.resample {
            words.push("--resample".to_owned());
            words.extend((between == Between::Hold).then(|| between.name().to_owned()));
        }
        words.join(" ")
    }
}

enum Source<'a> {
    RigFile(&'a Path),
    Files,
}

enum Hold {
    Share(f64),
    Last,
    File(PathBuf),
}

fn asked(message: String, remedy: &str) -> RigError {
    RigProblem::Asked { message, remedy: remedy.to_owned() }.into()
}

fn is_same(a: &Path, b: &Path) -> bool {
    let parts =
        |path: &Path| -> PathBuf { path.components().filter(|part| *part != Component::CurDir).collect() };
    parts(a) == parts(b)
}
