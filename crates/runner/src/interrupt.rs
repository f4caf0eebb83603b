//! Being stopped: Ctrl-C, SIGTERM, a closed terminal.

use crate::failure::STOPPED;
use crate::output::{abandon, note};

/// From here on a signal ends the process with exit code 3. What is being written is written to its end first, whatever is only staged is
/// removed, and what an examination has judged is kept.
///
/// # Panics
/// If called twice.
pub fn install() {
    let stop = || {
        let _nobody_begins_to_write = abandon();
        note("\nstopped; what was finished is kept, and nothing is half-written\n");
        std::process::exit(STOPPED);
    };
    ctrlc::set_handler(stop).expect("no other handler of signals is installed");
}
