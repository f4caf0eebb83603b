//! Rigs as the field has them: machines that nobody simplified, records that nobody designed.
//!
//! What a machine of the field has beside a nominal system are laws of this crate at drawn magnitudes, its [base](properties); an effect is
//! put in on top, and a property of the same name is then left out. Its size is what survives identification anew, as that of a fault
//! planted into measured records ([`InjectedFault::size`](crate::generate::InjectedFault::size)).

mod colour;
pub(crate) mod drive;
mod machine;
mod properties;
pub(crate) mod reading;
mod records;
mod sizing;

pub(crate) use sizing::size_of_all;
pub(crate) use sizing::sized;

use crate::generate::generator::{Description, Generator};
use crate::generate::machine::Family;
use crate::generate::setting::Setting;
use crate::generate::stream::{Purpose, stream};
use rand::RngExt;

/// Samples to the slowest time constant, and their spread as a factor: coarse, usual and fine sampling.
const RATES: [f64; 3] = [5.0, 15.0, 50.0];
const SPREAD: std::ops::Range<f64> = 0.8..1.25;

/// Draws the machine of a seed, without the properties of the given names, and its dataset.
pub(crate) fn generator(seed: u64, family: Family, spared: &[&str]) -> Generator {
    let mut rng = stream(seed, Purpose::Base);
    let time_constant = RATES[rng.random_range(0..RATES.len())] * rng.random_range(SPREAD);
    let (input, output) = machine::labels(&mut rng);
    let sample_time = machine::sample_time(&mut rng);
    let output_noise = machine::output_noise(&mut rng);
    let base = properties::draw(seed, time_constant, spared, &mut rng);
    let mut machine = machine::draw((seed, family), time_constant, spared);
    machine.sample_time = sample_time;
    machine.noise_sd =
        2.0 * machine.y_half() * output_noise / properties::noise_amplification(&machine, &base);
    let mut names: Vec<&'static str> = base.iter().map(|property| property.law.effect()).collect();
    if machine.curved {
        names.push(machine::CURVED_BORDERS);
    }
    let passages = records::dataset(&machine, time_constant, &mut stream(seed, Purpose::Drive));
    let description =
        Description { setting: Setting::Field, order: None, interval: None, input, output, base: names };
    Generator::new(seed, (machine, base), passages, description)
}

#[cfg(test)]
mod tests;
