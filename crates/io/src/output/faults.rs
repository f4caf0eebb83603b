//! Faults of the disk that tests inject; a program at work has none.

use std::io;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Duration;

/// The variable that injects them into a whole process, as in `no-exchange pause=3 fail=7`. Builds without debug assertions do not read it.
pub(super) const VARIABLE: &str = "SWITCHBACK_FAULTS";

/// The same for what a study keeps while it runs, as in `eager fail=7`.
pub(super) const WHILE_RUNNING: &str = "SWITCHBACK_FAULTS_WHILE_RUNNING";

/// What goes wrong, and when: calls that change the disk are counted from 1.
#[derive(Debug, Default)]
pub(super) struct Faults {
    /// Folders cannot be exchanged, as on network file systems.
    pub(super) no_exchange: bool,
    /// What is otherwise kept from time to time is kept at every opportunity.
    pub(super) eager: bool,
    /// The call that fails.
    pub(super) fail: Option<usize>,
    /// The call before which the process says `paused` and waits to be killed.
    pub(super) pause: Option<usize>,
    /// Calls so far.
    pub(super) calls: AtomicUsize,
}

impl Faults {
    /// Those that a variable of the environment asks for.
    pub(super) fn of(variable: &str) -> Self {
        if !cfg!(debug_assertions) {
            return Self::default();
        }
        let asked = std::env::var(variable).unwrap_or_default();
        let number = |key: &str| {
            let value = asked.split(' ').find_map(|word| word.strip_prefix(key)?.strip_prefix('='));
            value.and_then(|value| value.parse().ok())
        };
        let says = |what: &str| asked.split(' ').any(|word| word == what);
        Self {
            no_exchange: says("no-exchange"),
            eager: says("eager"),
            fail: number("fail"),
            pause: number("pause"),
            calls: AtomicUsize::new(0),
        }
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
