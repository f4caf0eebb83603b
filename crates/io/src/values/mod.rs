//! Values of options as users write them: each is parsed here, whoever asks, and refused in the same words.

mod choice;
mod error;
mod numbers;

pub use choice::UnknownName;
pub use choice::named;
pub use error::ValueError;
pub use numbers::interval;
pub use numbers::is_positive;
pub use numbers::number;
pub use numbers::pair;
pub use numbers::positive;
pub use numbers::share;
pub use numbers::whole;
