//! Options that several verbs share, to be flattened into their arguments.

mod force;
mod positive;
mod quiet;
mod threads;

pub use force::Force;
pub use positive::positive;
pub use quiet::Quiet;
pub use threads::Threads;
