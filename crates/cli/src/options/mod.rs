//! Options that several verbs share, to be flattened into their arguments.

mod force;
mod output;
mod positive;
mod quiet;
mod threads;
mod whole;
mod yes;

pub use force::Force;
pub use output::Output;
pub use positive::{number, positive};
pub use quiet::Quiet;
pub use switchback_io::diagnosis::prior;
pub use threads::Threads;
pub use whole::whole;
pub use yes::{TooLong, Yes};
