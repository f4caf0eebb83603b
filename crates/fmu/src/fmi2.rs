//! The types of FMI 2.0, for those who implement its functions and those who call them.

use std::ffi::{c_char, c_int, c_uint, c_void};

/// How a call ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
#[repr(C)]
pub enum Status {
    /// As it should.
    Ok,
    /// With a doubt.
    Warning,
    /// Not at all, nothing is lost.
    Discard,
    /// It failed; the instance may be freed or reset.
    Error,
    /// It failed for all instances.
    Fatal,
    /// It is not done yet.
    Pending,
}

/// An instance, as a caller sees it.
pub type Component = *mut c_void;
/// A number of a variable.
pub type ValueReference = c_uint;
/// False is 0.
pub type Boolean = c_int;

/// Shows the caller's user what happened; `printf` with its arguments.
pub type Logger = unsafe extern "C" fn(*mut c_void, *const c_char, c_int, *const c_char, *const c_char, ...);

/// What the caller lends.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub struct Callbacks {
    /// Takes messages.
    pub logger: Option<Logger>,
    /// Gives memory.
    pub allocate: Option<unsafe extern "C" fn(usize, usize) -> *mut c_void>,
    /// Takes it back.
    pub free: Option<unsafe extern "C" fn(*mut c_void)>,
    /// Hears that an asynchronous step ended.
    pub step_finished: Option<unsafe extern "C" fn(*mut c_void, c_int)>,
    /// Handed to all of these.
    pub environment: *mut c_void,
}

/// `fmi2Type`: co-simulation.
pub const CO_SIMULATION: c_int = 1;

/// `fmi2Instantiate`.
pub type Instantiate = unsafe extern "C" fn(
    *const c_char,
    c_int,
    *const c_char,
    *const c_char,
    *const Callbacks,
    Boolean,
    Boolean,
) -> Component;
/// `fmi2FreeInstance`.
pub type FreeInstance = unsafe extern "C" fn(Component);
/// `fmi2SetupExperiment`.
pub type SetupExperiment = unsafe extern "C" fn(Component, Boolean, f64, f64, Boolean, f64) -> Status;
/// Functions of an instance alone: `fmi2EnterInitializationMode`, `fmi2ExitInitializationMode`, `fmi2Terminate`, `fmi2Reset`.
pub type OfInstance = unsafe extern "C" fn(Component) -> Status;
/// `fmi2SetReal`.
pub type SetReal = unsafe extern "C" fn(Component, *const ValueReference, usize, *const f64) -> Status;
/// `fmi2GetReal`.
pub type GetReal = unsafe extern "C" fn(Component, *const ValueReference, usize, *mut f64) -> Status;
/// `fmi2GetInteger`.
pub type GetInteger = unsafe extern "C" fn(Component, *const ValueReference, usize, *mut c_int) -> Status;
/// `fmi2DoStep`.
pub type DoStep = unsafe extern "C" fn(Component, f64, f64, Boolean) -> Status;
