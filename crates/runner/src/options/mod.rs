//! Options that several verbs share, to be flattened into their arguments.

mod force;
mod positive;
mod quiet;
mod threads;
mod whole;

pub use force::Force;
pub use positive::{number, positive};
pub use quiet::Quiet;
pub use threads::Threads;
pub use whole::whole;
