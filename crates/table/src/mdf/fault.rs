//! What can be wrong with a log.

use std::io;
use thiserror::Error;

/// Why a log, or what follows in it, cannot be read.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub(super) enum Fault {
    #[error("it does not begin as MDF does")]
    NotMdf,
    #[error("it is MDF {0}, not MDF 4")]
    Version(String),
    #[error("the file ends at byte {length}, before its block at byte {at} does")]
    CutOff { at: u64, length: u64 },
    #[error("at byte {at} there is no block {wanted}")]
    NotBlock { at: u64, wanted: &'static str },
    #[error("the block at byte {at} states a length of {length} bytes")]
    Length { at: u64, length: u64 },
    #[error("its blocks overlap, or refer to each other in a circle")]
    Overlap,
    #[error("data are stored by columns")]
    ByColumns,
    #[error(
        "the compression of the block at byte {at} has the number {method}: only deflate, 0 and 1, is read"
    )]
    Compression { at: u64, method: u8 },
    #[error("the compressed block at byte {at} is damaged")]
    Damaged { at: u64 },
    #[error("a record has the number {0}, which no group has")]
    RecordId(u64),
    #[error("records of {0} bytes")]
    RecordLength(usize),
    #[error("there should be {0}")]
    Fewer(u64),
    #[error("the records of several groups have no numbers that distinguish them")]
    Mixed,
    #[error("it holds more than {0} channels")]
    Channels(usize),
    #[error("it holds more than {0} numbers")]
    More(usize),
    #[error("it holds no channel of numbers{0}")]
    NoNumbers(String),
    #[error("{0}")]
    Unreadable(String),
}

impl From<io::Error> for Fault {
    fn from(error: io::Error) -> Self {
        Self::Unreadable(error.to_string())
    }
}
