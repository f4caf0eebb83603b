//! Being stopped: Ctrl-C, SIGTERM, a closed terminal.

use crate::failure::STOPPED;
#[cfg(unix)]
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::thread;
use std::time::Duration;
use switchback_io::output::{abandon, note};

/// Whether someone wished the process to stop.
static WISHED: AtomicBool = AtomicBool::new(false);

/// How much of the work at hand ends by itself where that is wished.
static SIGNAL_GUARD: AtomicUsize = AtomicUsize::new(0);

/// What a piece of work that ends by itself may take to do so: a third of the time that Slurm leaves between SIGTERM and SIGKILL.
const PATIENCE: Duration = Duration::from_secs(10);

/// From here on a signal ends the process with exit code 3. Work that [heeds](SignalGuard) it ends by itself; after ten seconds, at a second
/// signal, or where nothing heeds it, the process ends at once: what is being written is written to its end first, whatever is only staged is
/// removed, and what has been kept of a study or an examination stays.
///
/// # Panics
/// If called twice.
pub(crate) fn install() {
    let stop = || {
        if SIGNAL_GUARD.load(Ordering::SeqCst) == 0 || WISHED.swap(true, Ordering::SeqCst) {
            end();
        }
        thread::spawn(|| {
            thread::sleep(PATIENCE);
            end();
        });
    };
    ctrlc::set_handler(stop).expect("no other handler of signals is installed");
    survive_limits();
}

/// A file that would grow beyond `ulimit -f` cannot be written, as on a full disk; without this the process would end at once, and leave what is
/// only staged.
fn survive_limits() {
    #[cfg(unix)]
    {
        use signal_hook::consts::SIGXFSZ;
        let _the_call_reports_it_too = signal_hook::flag::register(SIGXFSZ, Arc::default());
    }
}

fn end() -> ! {
    switchback_host::stop();
    let _nobody_begins_to_write = abandon();
    note("\nstopped; what was finished is kept, and nothing is half-written\n");
    std::process::exit(STOPPED.into());
}

/// Whether someone wished the process to stop. Who asks [heeds](SignalGuard) it.
pub(crate) fn is_wished() -> bool {
    WISHED.load(Ordering::Relaxed)
}

/// While it lives, a signal is left to the work at hand, which asks [`is_wished`] often.
#[derive(Debug)]
pub(crate) struct SignalGuard(());

impl SignalGuard {
    /// From here on.
    #[must_use]
    pub(crate) fn new() -> Self {
        SIGNAL_GUARD.fetch_add(1, Ordering::SeqCst);
        Self(())
    }
}

impl Drop for SignalGuard {
    fn drop(&mut self) {
        SIGNAL_GUARD.fetch_sub(1, Ordering::SeqCst);
    }
}
