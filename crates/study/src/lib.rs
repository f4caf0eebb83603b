//! Consistency studies: scenarios, parallel Monte-Carlo execution, checkpoints, verdicts and result tables.

pub mod checkpoint;
pub mod compare;
pub mod consistency;
pub mod design;
pub mod estimate;
pub mod foreign;
pub mod journal;
mod method_name;
mod other_kind;
pub mod parts;
mod request;
pub mod results;
pub mod scenario;
mod shard;

pub use method_name::ForeignName;
pub use method_name::MethodName;
pub use other_kind::{OtherKind, refuse_other_kinds};
pub use request::Request;
pub use shard::Shard;
