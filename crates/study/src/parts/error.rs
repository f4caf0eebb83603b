//! Why folders make no whole.

use crate::Shard;
use crate::consistency::Unusable;
use miette::Diagnostic;
use switchback_io::input::FileError;
use thiserror::Error;

/// Why folders make no whole.
#[derive(Debug, Error, Diagnostic)]
#[non_exhaustive]
pub enum MergeError {
    /// A file cannot be read.
    #[error(transparent)]
    #[diagnostic(transparent)]
    File(#[from] FileError),
    /// The folder holds something else.
    #[error("{folder}: holds no part of a study or an examination")]
    #[diagnostic(help(
        "give folders that `switchback SCENARIO.toml --shard K/N --out DIR` has written to its end"
    ))]
    NoPart {
        /// The folder.
        folder: String,
    },
    /// A file of a part is not as it was written.
    #[error("{folder}: {file} is not what was judged there")]
    #[diagnostic(help("run this part again"))]
    Changed {
        /// The folder.
        folder: String,
        /// The file that was changed.
        file: &'static str,
    },
    /// The label was made of other files, or changed since.
    #[error("{folder}: part.json is not of the files beside it")]
    #[diagnostic(help("run this part again"))]
    Unsealed {
        /// The folder.
        folder: String,
    },
    /// Two parts belong to different wholes.
    #[error("{folder}: {what} differs from that of {first}")]
    #[diagnostic(help(
        "merge parts of one scenario, run by one version of the program with one number of parts"
    ))]
    Strange {
        /// The folder.
        folder: String,
        /// What differs.
        what: &'static str,
        /// The folder that it was compared with.
        first: String,
    },
    /// A part is given twice.
    #[error("{folder} and {first} are the same part, {shard}")]
    #[diagnostic(help("give every part once"))]
    Twice {
        /// One folder.
        folder: String,
        /// The other.
        first: String,
        /// Which part.
        shard: Shard,
    },
    /// What the replicates left behind cannot be read.
    #[error("{folder}: {file} {why}", file = crate::checkpoint::CHECKPOINT_FILE)]
    #[diagnostic(help(
        "merge parts of one scenario and one round, with the version of the program and on the platform that ran them; or run this part again"
    ))]
    Unusable {
        /// The folder.
        folder: String,
        /// What is wrong.
        why: Unusable,
    },
    /// One part was given where all of a round are wanted.
    #[error(
        "{folder}: is part {shard} alone, and not what `switchback merge` writes of all parts of a round"
    )]
    #[diagnostic(help("merge the parts of the round first"))]
    OnePart {
        /// The folder.
        folder: String,
        /// Which part.
        shard: Shard,
    },
    /// Two folders hold the rounds before.
    #[error("{folder} and {first} both hold the rounds before")]
    #[diagnostic(help("give one of them, and the parts that were run from it"))]
    TwoWholes {
        /// One folder.
        folder: String,
        /// The other.
        first: String,
    },
    /// Replicates are missing, or there twice.
    #[error("replicates {start} to {end} are missing, or there twice")]
    #[diagnostic(help("merge all parts of one round, with what was merged of the rounds before"))]
    Gap {
        /// Where the next should begin.
        start: usize,
        /// Where it does.
        end: usize,
    },
    /// Parts are missing.
    #[error("of {scenario} these parts are missing: {missing}")]
    #[diagnostic(help(
        "run them: switchback {scenario} --shard {first} --out DIR; as a job array: --array={array}"
    ))]
    Missing {
        /// The scenario's file name.
        scenario: String,
        /// The parts.
        missing: String,
        /// The first of them.
        first: Shard,
        /// Their numbers, as a scheduler takes them.
        array: String,
    },
}

impl MergeError {
    /// Parts of these numbers, of so many, are missing; none if there are no such numbers.
    pub(super) fn missing(scenario: &str, missing: &[usize], of: usize) -> Option<Self> {
        let &first = missing.first()?;
        let runs = missing.chunk_by(|one, next| one + 1 == *next);
        let array = runs.map(|run| match run {
            [only] => only.to_string(),
            run => format!("{}-{}", run[0], run[run.len() - 1]),
        });
        let all = missing.iter().map(|&number| Shard { number, of }.to_string());
        Some(Self::Missing {
            scenario: scenario.to_owned(),
            missing: all.collect::<Vec<_>>().join(", "),
            first: Shard { number: first, of },
            array: array.collect::<Vec<_>>().join(","),
        })
    }
}
