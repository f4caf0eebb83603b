//! The functions of an FMU's library.

use crate::description::Description;
use crate::map::Ports;
use crate::messages::{Job, Line};
use crate::reporter::Reporter;
use libloading::{Library, Symbol};
use std::error::Error;
use std::ffi::{CStr, CString, c_char, c_int, c_void};
use std::path::Path;
use switchback_fmu::fmi2::{
    CO_SIMULATION, Callbacks, Component, DoStep, FreeInstance, GetReal, Instantiate, Logger, OfInstance,
    SetReal, SetupExperiment, Status,
};

/// Runs the library of an FMU, unpacked into `folder`, over a job, and reports what comes out.
pub(crate) fn run(
    description: &Description,
    ports: &Ports,
    (job, folder): (&Job, &Path),
    reporter: &mut Reporter,
) -> Result<(), String> {
    // SAFETY: a library runs code of its own when it is loaded: that is why this process is none but its own.
    let library = unsafe { Library::new(&description.library) }.map_err(|error| {
        let why = error.source().map_or_else(|| error.to_string(), ToString::to_string);
        format!("its library cannot be loaded: {why}")
    })?;
    let unit = Functions::of(&library)?;
    let fails = |error: std::io::Error| error.to_string();
    let resources = std::path::absolute(folder.join("resources")).map_err(fails)?;
    let words = |text: String| CString::new(text).map_err(|_| "its description has a zero byte".to_owned());
    let about = (words(description.guid.clone())?, words(address(&resources))?);
    for (record, v) in job.inputs.iter().enumerate() {
        reporter.reached(record, 0).map_err(fails)?;
        let stands = |sample| reporter.reached(record, sample).map_err(fails);
        let y = unit.over((&about.0, &about.1), (ports, job.sample_time), v, stands)?;
        if let Some(sample) = y.iter().position(|y| !y.is_finite()) {
            reporter.report(&Line::At(record, sample)).map_err(fails)?;
            return Err(format!("its output is {}, which is no finite number", y[sample]));
        }
        reporter.report(&Line::Ran(record, y)).map_err(fails)?;
    }
    Ok(())
}

/// The functions of an FMU that are called.
struct Functions<'a> {
    instantiate: Symbol<'a, Instantiate>,
    free: Symbol<'a, FreeInstance>,
    set_up: Symbol<'a, SetupExperiment>,
    enter: Symbol<'a, OfInstance>,
    exit: Symbol<'a, OfInstance>,
    terminate: Symbol<'a, OfInstance>,
    set: Symbol<'a, SetReal>,
    get: Symbol<'a, GetReal>,
    step: Symbol<'a, DoStep>,
}

fn function<'a, T>(library: &'a Library, name: &str) -> Result<Symbol<'a, T>, String> {
    // SAFETY: the standard gives a function of this name its type.
    unsafe { library.get(name.as_bytes()) }.map_err(|_| format!("its library has no function {name}"))
}

impl<'a> Functions<'a> {
    fn of(library: &'a Library) -> Result<Self, String> {
        Ok(Self {
            instantiate: function(library, "fmi2Instantiate")?,
            free: function(library, "fmi2FreeInstance")?,
            set_up: function(library, "fmi2SetupExperiment")?,
            enter: function(library, "fmi2EnterInitializationMode")?,
            exit: function(library, "fmi2ExitInitializationMode")?,
            terminate: function(library, "fmi2Terminate")?,
            set: function(library, "fmi2SetReal")?,
            get: function(library, "fmi2GetReal")?,
            step: function(library, "fmi2DoStep")?,
        })
    }

    /// A fresh instance over an input: one output a sample, the first one that of its beginning.
    fn over(
        &self,
        (guid, resources): (&CStr, &CStr),
        (ports, h): (&Ports, f64),
        v: &[f64],
        mut stands: impl FnMut(usize) -> Result<(), String>,
    ) -> Result<Vec<f64>, String> {
        let callbacks = callbacks();
        // SAFETY: the arguments are what the standard asks for, and live until the instance is freed.
        let instance = unsafe {
            (self.instantiate)(
                c"record".as_ptr(),
                CO_SIMULATION,
                guid.as_ptr(),
                resources.as_ptr(),
                &raw const callbacks,
                0,
                0,
            )
        };
        if instance.is_null() {
            return Err("it makes no instance".to_owned());
        }
        let end = v.len() as f64 * h;
        // SAFETY: as the standard has it, in its order, on a living instance.
        unsafe {
            went((self.set_up)(instance, 0, 0.0, 0.0, 1, end), "fmi2SetupExperiment")?;
            went((self.enter)(instance), "fmi2EnterInitializationMode")?;
        }
        self.set(instance, ports.input.reference, v[0])?;
        // SAFETY: as above.
        unsafe { went((self.exit)(instance), "fmi2ExitInitializationMode")? };
        let mut y = vec![self.get(instance, ports.output.reference)?];
        for t in 1..v.len() + ports.delay {
            stands(t - 1)?;
            self.set(instance, ports.input.reference, v[(t - 1).min(v.len() - 1)])?;
            // SAFETY: as above.
            let status = unsafe { (self.step)(instance, (t - 1) as f64 * h, h, 1) };
            went(status, &format!("a step of {h} s"))?;
            y.push(self.get(instance, ports.output.reference)?);
        }
        // SAFETY: as above; nobody uses it afterwards.
        unsafe {
            let _ = (self.terminate)(instance);
            (self.free)(instance);
        }
        Ok(y.split_off(ports.delay))
    }

    fn set(&self, instance: Component, reference: u32, x: f64) -> Result<(), String> {
        // SAFETY: one number and one value.
        let status = unsafe { (self.set)(instance, &raw const reference, 1, &raw const x) };
        went(status, &format!("fmi2SetReal of {x}"))
    }

    fn get(&self, instance: Component, reference: u32) -> Result<f64, String> {
        let mut x = f64::NAN;
        // SAFETY: one number and room for one value.
        let status = unsafe { (self.get)(instance, &raw const reference, 1, &raw mut x) };
        went(status, "fmi2GetReal")?;
        Ok(x)
    }
}

fn went(status: Status, what: &str) -> Result<(), String> {
    match status {
        Status::Ok | Status::Warning => Ok(()),
        Status::Discard => Err(format!("it refuses {what} (fmi2Discard)")),
        Status::Error => Err(format!("it refuses {what} (fmi2Error)")),
        Status::Fatal => Err(format!("it fails for good at {what} (fmi2Fatal)")),
        Status::Pending => Err(format!("it does not end {what} (fmi2Pending)")),
    }
}

/// The address of a folder; what is not plain is written by its bytes.
fn address(folder: &Path) -> String {
    let path = folder.display().to_string().replace('\\', "/");
    let byte = |byte: u8| match byte {
        b'a'..=b'z' | b'A'..=b'Z' | b'0'..=b'9' | b'/' | b'-' | b'_' | b'.' | b'~' | b':' => {
            char::from(byte).to_string()
        }
        _ => format!("%{byte:02X}"),
    };
    let path: String = path.bytes().map(byte).collect();
    let slash = if path.starts_with('/') { "" } else { "/" };
    format!("file://{slash}{path}")
}

unsafe extern "C" {
    fn calloc(count: usize, size: usize) -> *mut c_void;
    fn free(memory: *mut c_void);
}

fn callbacks() -> Callbacks {
    /// What comes after the message are values for its `%`s, which nobody here can read.
    unsafe extern "C" fn say(
        _: *mut c_void,
        _: *const c_char,
        status: c_int,
        _: *const c_char,
        message: *const c_char,
    ) {
        if status > 0 && !message.is_null() {
            // SAFETY: a message ends with a zero.
            let message = unsafe { CStr::from_ptr(message) };
            eprintln!("{}", message.to_string_lossy().replace("%%", "%"));
        }
    }
    type Plain = unsafe extern "C" fn(*mut c_void, *const c_char, c_int, *const c_char, *const c_char);
    // SAFETY: a caller clears up its own arguments in every calling convention that C has here, so that more of them do no harm.
    let logger = unsafe { std::mem::transmute::<Plain, Logger>(say) };
    Callbacks {
        logger: Some(logger),
        allocate: Some(calloc),
        free: Some(free),
        step_finished: None,
        environment: std::ptr::null_mut(),
    }
}
