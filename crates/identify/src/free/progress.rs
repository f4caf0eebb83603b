//! How far an identification has come.

/// Hears of pieces of work. They differ in size, and become known as the work goes on.
pub trait Progress: Sync {
    /// More pieces have become known.
    fn found(&self, pieces: usize);

    /// A piece is done.
    fn did_one(&self);
}

/// Nobody hears.
impl Progress for () {
    fn found(&self, _pieces: usize) {}

    fn did_one(&self) {}
}
