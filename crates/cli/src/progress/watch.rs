//! Stage, share done and elapsed time of a diagnosis or an identification.

use crate::options::Quiet;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::time::Duration;
use switchback_identify::free::Progress;
use switchback_io::output::is_watched;
use switchback_io::progress::Stages;

/// A line on a terminal's stderr: the stage, how many of its pieces of work are done, the time since the command began.
///
/// ```text
/// ⠹ fitting each effect ██████████░░░░░░░░░░ 31/58, 4s
/// ```
///
/// Pieces become known as the work goes on, so that the bar may fall back when a stage finds more to do. A stage that is one piece
/// has no bar.
#[derive(Debug)]
pub(crate) struct Watch {
    bar: ProgressBar,
}

/// How often the time is reported where no piece is done for long.
const TICK: Duration = Duration::from_millis(200);
const ONE_PIECE: &str = "{spinner} {msg}, {elapsed}";
const MANY_PIECES: &str = "{spinner} {msg} {bar:20} {pos}/{len}, {elapsed}";

impl Watch {
    /// A line without a stage yet; none where stderr is no terminal.
    pub(crate) fn new(quiet: Quiet) -> Self {
        let hidden = quiet.quiet || !is_watched();
        let target = if hidden { ProgressDrawTarget::hidden() } else { ProgressDrawTarget::stderr() };
        let bar = ProgressBar::with_draw_target(Some(0), target).with_style(style(ONE_PIECE));
        if !hidden {
            bar.enable_steady_tick(TICK);
        }
        Self { bar }
    }

    /// Takes the line off the screen.
    pub(crate) fn finish(&self) {
        self.bar.finish_and_clear();
    }
}

impl Progress for Watch {
    fn found(&self, pieces: usize) {
        self.bar.set_style(style(MANY_PIECES));
        self.bar.inc_length(pieces as u64);
    }

    fn did_one(&self) {
        self.bar.inc(1);
    }
}

impl Stages for Watch {
    fn begin(&self, stage: &'static str) {
        self.bar.set_style(style(ONE_PIECE));
        self.bar.set_message(stage);
        self.bar.set_length(0);
        self.bar.set_position(0);
    }
}

fn style(template: &str) -> ProgressStyle {
    ProgressStyle::with_template(template)
        .unwrap_or_else(|_| ProgressStyle::default_spinner())
        .progress_chars("█▓░")
}

impl Drop for Watch {
    fn drop(&mut self) {
        self.finish();
    }
}
