//! Prints which sizes every law reaches, and at what magnitude: `cargo run -p switchback-lab --example survey`.

#![allow(clippy::disallowed_macros, reason = "an example prints")]

use switchback_lab::generate::{EFFECTS, FOREIGN, MakeError, MakeRig, RequestedFault, laws_of};

fn main() -> Result<(), MakeError> {
    for effect in EFFECTS.iter().chain(&FOREIGN) {
        for (law, card) in laws_of(effect).iter().enumerate() {
            print!("{effect:22} {:30}", card.name());
            for size in [0.5, 1.0, 2.0, 4.0] {
                let (mut least, mut most, mut magnitudes) = (f64::INFINITY, 0.0_f64, Vec::new());
                for seed in 0..6 {
                    let made =
                        MakeRig::new(100 + seed).with(RequestedFault::with_law(effect, law, size)?).make()?;
                    let truth = &made.key.effects[0];
                    (least, most) = (least.min(truth.size), most.max(truth.size));
                    magnitudes.push(truth.magnitude);
                }
                magnitudes.sort_by(f64::total_cmp);
                print!("  {least:5.2}–{most:4.2} @ {:9.3e}", magnitudes[3]);
            }
            println!("  {}", card.unit());
        }
    }
    Ok(())
}
