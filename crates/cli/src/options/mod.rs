//! Options that several verbs share, to be flattened into their arguments.

mod force;
mod output;
mod quiet;
mod threads;
mod yes;

pub use force::Force;
pub use output::Output;
pub use quiet::Quiet;
pub use threads::Threads;
pub use yes::Yes;
