//! What one replicate gave in a cell of a method of others.

/// Estimates less the truth, or why there are none.
#[derive(Debug, Clone, PartialEq)]
pub struct ReplicateErrors {
    /// From the record.
    pub own: Result<Vec<f64>, String>,
    /// From the record with the noise's sign changed, where one was asked for.
    pub partner: Option<Result<Vec<f64>, String>>,
}

impl ReplicateErrors {
    /// Errors by sign of the noise, where there is an estimate.
    pub fn signs(&self) -> [Option<&[f64]>; 2] {
        let partner = self.partner.as_ref().and_then(|partner| partner.as_ref().ok());
        [self.own.as_ref().ok(), partner].map(|errors| errors.map(Vec::as_slice))
    }

    /// Why an estimate is missing, if one is.
    pub fn failure(&self) -> Option<&str> {
        let partner = self.partner.iter().filter_map(|partner| partner.as_ref().err());
        self.own.as_ref().err().into_iter().chain(partner).next().map(String::as_str)
    }
}
