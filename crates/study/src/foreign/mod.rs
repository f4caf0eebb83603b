//! Estimators of others: what they are asked, what they answer, and the processes that do.
//!
//! | file | purpose |
//! |---|---|
//! | `design` | what is known of the records of a cell, without the truth |
//! | `estimator` | whoever estimates: a process, or a function of whoever runs the study |
//! | `protocol` | requests and answers as lines of JSON |
//! | `conversation` | one process, and what it answers |
//! | `processes` | all processes of a method |

mod conversation;
mod design;
mod estimator;
mod processes;
mod protocol;

pub use design::{Design, DesignExperiment};
pub use estimator::{Estimates, ForeignError, ForeignEstimator, Records, checked};
pub use processes::Processes;
pub use protocol::{Answer, Greeting, PROTOCOL, Request, RequestExperiment, Stored, schemas};
