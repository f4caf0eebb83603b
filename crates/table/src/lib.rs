//! Tables of measurements in any dialect, as evenly sampled signals.

mod chosen;
mod closest;
#[cfg(any(feature = "mcap", feature = "parquet"))]
mod contained;
pub mod door;
mod encodings;
mod file_error;
mod log;
mod mat;
mod mdf;
mod parquet_file;
pub mod shell;
pub mod signals;
pub mod stream;
pub mod table;
#[cfg(all(test, any(feature = "mcap", feature = "mdf", feature = "parquet")))]
mod tests;
mod text_file;
mod text_kind;
mod text_pieces;

pub use closest::closest;
pub use file_error::FileError;
pub use log::{LogField, LogTopic, WRITES_LOGS, log_bytes};
pub use text_file::read_text;
pub use text_kind::TextKind;
pub use text_pieces::read_decoded;
