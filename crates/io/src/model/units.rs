//! A model runs on quantities in its own units only.

use super::Header;
use crate::identification::unit;
use miette::Diagnostic;
use std::path::Path;
use thiserror::Error;

/// A signal is in another unit than the model's.
#[derive(Debug, Error, Diagnostic)]
#[error("{message}")]
#[diagnostic(help("{remedy}"))]
pub struct UnitError {
    message: String,
    remedy: String,
}

/// Relative difference of two sample times that are the same.
const SAME_TIME: f64 = 1e-6;

impl Header {
    /// Whether the model runs on records sampled so, seconds between samples.
    pub fn runs_at(&self, sample_time: f64) -> bool {
        (self.sample_time - sample_time).abs() <= SAME_TIME * sample_time
    }

    /// Compares units where both are known. `labels` are those of the input and of the output, empty where there is none; `what` is what
    /// `file` is called.
    ///
    /// # Errors
    /// [`UnitError`] if one differs.
    pub fn check_units(
        &self,
        labels: [&str; 2],
        (file, what): (&Path, &'static str),
    ) -> Result<(), UnitError> {
        for (own, label) in [&self.input, &self.output].into_iter().zip(labels) {
            let (model, data) = (unit(own), unit(label));
            if !model.is_empty() && !data.is_empty() && !same_unit(model, data) {
                let name = own.split_once('[').map_or(own.as_str(), |(name, _)| name.trim());
                let file = file.display();
                return Err(UnitError {
                    message: format!(
                        "{file}: the model was identified on {name} in {model}, this {what} has {data}"
                    ),
                    remedy: format!(
                        "bring `{label}` to {model}, or correct the header if only that is wrong"
                    ),
                });
            }
        }
        Ok(())
    }
}

/// Whether two units are the same, however their letters are typed.
pub fn same_unit(one: &str, other: &str) -> bool {
    plain(one) == plain(other)
}

/// A unit however its letters are typed: `µm` and `um`, `N·m` and `Nm`.
fn plain(unit: &str) -> String {
    unit.replace(['µ', 'μ'], "u").replace(['·', '*', ' '], "").replace('°', "deg")
}
