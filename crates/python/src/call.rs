//! One call from Python.
//!
//! The work runs in a thread of its own, without the interpreter's lock; the thread that called waits, asks the interpreter for signals, and
//! shows how far the work has come. Ctrl-C raises `KeyboardInterrupt` there at once; the work gives up as soon as its next piece is done. Each
//! call has its own flag, so that one that was stopped leaves nothing behind.

use crate::refusal::Refusal;
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use std::any::Any;
use std::ops::ControlFlow;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::Duration;
use switchback_identify::free;
use switchback_io::progress::Stages;
use switchback_study::consistency::{Keeper, Progress, Snapshot};

/// How often signals are looked for, and how far the work has come is reported.
const MOMENT: Duration = Duration::from_millis(50);

/// As much as the main thread of a program has.
const STACK: usize = 8 << 20;

/// What the work and whoever waits for it share.
#[derive(Debug, Default)]
pub(crate) struct Call {
    is_stopped: AtomicBool,
    stage: Mutex<&'static str>,
    found: AtomicU64,
    done: AtomicU64,
}

/// What unwinds work that is given up.
struct Stopped;

/// Something in Python that hears how far the work has come: called with the stage, the pieces done and the pieces known.
pub(crate) type Heard<'py> = Option<Bound<'py, PyAny>>;

impl Call {
    /// Runs work on a thread of its own.
    ///
    /// # Errors
    /// What the work refuses; what a signal or the listener raised meanwhile.
    pub(crate) fn run<R: Send + 'static>(
        py: Python<'_>,
        heard: &Heard<'_>,
        work: impl FnOnce(Arc<Self>) -> Result<R, Refusal> + Send + 'static,
    ) -> PyResult<R> {
        let call = Arc::new(Self::default());
        let (describe, reported) = channel();
        let theirs = Arc::clone(&call);
        let working = move || {
            let ended = catch_unwind(AssertUnwindSafe(|| work(theirs)));
            // Nobody listens any more to work that was given up.
            let _ = describe.send(ended);
        };
        thread::Builder::new().name("switchback".to_owned()).stack_size(STACK).spawn(working)?;
        let reported = Mutex::new(reported);
        let wait = || reported.lock().unwrap_or_else(PoisonError::into_inner).recv_timeout(MOMENT);
        loop {
            match py.detach(wait) {
                Ok(Ok(result)) => return Ok(result?),
                Ok(Err(panic)) => return Err(broken(&*panic)),
                Err(RecvTimeoutError::Disconnected) => {
                    return Err(broken(&"the work ended without a result"));
                }
                Err(RecvTimeoutError::Timeout) => {
                    call.attend(py, heard).inspect_err(|_| call.is_stopped.store(true, Ordering::Relaxed))?;
                }
            }
        }
    }

    fn attend(&self, py: Python<'_>, heard: &Heard<'_>) -> PyResult<()> {
        py.check_signals()?;
        if let Some(heard) = heard {
            let stage = *self.stage.lock().unwrap_or_else(PoisonError::into_inner);
            heard.call1((stage, self.done.load(Ordering::Relaxed), self.found.load(Ordering::Relaxed)))?;
        }
        Ok(())
    }

    /// Gives the work up where that is wished.
    fn go_on(&self) {
        if self.is_stopped.load(Ordering::Relaxed) {
            resume_unwind(Box::new(Stopped));
        }
    }
}

/// A fault of the program, not of what it was given.
fn broken(panic: &(dyn Any + Send)) -> PyErr {
    let words = panic.downcast_ref::<&str>().map(ToString::to_string);
    let words = words.or_else(|| panic.downcast_ref::<String>().cloned()).unwrap_or_default();
    PyRuntimeError::new_err(format!("internal error, please report it: {words}"))
}

impl Stages for Call {
    fn begin(&self, stage: &'static str) {
        *self.stage.lock().unwrap_or_else(PoisonError::into_inner) = stage;
        self.found.store(0, Ordering::Relaxed);
        self.done.store(0, Ordering::Relaxed);
        self.go_on();
    }
}

impl Progress for Call {
    fn planned(&self, replicates: u64) {
        self.found.store(replicates, Ordering::Relaxed);
    }

    fn advanced(&self, replicates: u64) {
        self.done.fetch_add(replicates, Ordering::Relaxed);
    }
}

impl free::Progress for Call {
    fn found(&self, pieces: usize) {
        self.found.fetch_add(pieces as u64, Ordering::Relaxed);
        self.go_on();
    }

    fn did_one(&self) {
        self.done.fetch_add(1, Ordering::Relaxed);
        self.go_on();
    }
}

/// A study, or a measurement of power, that this call can stop: it keeps nothing.
#[derive(Debug)]
pub(crate) struct Stoppable(pub(crate) Arc<Call>);

impl Keeper for Stoppable {
    fn keep(&mut self, _: &Snapshot<'_>) -> ControlFlow<()> {
        if self.is_stopped() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }

    fn is_stopped(&self) -> bool {
        self.0.is_stopped.load(Ordering::Relaxed)
    }
}

/// Diagnoses that are counted: the call gives up after the one running.
impl Progress for Stoppable {
    fn planned(&self, pieces: u64) {
        self.0.planned(pieces);
    }

    fn advanced(&self, pieces: u64) {
        self.0.advanced(pieces);
        self.0.go_on();
    }
}
