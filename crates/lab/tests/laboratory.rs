//! Rigs of the laboratory stay the same to the bit: committed reports and keys are of these.

use switchback_lab::generate::{MadeRig, MakeRig, Plan, RequestedFault};

/// FNV-1a over the bits of all samples (G. Fowler, L. C. Noll, K.-P. Vo).
fn fingerprint(made: &MadeRig) -> u64 {
    let of_records = made.rig.records.iter().flat_map(|r| r.record.v().iter().chain(r.record.y()));
    let of_truth = made.truth.iter().flat_map(|t| t.repeating.iter().chain(&t.surviving));
    let bytes = of_records.chain(of_truth).chain([&made.key.size, &made.key.noise_sd]);
    bytes.flat_map(|x| x.to_bits().to_le_bytes()).fold(0xcbf2_9ce4_8422_2325, |hash, byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3)
    })
}

#[test]
fn of_a_seed_and_its_effects_the_samples_are_those_that_always_were() {
    let plan = Plan { step: 300, periods: 30, sweep: 1500, drive: 600, repeat_periods: 5 };
    let made = |seed: u64, effects: &[(&str, usize)]| {
        let recipe = effects.iter().fold(MakeRig::new(seed).plan(plan), |recipe, (effect, law)| {
            recipe.with(RequestedFault::with_law(effect, *law, 2.0).expect("an effect"))
        });
        format!("{:016x}", fingerprint(&recipe.make().expect("a rig")))
    };
    assert_eq!(made(5, &[]), "b4904681b9b1703b", "no effect");
    assert_eq!(made(7, &[("backlash", 0)]), "f0c9d772350a5bb0", "a play");
    assert_eq!(made(9, &[("outliers", 2)]), "b49793b8ea6bf1fa", "bursts of outliers");
    assert_eq!(made(11, &[("creep", 1), ("record_offset", 0)]), "af99d736b220a6f1", "creep and offsets");
}
