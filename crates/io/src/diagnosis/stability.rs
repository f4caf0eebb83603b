//! The verdicts of parts of the records.

/// The verdicts of parts of the records beside that of all.
///
/// A sample takes three quarters of every record, consecutive ones from a random start, so that no input is repeated and no residual parted from the input that it
/// belongs to: D. N. Politis, J. P. Romano, M. Wolf, *Subsampling*, Springer 1999. Records of designed experiments stay whole.
#[derive(Debug, Clone, PartialEq)]
pub struct Stability {
    /// Samples of all records.
    pub samples: Vec<PartVerdict>,
    /// Each recording alone; none where there is only one.
    pub recordings: Vec<PartVerdict>,
}

/// The verdict of a part of the records.
#[derive(Debug, Clone, PartialEq)]
pub struct PartVerdict {
    /// The recording, or the number of the sample.
    pub part: String,
    /// Its verdict in words, or the reason why it has none.
    pub verdict: String,
    /// Whether it is that of all records.
    pub agrees: bool,
}

impl Stability {
    /// Parts that agree, and parts.
    pub fn agreeing(parts: &[PartVerdict]) -> (usize, usize) {
        (parts.iter().filter(|part| part.agrees).count(), parts.len())
    }
}
