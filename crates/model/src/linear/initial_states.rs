//! Outputs that begin with a system at work.

use super::polynomial::spectral_radius;

/// Responses of an initial state are followed until they are this small.
const FADED: f64 = 1e-3;

/// The responses of `1/A` to each of its initial states until they have faded, of so many samples at most.
pub fn initial_state_responses(a: &[f64], samples: usize) -> Vec<Vec<f64>> {
    let radius = spectral_radius(a);
    let faded = if radius > 0.0 { (FADED.ln() / radius.min(1.0 - 1e-9).ln()).ceil() } else { 1.0 };
    // Room beyond the fading, since a multiple pole fades later than its radius says.
    let length = (2.0 * faded + 4.0 * a.len() as f64).min(samples as f64) as usize;
    let response = |k: usize| {
        let mut x = vec![0.0; length];
        x[k] = 1.0;
        for t in k + 1..length {
            x[t] = -a.iter().enumerate().filter(|(i, _)| t > *i).map(|(i, a)| a * x[t - 1 - i]).sum::<f64>();
        }
        x
    };
    (0..a.len().min(length)).map(response).collect()
}
