//! Options that several verbs share, to be flattened into their arguments.

mod force;
mod output;
mod quiet;
mod threads;
mod yes;

pub(crate) use force::Force;
pub(crate) use output::Output;
pub(crate) use quiet::Quiet;
pub(crate) use threads::Threads;
pub(crate) use yes::Yes;
