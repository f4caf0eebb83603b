//! How a file in Apache Parquet begins, and ends.

/// Its first four bytes, and its last.
pub(super) const MAGIC: &[u8] = b"PAR1";
