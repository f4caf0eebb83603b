//! What a rig file may say, as it stands on the page. Checked and converted in [`super::read`].

use serde::{Deserialize, Serialize};
use switchback_model::rig::{Role, Usage};
use toml::Spanned;

/// The keys of a rig, and those of a record.
pub(super) const KEYS: [&str; 13] = [
    "name",
    "sample_time",
    "order",
    "interval",
    "input",
    "output",
    "columns",
    "resample",
    "record",
    "file",
    "role",
    "use",
    "holdout",
];

/// Every key may be missing here, so that all missing ones can be reported at once.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct WireRig {
    pub(super) name: Option<Spanned<String>>,
    pub(super) sample_time: Option<Spanned<f64>>,
    pub(super) order: Option<Spanned<i64>>,
    pub(super) interval: Option<Spanned<Vec<f64>>>,
    pub(super) input: Option<String>,
    pub(super) output: Option<String>,
    #[serde(default)]
    pub(super) columns: WireColumns,
    #[serde(default)]
    pub(super) resample: Option<Spanned<WireResample>>,
    #[serde(default)]
    pub(super) record: Vec<Spanned<WireRecord>>,
}

/// `true` stands for `"linear"`.
#[derive(Debug, Deserialize)]
#[serde(untagged)]
pub(super) enum WireResample {
    Switch(bool),
    Named(String),
}

#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct WireColumns {
    pub(super) time: Option<String>,
    pub(super) input: Option<String>,
    pub(super) output: Option<String>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct WireRecord {
    pub(super) file: Option<Spanned<String>>,
    #[serde(default)]
    pub(super) role: WireRole,
    #[serde(rename = "use")]
    pub(super) usage: Option<WireUse>,
    pub(super) holdout: Option<Spanned<f64>>,
    #[serde(default)]
    pub(super) columns: WireColumns,
}

#[derive(Debug, Clone, Copy, Default, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum WireRole {
    StepHigh,
    StepLow,
    Descendant,
    Ascendant,
    #[default]
    Free,
}

#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum WireUse {
    Fit,
    Holdout,
}

/// The same page as [`WireRig`], for writing: keys in reading order, what is unknown left out.
#[derive(Debug, Serialize)]
pub(super) struct WrittenRig<'a> {
    pub(super) name: &'a str,
    pub(super) sample_time: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) order: Option<usize>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) interval: Option<[f64; 2]>,
    pub(super) input: &'a str,
    pub(super) output: &'a str,
    pub(super) record: Vec<WrittenRecord>,
}

#[derive(Debug, Serialize)]
pub(super) struct WrittenRecord {
    pub(super) file: String,
    pub(super) role: &'static str,
    #[serde(rename = "use")]
    pub(super) usage: &'static str,
}

impl From<WireRole> for Role {
    fn from(wire: WireRole) -> Self {
        match wire {
            WireRole::StepHigh => Self::StepHigh,
            WireRole::StepLow => Self::StepLow,
            WireRole::Descendant => Self::Descendant,
            WireRole::Ascendant => Self::Ascendant,
            WireRole::Free => Self::Free,
        }
    }
}

impl From<WireUse> for Usage {
    fn from(wire: WireUse) -> Self {
        match wire {
            WireUse::Fit => Self::Fit,
            WireUse::Holdout => Self::Holdout,
        }
    }
}
