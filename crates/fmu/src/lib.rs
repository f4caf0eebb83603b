//! The library inside an exported FMU: the functions of FMI 2.0 for co-simulation around a model that it reads from its resources.
//!
//! Functional Mock-up Interface 2.0.4, <https://fmi-standard.org>. One library serves every model: `export` puts it into the archive beside
//! `resources/model.json`, a [`Package`]. The fmi2 functions are in `exports`, what they do in [`Instance`], which knows no pointers.
//!
//! A step takes the input that was set before it, and holds it. Where an output does not depend on the input of its own sample, the output
//! after the step from `t` to `t + h` is that of the time `t + h`. Where it does, the input of that time is still to come, and the output is
//! that of `t`: [`Package::output_delay`] is 1.

pub mod fmi2;

mod description;
mod exports;
mod instance;
mod location;
mod package;

pub use description::{Constant, Description, model_description};
pub use instance::{Instance, Refusal};
pub use location::path_of;
pub use package::{Package, PackageError, SCHEMA, references};
