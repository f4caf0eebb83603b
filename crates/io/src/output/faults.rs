//! Faults of the disk that tests inject; a program at work has none.

use std::io;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Duration;

/// Faults and when they occur: calls that change the disk are counted from 1.
#[derive(Debug, Default)]
pub(super) struct Faults {
    /// Folders cannot be exchanged, as on network file systems.
    pub(super) no_exchange: bool,
    /// Sums that are otherwise kept from time to time are kept at every opportunity.
    pub(super) eager: bool,
    /// The call that fails.
    pub(super) fail: Option<usize>,
    /// The call before which the process says `paused` and waits to be killed.
    pub(super) pause: Option<usize>,
    /// Calls so far.
    pub(super) calls: AtomicUsize,
}

impl Faults {
    /// Those that a variable of the environment asks for, as in `no-exchange pause=3 fail=7`. Builds without debug assertions do not
    /// read it.
    pub(super) fn of(variable: &str) -> Self {
        if !cfg!(debug_assertions) {
            return Self::default();
        }
        let asked = std::env::var(variable).unwrap_or_default();
        let mut faults = Self::default();
        for word in asked.split(' ') {
            match word.split_once('=').unwrap_or((word, "")) {
                ("no-exchange", _) => faults.no_exchange = true,
                ("eager", _) => faults.eager = true,
                ("fail", call) => faults.fail = call.parse().ok(),
                ("pause", call) => faults.pause = call.parse().ok(),
                _ => {}
            }
        }
        faults
    }

    /// Comes before each call.
    pub(super) fn before_call(&self) -> io::Result<()> {
        let call = Some(1 + self.calls.fetch_add(1, Ordering::Relaxed));
        if call == self.pause {
            eprintln!("paused");
            std::thread::sleep(Duration::from_secs(600));
        }
        if call == self.fail {
            return Err(io::Error::other("injected by a test"));
        }
        Ok(())
    }
}
