//! One machine as it is simulated and differentiated: two borders, a linear part, and terms for effects beside these.
//!
//! ```text
//! v → position → borders (z between them, width) → + additions → u → delay → B/A → gain, zero → additions → reading → y
//! ```
//!
//! A [`System`] simulates a record from rest at its first input. Its linear part has unit gain at rest, so that the borders are in units of the output. Every
//! effect is a [`Term`]: a law, and values the first of which is its strength; at strength zero it changes nothing. [`Quantity`] names what a person would change in a
//! machine or a simulator, reads it from a system, and sets it.

mod borders;
mod delayed;
mod law;
mod laws;
mod linear_part;
mod modes;
mod motion;
mod path;
mod price;
mod quantity;
mod scale;
mod signals;
mod simulate;
mod structure;

pub use borders::Borders;
pub use delayed::delayed;
pub use law::{Law, Parameter, Term, Unit};
pub use laws::{LAWS, every_law};
pub use linear_part::LinearPart;
pub use modes::Mode;
pub use motion::Motion;
pub use path::Path;
pub use price::price;
pub use quantity::{Change, Quantity};
pub use scale::Scale;
pub use signals::{Operator, Span};
pub use simulate::{Sensor, System};
