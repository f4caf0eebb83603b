//! What the file says, as faithfully as TOML types allow; nothing is judged here.

use serde::Deserialize;
use switchback_io::input::TwoNumbers;
use toml::Spanned;

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct WireScenario {
    pub(super) question: String,
    pub(super) seed: u64,
    pub(super) replicates: Spanned<usize>,
    pub(super) max_replicates: Option<Spanned<usize>>,
    pub(super) precision: Option<Spanned<WirePrecision>>,
    pub(super) coupling: Option<Spanned<String>>,
    pub(super) engine: Option<Spanned<String>>,
    pub(super) system: Spanned<WireSystem>,
    #[serde(default)]
    pub(super) case: Vec<WireCase>,
    #[serde(default)]
    pub(super) method: Vec<WireMethod>,
    pub(super) sweep: WireSweep,
    #[serde(default)]
    pub(super) expect: WireExpect,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct WirePrecision {
    pub(super) bias_mcse: Option<Spanned<f64>>,
    pub(super) sd_relative_mcse: Option<Spanned<f64>>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct WireSystem {
    pub(super) a: Spanned<Vec<f64>>,
    pub(super) b: Spanned<Vec<f64>>,
    pub(super) interval: Spanned<TwoNumbers>,
    pub(super) input: Option<String>,
    pub(super) output: Option<String>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct WireCase {
    pub(super) name: Spanned<String>,
    pub(super) system: Option<Spanned<WireSystemOverride>>,
    pub(super) disturbance: Option<Spanned<WireDisturbance>>,
    pub(super) order: Option<Spanned<usize>>,
    pub(super) spacing: Option<Spanned<usize>>,
    pub(super) knots: Option<Spanned<String>>,
    pub(super) fit: Option<Spanned<String>>,
    pub(super) expect: Option<WireExpect>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct WireSystemOverride {
    pub(super) a: Option<Spanned<Vec<f64>>>,
    pub(super) b: Option<Spanned<Vec<f64>>>,
    pub(super) interval: Option<Spanned<TwoNumbers>>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct WireDisturbance {
    pub(super) kind: Spanned<String>,
    pub(super) ar: Option<Spanned<Vec<f64>>>,
    pub(super) ma: Option<Spanned<Vec<f64>>>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct WireMethod {
    pub(super) name: Spanned<String>,
    pub(super) command: Spanned<Vec<Spanned<String>>>,
    pub(super) parameters: Option<Spanned<Vec<Spanned<String>>>>,
    pub(super) patience: Option<Spanned<f64>>,
    pub(super) antithetic: Option<bool>,
    pub(super) workers: Option<Spanned<usize>>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct WireSweep {
    pub(super) noise: Spanned<Vec<Spanned<f64>>>,
    pub(super) samples: Spanned<Vec<Spanned<usize>>>,
    pub(super) points: Spanned<Vec<Spanned<usize>>>,
    pub(super) borders: Option<Spanned<Vec<Spanned<String>>>>,
    pub(super) methods: Spanned<Vec<Spanned<String>>>,
    pub(super) slope_from: Option<Spanned<usize>>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct WireExpect {
    #[serde(default)]
    pub(super) consistent: Vec<Spanned<String>>,
    #[serde(default)]
    pub(super) inconsistent: Vec<Spanned<String>>,
    #[serde(default)]
    pub(super) within_error: Vec<Spanned<String>>,
    pub(super) coverage: Option<Spanned<WireCoverage>>,
    pub(super) width: Option<Spanned<WireWidth>>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct WireCoverage {
    pub(super) mean: TwoNumbers,
    pub(super) least: f64,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct WireWidth {
    pub(super) of: Spanned<String>,
    pub(super) at_most: f64,
}
