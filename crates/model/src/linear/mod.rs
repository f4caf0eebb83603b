//! Linear systems `A(q⁻¹) y = B(q⁻¹) u + ξ`.

mod autocovariance;
mod filter;
mod frequency;
mod initial_states;
mod noise_memory;
mod polynomial;
mod recurse;
mod sum_variance;
mod system;

pub use autocovariance::autocovariance;
pub use filter::filter;
pub use frequency::frequency_response;
pub use frequency::roots;
pub use initial_states::initial_state_responses;
pub use noise_memory::NoiseMemory;
pub use polynomial::is_stable;
pub use polynomial::relative_coprimeness;
pub use polynomial::settling_samples;
pub use polynomial::spectral_radius;
pub use recurse::recurse;
pub use sum_variance::SumVariance;
pub use system::LinearSystem;
pub use system::SystemError;
