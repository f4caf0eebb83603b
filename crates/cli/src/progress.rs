//! How far a command has come: a bar on a terminal; elsewhere plain lines for a study, nothing for a diagnosis.

mod watch;

pub(crate) use watch::Watch;

use crate::options::Quiet;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::sync::atomic::{AtomicU64, Ordering};
use switchback_io::output::{is_watched, note};
use switchback_study::consistency::Progress;

/// Counts units of work and shows them on stderr.
#[derive(Debug)]
pub(crate) struct Meter {
    bar: ProgressBar,
    plain: bool,
    what: &'static str,
    planned: AtomicU64,
    done: AtomicU64,
}

/// Plain lines come at every tenth of the work.
const LINES: u64 = 10;

impl Meter {
    /// A meter of replicates at zero.
    pub(crate) fn new(quiet: Quiet) -> Self {
        Self::counting("replicates", quiet)
    }

    /// A meter of anything else.
    pub(crate) fn counting(what: &'static str, quiet: Quiet) -> Self {
        let quiet = quiet.quiet;
        let terminal = is_watched();
        let target =
            if quiet || !terminal { ProgressDrawTarget::hidden() } else { ProgressDrawTarget::stderr() };
        let style =
            ProgressStyle::with_template(&format!("{{bar:40}} {{pos}}/{{len}} {what}{{msg}}, {{eta}} left"))
                .unwrap_or_else(|_| ProgressStyle::default_bar());
        let bar = ProgressBar::with_draw_target(Some(0), target).with_style(style);
        Self { bar, plain: !quiet && !terminal, what, planned: AtomicU64::new(0), done: AtomicU64::new(0) }
    }

    /// So many units are to be done, of which a former run did some.
    pub(crate) fn begin(&self, planned: usize, done: usize) {
        self.planned(planned as u64);
        self.bar.set_position(done as u64);
        self.bar.reset_eta();
        self.done.store(done as u64, Ordering::Relaxed);
    }

    /// Takes the bar off the screen.
    pub(crate) fn finish(&self) {
        self.bar.finish_and_clear();
    }
}

impl Progress for Meter {
    fn planned(&self, replicates: u64) {
        self.planned.store(replicates, Ordering::Relaxed);
        self.bar.set_length(replicates);
    }

    fn imprecise(&self, cells: usize, of: usize) {
        self.bar.set_message(format!(", {cells} of {of} cells not precise enough yet"));
        if self.plain {
            let done = self.done.load(Ordering::Relaxed);
            let what = self.what;
            note(&format!("after {done} {what} {cells} of {of} cells are not precise enough yet\n"));
        }
    }

    fn advanced(&self, replicates: u64) {
        self.bar.inc(replicates);
        let before = self.done.fetch_add(replicates, Ordering::Relaxed);
        let planned = self.planned.load(Ordering::Relaxed).max(1);
        let tenth = |done: u64| LINES * done / planned;
        if self.plain && tenth(before + replicates) > tenth(before) {
            note(&format!("{} of {planned} {}\n", before + replicates, self.what));
        }
    }
}
