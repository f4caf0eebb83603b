//! Options that several verbs share, to be flattened into their arguments.

mod force;
mod positive;
mod quiet;
mod shard;
mod threads;

pub use force::Force;
pub use positive::positive;
pub use quiet::Quiet;
pub use shard::Shard;
pub use threads::Threads;
