//! The design of experiments: which inputs to play, and how long to measure for a wanted precision.
//!
//! A [`Plan`] is a dataset in physical time; its files are [`artefacts`]. Where a rig was measured already, a [`Truth`] identified from it
//! lets a [`Forecast`] predict the standard errors of any such dataset.

mod artefacts;
mod draft;
mod error;
mod forecast;
mod json;
mod options;
mod plan;
mod truth;
mod words;

pub use artefacts::artefacts;
pub use draft::Draft;
pub use error::DesignError;
pub use forecast::Forecast;
pub use forecast::PlanMethod;
pub(crate) use forecast::Prediction;
pub(crate) use forecast::RELIABLE_PERIODS;
pub use json::json;
pub use json::schema;
pub use options::Options;
pub use plan::DEFAULT_PERIODS;
pub use plan::Length;
pub use plan::Plan;
pub use plan::Request;
pub use truth::Truth;
pub use words::words;

/// What a run of `switchback design` has to show.
#[derive(Debug)]
pub struct Report {
    /// The plan.
    pub plan: Plan,
    /// What is predicted of it; none where nothing is known of the system.
    pub outlook: Option<Outlook>,
    /// The folder that it was written to.
    pub folder: Option<String>,
}

/// A forecast with the question it answers.
#[derive(Debug)]
pub struct Outlook {
    /// What the forecast was made from.
    pub truth: Truth,
    /// The forecast.
    pub forecast: Forecast,
    /// The wanted standard error of the worst border point, as a share of `u_M − u_m`.
    pub wanted: Option<f64>,
}
