//! Stage, share done and elapsed time of a diagnosis or an identification.

use crate::options::Quiet;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::fmt;
use std::io::IsTerminal;
use std::sync::Arc;
use std::time::Duration;
use switchback_estimator::estimators::free::Progress;

/// A line on a terminal's stderr: the stage, how many of its pieces of work are done, the time since the command began.
///
/// ```text
/// ⠹ fitting each effect ██████████░░░░░░░░░░ 31/58, 4s
/// ```
///
/// Pieces become known as the work goes on, so that the bar may fall back when a stage finds more to do. A stage that is one piece
/// has no bar.
///
/// A [`Listener`] hears the same, for those who call the library.
#[derive(Debug)]
pub struct Watch {
    bar: ProgressBar,
    listener: Option<Arc<dyn Listener>>,
}

/// Hears how a diagnosis or an identification goes on, from several threads.
///
/// It may give the work up by unwinding with [`std::panic::resume_unwind`]: whoever began the work then catches that, and pieces under way end
/// first.
pub trait Listener: fmt::Debug + Send + Sync {
    /// Something was done or became known.
    fn heard(&self, step: Step);
}

/// How the work goes on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Step {
    /// A stage of this name begins.
    Stage(&'static str),
    /// So many more pieces of the stage have become known.
    Found(usize),
    /// A piece is done.
    Done,
}

/// How often the time is told where no piece is done for long.
const TICK: Duration = Duration::from_millis(200);
const ONE_PIECE: &str = "{spinner} {msg}, {elapsed}";
const MANY_PIECES: &str = "{spinner} {msg} {bar:20} {pos}/{len}, {elapsed}";

impl Watch {
    /// A line without a stage yet; none where stderr is no terminal.
    pub fn new(quiet: Quiet) -> Self {
        let hidden = quiet.quiet || !std::io::stderr().is_terminal();
        let target = if hidden { ProgressDrawTarget::hidden() } else { ProgressDrawTarget::stderr() };
        let bar = ProgressBar::with_draw_target(Some(0), target).with_style(style(ONE_PIECE));
        if !hidden {
            bar.enable_steady_tick(TICK);
        }
        Self { bar, listener: None }
    }

    /// A line that nobody sees.
    pub fn silent() -> Self {
        Self::new(Quiet { quiet: true })
    }

    /// A listener instead of a line.
    pub fn heard_by(listener: Arc<dyn Listener>) -> Self {
        let mut watch = Self::silent();
        watch.listener = Some(listener);
        watch
    }

    fn tell(&self, step: Step) {
        if let Some(listener) = &self.listener {
            listener.heard(step);
        }
    }

    /// A stage begins.
    pub fn begin(&self, stage: &'static str) {
        self.tell(Step::Stage(stage));
        self.bar.set_style(style(ONE_PIECE));
        self.bar.set_message(stage);
        self.bar.set_length(0);
        self.bar.set_position(0);
    }

    /// More pieces of the stage have become known.
    pub fn found(&self, pieces: usize) {
        self.tell(Step::Found(pieces));
        self.bar.set_style(style(MANY_PIECES));
        self.bar.inc_length(pieces as u64);
    }

    /// A piece is done.
    pub fn did_one(&self) {
        self.tell(Step::Done);
        self.bar.inc(1);
    }

    /// Takes the line off the screen.
    pub fn finish(&self) {
        self.bar.finish_and_clear();
    }
}

impl Progress for Watch {
    fn found(&self, pieces: usize) {
        self.found(pieces);
    }

    fn did_one(&self) {
        self.did_one();
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
