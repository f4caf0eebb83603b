//! Made pairs: a machine B and a simulator A of it that differ in exactly one thing, or in nothing.

mod change;
mod difference;
mod draw;
mod row;

pub use difference::Difference;
pub use difference::PairTruth;
pub use difference::Side;
pub use draw::TrainingPair;
pub use draw::draw_pair;
pub use row::Row;
