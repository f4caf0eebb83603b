//! The functions of FMI 2.0.
//!
//! Every pointer is the caller's: the standard says what it points to, and that an instance is used by one thread at a time.

#![allow(non_snake_case, clippy::missing_safety_doc, clippy::not_unsafe_ptr_arg_deref)]

use crate::fmi2::{Boolean, CO_SIMULATION, Callbacks, Component, Status, ValueReference};
use crate::instance::{Instance, Refusal};
use crate::location::path_of;
use crate::package::Package;
use std::ffi::{CStr, CString, c_char, c_int, c_void};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;

/// An instance with its caller.
struct Living {
    instance: Instance,
    name: CString,
    callbacks: Callbacks,
    shows_all: bool,
}

impl Living {
    fn describe(&self, status: Status, message: &str) {
        describe(&self.callbacks, &self.name, (status, message));
    }
}

fn describe(callbacks: &Callbacks, name: &CStr, (status, message): (Status, &str)) {
    let Some(logger) = callbacks.logger else { return };
    // The message is a format, and some callers print it as it is.
    let message = CString::new(message.replace('%', "%%").replace('\0', " ")).unwrap_or_default();
    let category = if status >= Status::Error { c"logStatusError" } else { c"logAll" };
    // SAFETY: the caller gave a function of this type; the words live until it returns, and a `%` is followed by another.
    unsafe {
        logger(callbacks.environment, name.as_ptr(), status as c_int, category.as_ptr(), message.as_ptr())
    }
}

/// The text at a pointer; empty for none.
fn text(pointer: *const c_char) -> String {
    if pointer.is_null() {
        return String::new();
    }
    // SAFETY: a caller's string ends with a zero.
    unsafe { CStr::from_ptr(pointer) }.to_string_lossy().into_owned()
}

/// Does something to an instance; an error is reported, and no panic leaves the library.
fn on(component: Component, act: impl FnOnce(&mut Living) -> Result<(), Refusal>) -> Status {
    // SAFETY: the caller hands back what `fmi2Instantiate` gave it and has not freed.
    let Some(living) = (unsafe { component.cast::<Living>().as_mut() }) else { return Status::Error };
    match catch_unwind(AssertUnwindSafe(|| act(living))) {
        Ok(Ok(())) => Status::Ok,
        Ok(Err(refusal)) => {
            living.describe(Status::Error, &refusal.to_string());
            Status::Error
        }
        Err(_) => Status::Fatal,
    }
}

/// So many values of a caller.
fn given<'a, T>(pointer: *const T, count: usize) -> &'a [T] {
    if count == 0 || pointer.is_null() {
        return &[];
    }
    // SAFETY: the caller says how many there are.
    unsafe { std::slice::from_raw_parts(pointer, count) }
}

/// Reads variables into the caller's room for them.
fn read<T>(
    (component, references, count): (Component, *const ValueReference, usize),
    values: *mut T,
    one: impl Fn(&Instance, ValueReference) -> Result<T, Refusal>,
) -> Status {
    on(component, |living| {
        for (k, reference) in given(references, count).iter().enumerate() {
            let value = one(&living.instance, *reference)?;
            // SAFETY: the caller has room for as many values as it names variables.
            unsafe { values.add(k).write(value) }
        }
        Ok(())
    })
}

#[unsafe(no_mangle)]
extern "C" fn fmi2GetTypesPlatform() -> *const c_char {
    c"default".as_ptr()
}

#[unsafe(no_mangle)]
extern "C" fn fmi2GetVersion() -> *const c_char {
    c"2.0".as_ptr()
}

#[unsafe(no_mangle)]
extern "C" fn fmi2SetDebugLogging(
    component: Component,
    logging: Boolean,
    _count: usize,
    _categories: *const *const c_char,
) -> Status {
    on(component, |living| {
        living.shows_all = logging != 0;
        Ok(())
    })
}

#[unsafe(no_mangle)]
extern "C" fn fmi2Instantiate(
    name: *const c_char,
    kind: c_int,
    guid: *const c_char,
    resources: *const c_char,
    callbacks: *const Callbacks,
    _visible: Boolean,
    logging: Boolean,
) -> Component {
    // SAFETY: the caller's functions, or none.
    let Some(callbacks) = (unsafe { callbacks.as_ref() }).copied() else { return std::ptr::null_mut() };
    let (name, guid, resources) = (text(name), text(guid), text(resources));
    let name = CString::new(name).unwrap_or_default();
    let made = catch_unwind(|| instantiated(kind, &guid, &resources));
    match made.unwrap_or_else(|_| Err("the library failed".to_owned())) {
        Ok(instance) => {
            let living = Living { instance, name, callbacks, shows_all: logging != 0 };
            if living.shows_all {
                living.describe(Status::Ok, "instantiated");
            }
            Box::into_raw(Box::new(living)).cast()
        }
        Err(why) => {
            describe(&callbacks, &name, (Status::Error, &why));
            std::ptr::null_mut()
        }
    }
}

fn instantiated(kind: c_int, guid: &str, resources: &str) -> Result<Instance, String> {
    if kind != CO_SIMULATION {
        return Err("this FMU is for co-simulation only".to_owned());
    }
    let folder =
        path_of(resources).ok_or_else(|| format!("the resources are at `{resources}`, which is no file"))?;
    let file = folder.join("model.json");
    let text = std::fs::read_to_string(&file).map_err(|error| format!("{}: {error}", file.display()))?;
    let package = Package::from_json(&text).map_err(|error| error.to_string())?;
    if package.guid != guid {
        return Err(format!(
            "the guid is `{guid}`, but that of resources/model.json is `{}`: files of two exports are mixed",
            package.guid
        ));
    }
    Instance::new(Arc::new(package)).map_err(|fault| format!("resources/model.json: {fault}"))
}

#[unsafe(no_mangle)]
extern "C" fn fmi2FreeInstance(component: Component) {
    if !component.is_null() {
        // SAFETY: the caller hands back what `fmi2Instantiate` gave it, once.
        drop(unsafe { Box::from_raw(component.cast::<Living>()) });
    }
}

#[unsafe(no_mangle)]
extern "C" fn fmi2SetupExperiment(
    component: Component,
    _has_tolerance: Boolean,
    _tolerance: f64,
    begins: f64,
    _has_end: Boolean,
    _end: f64,
) -> Status {
    on(component, |living| living.instance.set_up(begins))
}

#[unsafe(no_mangle)]
extern "C" fn fmi2EnterInitializationMode(component: Component) -> Status {
    on(component, |living| living.instance.enter_initialization())
}

#[unsafe(no_mangle)]
extern "C" fn fmi2ExitInitializationMode(component: Component) -> Status {
    on(component, |living| living.instance.exit_initialization())
}

#[unsafe(no_mangle)]
extern "C" fn fmi2Terminate(component: Component) -> Status {
    on(component, |living| living.instance.terminate())
}

#[unsafe(no_mangle)]
extern "C" fn fmi2Reset(component: Component) -> Status {
    on(component, |living| {
        living.instance.reset();
        Ok(())
    })
}

#[unsafe(no_mangle)]
extern "C" fn fmi2GetReal(
    component: Component,
    references: *const ValueReference,
    count: usize,
    values: *mut f64,
) -> Status {
    read((component, references, count), values, Instance::real)
}

#[unsafe(no_mangle)]
extern "C" fn fmi2GetInteger(
    component: Component,
    references: *const ValueReference,
    count: usize,
    values: *mut c_int,
) -> Status {
    read((component, references, count), values, Instance::integer)
}

#[unsafe(no_mangle)]
extern "C" fn fmi2GetBoolean(
    component: Component,
    references: *const ValueReference,
    count: usize,
    values: *mut Boolean,
) -> Status {
    read((component, references, count), values, |instance, reference| {
        instance.boolean(reference).map(Boolean::from)
    })
}

#[unsafe(no_mangle)]
extern "C" fn fmi2GetString(
    component: Component,
    references: *const ValueReference,
    count: usize,
    values: *mut *const c_char,
) -> Status {
    read((component, references, count), values, |_, reference| {
        Err(Refusal::Variable { reference, asked: "read as a string" })
    })
}

#[unsafe(no_mangle)]
extern "C" fn fmi2SetReal(
    component: Component,
    references: *const ValueReference,
    count: usize,
    values: *const f64,
) -> Status {
    on(component, |living| {
        let pairs = given(references, count).iter().zip(given(values, count));
        pairs.into_iter().try_for_each(|(reference, value)| living.instance.set_real(*reference, *value))
    })
}

#[unsafe(no_mangle)]
extern "C" fn fmi2SetInteger(
    component: Component,
    references: *const ValueReference,
    count: usize,
    values: *const c_int,
) -> Status {
    on(component, |living| {
        let pairs = given(references, count).iter().zip(given(values, count));
        pairs.into_iter().try_for_each(|(reference, value)| living.instance.set_integer(*reference, *value))
    })
}

/// Refuses to set what cannot be set.
fn none_to_set(
    (component, references, count): (Component, *const ValueReference, usize),
    asked: &'static str,
) -> Status {
    on(component, |_| match given(references, count) {
        [] => Ok(()),
        [reference, ..] => Err(Refusal::Variable { reference: *reference, asked }),
    })
}

#[unsafe(no_mangle)]
extern "C" fn fmi2SetBoolean(
    component: Component,
    references: *const ValueReference,
    count: usize,
    _values: *const Boolean,
) -> Status {
    none_to_set((component, references, count), "set as a boolean")
}

#[unsafe(no_mangle)]
extern "C" fn fmi2SetString(
    component: Component,
    references: *const ValueReference,
    count: usize,
    _values: *const *const c_char,
) -> Status {
    none_to_set((component, references, count), "set as a string")
}

#[unsafe(no_mangle)]
extern "C" fn fmi2GetFMUstate(component: Component, state: *mut *mut c_void) -> Status {
    on(component, |living| {
        // SAFETY: the caller gives a place for the pointer: nothing, or a state of this instance to be replaced.
        unsafe {
            match (*state).cast::<Instance>().as_mut() {
                Some(kept) => kept.clone_from(&living.instance),
                None => state.write(Box::into_raw(Box::new(living.instance.clone())).cast()),
            }
        }
        Ok(())
    })
}

#[unsafe(no_mangle)]
extern "C" fn fmi2SetFMUstate(component: Component, state: *mut c_void) -> Status {
    on(component, |living| {
        // SAFETY: the caller hands back a state that `fmi2GetFMUstate` gave it.
        if let Some(kept) = unsafe { state.cast::<Instance>().as_ref() } {
            living.instance.clone_from(kept);
        }
        Ok(())
    })
}

#[unsafe(no_mangle)]
extern "C" fn fmi2FreeFMUstate(component: Component, state: *mut *mut c_void) -> Status {
    on(component, |_| {
        // SAFETY: the caller hands back a state that `fmi2GetFMUstate` gave it, or nothing; it is forgotten after it is freed.
        unsafe {
            if !state.is_null() && !(*state).is_null() {
                drop(Box::from_raw((*state).cast::<Instance>()));
                state.write(std::ptr::null_mut());
            }
        }
        Ok(())
    })
}

#[unsafe(no_mangle)]
extern "C" fn fmi2DoStep(component: Component, point: f64, step: f64, _keeps: Boolean) -> Status {
    on(component, |living| living.instance.step(point, step))
}

/// Functions whose capability the description denies.
macro_rules! denied {
    ($($name:ident($($argument:ident: $kind:ty),*));* $(;)?) => {$(
        #[unsafe(no_mangle)]
        extern "C" fn $name(_: Component, $($argument: $kind),*) -> Status {
            let _ = ($($argument,)*);
            Status::Error
        }
    )*};
}

denied! {
    fmi2SerializedFMUstateSize(state: *mut c_void, size: *mut usize);
    fmi2SerializeFMUstate(state: *mut c_void, bytes: *mut c_char, size: usize);
    fmi2DeSerializeFMUstate(bytes: *const c_char, size: usize, state: *mut *mut c_void);
    fmi2GetDirectionalDerivative(unknown: *const ValueReference, unknowns: usize, known: *const ValueReference, knowns: usize, by: *const f64, out: *mut f64);
    fmi2SetRealInputDerivatives(references: *const ValueReference, count: usize, orders: *const c_int, values: *const f64);
    fmi2GetRealOutputDerivatives(references: *const ValueReference, count: usize, orders: *const c_int, values: *mut f64);
    fmi2CancelStep();
    fmi2GetStatus(kind: c_int, value: *mut c_int);
    fmi2GetRealStatus(kind: c_int, value: *mut f64);
    fmi2GetIntegerStatus(kind: c_int, value: *mut c_int);
    fmi2GetBooleanStatus(kind: c_int, value: *mut Boolean);
    fmi2GetStringStatus(kind: c_int, value: *mut *const c_char);
}
