//! Why no rig could be made.

use switchback_model::record::RecordError;
use thiserror::Error;

/// Why no rig could be made.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum MakeError {
    /// The effect's name is unknown.
    #[error("`{name}` is no effect; known are {known}")]
    UnknownEffect {
        /// The name given.
        name: String,
        /// All names, comma-separated.
        known: String,
    },
    /// The effect has fewer laws.
    #[error("`{effect}` has {laws} laws, numbered from 0; law {law} does not exist")]
    UnknownLaw {
        /// The effect.
        effect: String,
        /// Laws it has.
        laws: usize,
        /// The law asked for.
        law: usize,
    },
    /// The size is no size.
    #[error("an effect of size {0} cannot be made; the size is a number above 0")]
    Size(f64),
    /// The key belongs to another recipe.
    #[error(
        "the key is of the rig with seed {key}, its setting and its effects, not of this recipe with seed {recipe}"
    )]
    ForeignKey {
        /// Seed of the recipe.
        recipe: u64,
        /// Seed in the key.
        key: u64,
    },
    /// The machine's records without effects give no model that a size could be measured against.
    #[error("the size of an effect cannot be measured in this machine ({0}); take another seed")]
    NoSize(String),
    /// A simulated signal was no record.
    #[error("the drawn system and effect gave no finite record ({0}); take another seed")]
    Record(#[from] RecordError),
}
