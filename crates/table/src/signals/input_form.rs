//! Remedies in the terms of whoever gave the plan.

use crate::shell::in_shell;

/// How the plan was given.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum InputForm {
    /// By a rig file.
    Manifest,
    /// On the command line, which so far reads as this.
    CommandLine(String),
    /// By the arguments of a function.
    Arguments,
    /// As the input of a model, which has a sample time of its own, on the command line that so far reads as this.
    Simulation(String),
}

impl InputForm {
    /// What to write to name columns.
    pub fn naming(&self, wanted: &[(&str, String)]) -> String {
        match self {
            Self::Manifest => {
                let keys: Vec<_> = wanted.iter().map(|(key, name)| format!("{key} = {name:?}")).collect();
                format!("name them in the rig file: `columns = {{ {} }}`", keys.join(", "))
            }
            Self::Arguments => {
                let named: Vec<_> = wanted.iter().map(|(key, name)| format!("{key}={name:?}")).collect();
                format!("name them, for instance: `{}`", named.join(", "))
            }
            Self::CommandLine(command) | Self::Simulation(command) => {
                let flags: Vec<_> =
                    wanted.iter().map(|(key, name)| format!("--{key} {}", in_shell(name))).collect();
                format!("name them, for instance: `{command} {}`", flags.join(" "))
            }
        }
    }

    /// How to take another column than the one guessed.
    pub fn other_column(&self) -> &'static str {
        match self {
            Self::Manifest => "`columns = { input = …, output = … }`",
            Self::Arguments => "`input=NAME` or `output=NAME`",
            Self::CommandLine(_) | Self::Simulation(_) => "`--input NAME` or `--output NAME`",
        }
    }

    /// How to leave the time column aside.
    pub fn without_time(&self) -> &'static str {
        match self {
            Self::Manifest => "`columns = { time = \"none\" }` with `sample_time = SECONDS`",
            Self::CommandLine(_) => "`--time none --rate HZ`",
            Self::Arguments => "`time=\"none\", sample_time=SECONDS`",
            Self::Simulation(_) => "`--time none`, which makes every row a sample of the model's sample time",
        }
    }

    /// What to do about an interrupted record that must be whole.
    pub fn whole(&self) -> String {
        match self {
            Self::Simulation(_) => {
                "an input to be played must be whole: fill in what is missing, add `--resample` to interpolate gaps of up to ten samples, or play its pieces as files of their own".to_owned()
            }
            _ => "a designed experiment must be whole: take it again, or write `role = \"free\"`, which splits the record here".to_owned(),
        }
    }

    /// What to do about uneven steps.
    pub fn uneven(&self) -> String {
        let interpolate = match self {
            Self::Manifest => "write `resample = true` to interpolate linearly to the mean step",
            Self::CommandLine(_) => "add `--resample` to interpolate linearly to the mean step",
            Self::Arguments => "give `resample=True` to interpolate linearly to the mean step",
            Self::Simulation(_) => "add `--resample` to interpolate linearly to the model's sample time",
        };
        format!("{interpolate}, or take {} if the stamps, not the samples, are uneven", self.without_time())
    }

    /// What to do about time that stands still or runs back.
    pub fn not_increasing(&self) -> String {
        format!(
            "sort the rows by time and remove repeated ones; give runs that start anew files of their own; where stamps are too coarse to \
             distinguish the rows, use {}",
            self.without_time()
        )
    }

    /// How to take a column for the clock.
    pub fn with_time(&self, name: &str) -> String {
        match self {
            Self::Manifest => format!("`columns = {{ time = {name:?} }}`"),
            Self::Arguments => format!("`time={name:?}`"),
            Self::CommandLine(_) | Self::Simulation(_) => format!("`--time {}`", in_shell(name)),
        }
    }

    /// What to do about a sample time that the stamps contradict.
    pub fn other_sample_time(&self, step: f64) -> String {
        match self {
            Self::Manifest => {
                format!("write `sample_time = {step}`, or leave it out: the time column shows it")
            }
            Self::CommandLine(_) => format!(
                "give `--rate {}`, or leave it out: the time column shows it; {} goes without that column",
                short(1.0 / step),
                self.without_time()
            ),
            Self::Arguments => {
                format!("give `sample_time={step}`, or leave it out: the time column shows it")
            }
            Self::Simulation(_) => {
                "sample the input as the model was, or add `--resample` to interpolate it linearly".to_owned()
            }
        }
    }

    /// What to do about files that were not sampled alike.
    pub fn sample_times_differ(&self, first: f64) -> String {
        match self {
            Self::Manifest => format!(
                "interpolate all of them to one: `resample = true` with `sample_time = {first}`; or diagnose them one by one"
            ),
            Self::Arguments => format!(
                "interpolate all of them to one: `resample=True, sample_time={first}`; or diagnose them one by one"
            ),
            Self::CommandLine(_) | Self::Simulation(_) => format!(
                "interpolate all of them to one: `--resample --rate {}`; or diagnose them one by one",
                short(1.0 / first)
            ),
        }
    }

    /// What to do about a record that falls to pieces.
    pub fn shattered(&self) -> String {
        match self {
            Self::Manifest => "check the time column, or write `resample = true` to interpolate".to_owned(),
            Self::Arguments => "check the time column, or give `resample=True` to interpolate".to_owned(),
            Self::CommandLine(_) | Self::Simulation(_) => {
                "check the time column, or add `--resample` to interpolate".to_owned()
            }
        }
    }

    /// What to do about a record that is too short to be cut.
    pub fn cut_too_short(&self) -> String {
        match self {
            Self::Manifest => {
                "take a longer record, or hold out another file by `use = \"holdout\"`".to_owned()
            }
            Self::Arguments => "take a longer record, or hold out another one (`holdout=NAME`)".to_owned(),
            Self::CommandLine(_) | Self::Simulation(_) => {
                "take a longer record, or hold out another file (`--holdout FILE`)".to_owned()
            }
        }
    }

    /// What to do where neither the user nor a column shows the sample time.
    pub fn sample_time_wanted(&self) -> String {
        match self {
            Self::Manifest => {
                "write `sample_time = SECONDS`, or name the time column in `columns`".to_owned()
            }
            Self::Simulation(_) => format!("take {}", self.without_time()),
            Self::Arguments => {
                "give it in seconds, `sample_time=0.01`, or name the time column, `time=NAME`".to_owned()
            }
            Self::CommandLine(command) => format!(
                "give it in seconds, `{command} --sample-time 0.01`, or as a rate in hertz, `{command} --rate 100`"
            ),
        }
    }

    /// How to hold out something else.
    pub fn other_holdout(&self) -> &'static str {
        match self {
            Self::Arguments => "`holdout=0.3` or `holdout=NAME`",
            _ => "`--holdout 0.3` or `--holdout FILE`",
        }
    }

    /// What to do about a time column that cannot be read as times.
    pub fn no_times(&self) -> String {
        format!("write times in ISO 8601, as 2024-03-05T12:00:00.01, or take {}", self.without_time())
    }
}

/// Four digits of a rate.
fn short(rate: f64) -> f64 {
    format!("{rate:.3e}").parse().unwrap_or(rate)
}
