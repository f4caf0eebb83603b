//! The two designs of an examination: what differs between them.

use serde::{Deserialize, Serialize};

/// Where the rigs of an examination stand.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Design {
    /// Rigs with designed records, drawn and diagnosed blind: `study = "blind"`.
    Laboratory,
    /// Undesigned records of measured and made machines, with faults put in: `study = "field"`.
    Field,
}

/// What a rig is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
pub enum Kind {
    /// It has one effect of the library.
    #[serde(rename = "Planted")]
    Injected,
    /// It has an effect that no library knows, or one that is taken out of the library for this rig.
    Outside,
    /// It has no effect; in the field a base as it is.
    Bare,
    /// It has two effects.
    Pair,
    /// A measured base's model with its residuals resampled.
    Resampled,
}

/// From this size on a fault in the field must be named.
pub(crate) const LARGE: f64 = 2.0;

impl Design {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Laboratory, Self::Field];

    /// What a scenario calls it.
    pub const fn study(self) -> &'static str {
        match self {
            Self::Laboratory => "blind",
            Self::Field => "field",
        }
    }

    /// What a message calls it.
    pub const fn article_and_name(self) -> &'static str {
        match self {
            Self::Laboratory => "a blind study",
            Self::Field => "a field examination",
        }
    }

    /// Name and version of the layout of results.json.
    pub const fn schema(self) -> &'static str {
        match self {
            Self::Laboratory => "switchback/blind/1",
            Self::Field => "switchback/field/1",
        }
    }

    /// The files of a report.
    pub const fn files(self) -> &'static [&'static str] {
        match self {
            Self::Laboratory => &[
                "key.jsonl",
                "provenance.json",
                "results.json",
                "index.html",
                "summary.txt",
                "answers.csv",
                "confusion.*",
                "accuracy.*",
                "calibration.*",
                "abstention.*",
                "closure.*",
                "baselines.*",
                "where.csv",
            ],
            Self::Field => &[
                "key.jsonl",
                "provenance.json",
                "results.json",
                "index.html",
                "summary.md",
                "answers.csv",
                "cases.jsonl",
                "by-*.csv",
                "confusion.*",
                "calibration.*",
            ],
        }
    }

    /// Seconds of one thread that a rig takes, made and judged, in the mean.
    ///
    /// In the laboratory 5,600 rigs take two to ten hours on two threads; the mean is nearer to their lower end. In the field each is
    /// diagnosed twice: 397 processor seconds for 13 rigs, bases as they are among them.
    pub const fn seconds(self) -> f64 {
        match self {
            Self::Laboratory => 5.0,
            Self::Field => 30.0,
        }
    }

    /// From this size on causes must be named.
    pub(crate) const fn large(self) -> f64 {
        match self {
            Self::Laboratory => 1.0,
            Self::Field => LARGE,
        }
    }

    /// What its rigs are for.
    pub(crate) const fn kinds(self) -> [Kind; 4] {
        match self {
            Self::Laboratory => [Kind::Injected, Kind::Bare, Kind::Outside, Kind::Pair],
            Self::Field => [Kind::Injected, Kind::Outside, Kind::Bare, Kind::Resampled],
        }
    }

    /// What tables call a kind of rig.
    pub(crate) const fn name(self, kind: Kind) -> &'static str {
        match (self, kind) {
            (Self::Laboratory, Kind::Injected) => "single",
            (Self::Laboratory, Kind::Bare) => "none",
            (Self::Field, Kind::Injected) => "planted",
            (Self::Field, Kind::Bare) => "bare",
            (_, Kind::Outside) => "outside",
            (_, Kind::Pair) => "pair",
            (_, Kind::Resampled) => "resampled",
        }
    }
}
