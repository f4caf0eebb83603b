//! `switchback._native`: the functions behind the Python package.
//!
//! The libraries of the workspace compute; threads, signals and the conversion between the languages stand here.
//!
//! | file | what it is for |
//! |---|---|
//! | `call` | one call from Python: a thread that computes, signals that stop it, what is reported meanwhile |
//! | `records` | a rig in memory, however it was read |
//! | `answer` | what a verb found: JSON, words, files |
//! | `verbs` | the verbs |
//! | `estimator` | the fit behind `SwitchedHysteresis` |
//! | `method` | a function in Python as the estimator of a study |
//! | `numbers`, `options`, `refusal` | arrays, arguments and exceptions |

mod answer;
mod call;
mod estimator;
mod method;
mod numbers;
mod options;
mod records;
mod refusal;
mod verbs;

use pyo3::prelude::*;

/// The native part of the package `switchback`.
#[pymodule]
fn _native(module: &Bound<'_, PyModule>) -> PyResult<()> {
    switchback_io::platform::keep_memory();
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add("SwitchbackError", module.py().get_type::<refusal::SwitchbackError>())?;
    module.add_class::<answer::Answer>()?;
    module.add_class::<records::Records>()?;
    module.add_function(wrap_pyfunction!(verbs::identify::identify, module)?)?;
    module.add_function(wrap_pyfunction!(verbs::diagnose::diagnose, module)?)?;
    module.add_function(wrap_pyfunction!(verbs::power::power, module)?)?;
    module.add_function(wrap_pyfunction!(verbs::plant::plant, module)?)?;
    module.add_function(wrap_pyfunction!(verbs::design::design, module)?)?;
    module.add_function(wrap_pyfunction!(verbs::simulate::simulate, module)?)?;
    module.add_function(wrap_pyfunction!(verbs::simulate::simulate_file, module)?)?;
    module.add_function(wrap_pyfunction!(verbs::export::export, module)?)?;
    module.add_function(wrap_pyfunction!(verbs::study::study, module)?)?;
    module.add_function(wrap_pyfunction!(verbs::study::study_of_json, module)?)?;
    module.add_function(wrap_pyfunction!(estimator::fit, module)?)?;
    Ok(())
}
