use super::*;
use crate::generate::effects::{EFFECTS, FOREIGN, laws_of};
use crate::generate::law::{Amount, Nature};
use crate::generate::made_rig::MadeRig;
use crate::generate::make::MakeRig;
use crate::generate::requested_fault::RequestedFault;
use crate::generate::simulate::{Active, Noise, simulate};
use rayon::prelude::*;
use std::collections::HashSet;
use switchback_model::rig::{Role, Usage};

const SEEDS: std::ops::Range<u64> = 0..40;

fn recipe(seed: u64) -> MakeRig {
    MakeRig::new(seed).setting(Setting::Field)
}

fn bare(seed: u64) -> MadeRig {
    recipe(seed).make().expect("a rig")
}

#[test]
fn nothing_is_declared_and_every_record_is_free_and_finite() {
    for seed in SEEDS {
        let MadeRig { rig, key, truth } = bare(seed);
        assert_eq!((rig.order, rig.interval, key.setting), (None, None, Setting::Field), "seed {seed}");
        assert!(key.effects.is_empty() && key.size == 0.0, "seed {seed}");
        let held_out = rig.holdout_records().count();
        assert!((2..=4).contains(&rig.records.len()) && held_out == 1, "seed {seed}");
        assert_eq!(truth.len(), rig.records.len());
        for (record, truth) in rig.records.iter().zip(&truth) {
            assert_eq!((record.role, &record.name), (Role::Free, &truth.record), "seed {seed}");
            let (v, y) = (record.record.v(), record.record.y());
            assert!(v.len() >= 240 && v.iter().chain(y).all(|x| x.is_finite()), "seed {seed}");
            assert_eq!((truth.repeating.len(), truth.surviving.len()), (y.len(), y.len()), "seed {seed}");
        }
    }
}

#[test]
fn each_property_occurs_and_none_but_the_colour_always() {
    let made: Vec<MadeRig> = SEEDS.map(bare).collect();
    let count = |has: &dyn Fn(&MadeRig) -> bool| made.iter().filter(|rig| has(rig)).count();
    let has = |name: &str| count(&|made| made.key.base.contains(&name));
    assert_eq!(has("coloured_noise"), made.len());
    for name in ["input_noise", "gradual_transition", "extra_pole", "border_resolution"] {
        assert!((1..made.len()).contains(&has(name)), "{name}: {}", has(name));
    }
    assert_eq!(has("border_resolution"), count(&|made| made.key.curved));
    for order in 1..=3 {
        assert!(count(&|made| made.key.order == order) > 0, "order {order}");
    }
    for records in 2..=4 {
        assert!(count(&|made| made.rig.records.len() == records) > 0, "{records} records");
    }
    // A single record is known by its last part.
    let is_single =
        |made: &MadeRig| made.rig.records[1].name == format!("{}-held-out", made.rig.records[0].name);
    assert!(count(&is_single) > 0);
    for drive in drive::Drive::ALL {
        assert!(
            count(&|made| made.rig.records.iter().any(|r| r.name.starts_with(drive.name()))) > 0,
            "{drive:?}"
        );
    }
    let labels: HashSet<_> = made.iter().map(|made| &made.rig.input_label).collect();
    let sample_times: HashSet<_> = made.iter().map(|made| made.rig.sample_time.to_bits()).collect();
    assert!(labels.len() > 3 && sample_times.len() > 3);
}

/// The slowest pole, by the decay of the impulse response, lies about one of three places.
#[test]
fn poles_lie_where_one_of_three_sampling_rates_puts_them() {
    let mut at = [0; 3];
    for seed in SEEDS {
        let machine = recipe(seed).generator().machine;
        // The response falls below 10⁻⁶ after some fourteen time constants.
        let decayed = machine.settling() as f64 / 1e6_f64.ln();
        at[(0..3)
            .min_by(|i, j| (RATES[*i] / decayed).ln().abs().total_cmp(&(RATES[*j] / decayed).ln().abs()))
            .unwrap()] += 1;
        let within = RATES.iter().any(|rate| (0.7..2.2).contains(&(decayed / rate)));
        assert!(within, "seed {seed}: {decayed}");
    }
    assert!(at.iter().all(|count| *count > 3), "{at:?}");
}

/// `A(q⁻¹)(y − ȳ) = ξ'`, the coloured equation noise, with an effect and without.
#[test]
fn the_repeating_output_plus_noise_is_the_record() {
    let shape = [0.3, 0.6, 0.2, 0.8];
    let backlash = Active { law: laws_of("backlash")[0], amount: Amount { magnitude: 0.1, shape }, slot: 0 };
    for seed in 0..12 {
        let generator = recipe(seed).generator();
        let of_base = generator.base();
        let colour = of_base.iter().find(|p| p.law.effect() == "coloured_noise").expect("a colour");
        let [_, d1, d2] = colour::denominator(&colour.amount);
        let machine = &generator.machine;
        for active in [vec![], vec![backlash]] {
            let all = [of_base, &active].concat();
            for passage in &generator.passages {
                let [recorded, repeating] =
                    [Noise::Recorded, Noise::None].map(|noise| simulate(machine, &all, passage, seed, noise));
                let noise: Vec<f64> = recorded.y.iter().zip(&repeating.y).map(|(y, x)| y - x).collect();
                let scale = noise.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
                let past = |x: &[f64], t: usize, i: usize| if t >= i { x[t - i] } else { 0.0 };
                let xi: Vec<f64> = (0..noise.len())
                    .map(|t| {
                        noise[t] + machine.a.iter().zip(1..).map(|(a, i)| a * past(&noise, t, i)).sum::<f64>()
                    })
                    .collect();
                for t in 0..xi.len() {
                    let white = xi[t] + d1 * past(&xi, t, 1) + d2 * past(&xi, t, 2);
                    let off = (white - recorded.white[t]).abs();
                    assert!(
                        off < 1e-9 * (scale + machine.y_centre().abs() + machine.reach),
                        "seed {seed}, {t}: {off}"
                    );
                }
            }
        }
    }
}

#[test]
fn the_parts_of_a_single_record_are_one_recording() {
    let mut singles = 0;
    for seed in SEEDS {
        let generator = recipe(seed).generator();
        let [first, second] = generator.passages.as_slice() else { continue };
        if first.index != second.index {
            continue;
        }
        singles += 1;
        assert_eq!((first.usage, second.usage), (Usage::Fit, Usage::Holdout));
        let run = |passage| simulate(&generator.machine, generator.base(), passage, seed, Noise::Recorded).y;
        let (of_first, whole) = (run(first), run(second));
        assert_eq!(of_first, whole[..of_first.len()]);
        assert_eq!(second.recorded(&whole), &whole[of_first.len()..]);
        assert_eq!((first.start, first.total), (second.start, second.total));
    }
    assert!(singles > 0);
}

#[test]
fn the_record_of_the_input_is_the_input_plus_the_noise_of_its_sensor() {
    for seed in SEEDS {
        let generator = recipe(seed).generator();
        let reading = generator.base().iter().find(|p| p.law.effect() == "input_noise");
        let sd = reading.map_or(0.0, |p| p.amount.magnitude * generator.machine.interval.width());
        let rig = generator.rig(&[]).expect("a rig");
        for (record, passage) in rig.records.iter().zip(&generator.passages) {
            let acting = passage.recorded(&passage.v);
            let square: f64 = record.record.v().iter().zip(acting).map(|(x, y)| (x - y).powi(2)).sum();
            let found = (square / acting.len() as f64).sqrt();
            assert!((found - sd).abs() <= 0.2 * sd, "seed {seed}: {found} against {sd}");
        }
    }
}

#[test]
fn what_is_put_in_is_not_in_the_machine_beside_and_all_else_stays() {
    let machine = |recipe: &MakeRig| {
        let made = recipe.base().make().expect("a rig");
        (made.key.base.clone(), made)
    };
    for seed in SEEDS {
        let (has, before) = machine(&recipe(seed));
        for name in &has {
            let effect = RequestedFault::plain(name, 2.0).expect("an effect");
            let (left, after) = machine(&recipe(seed).with(effect));
            let others: Vec<_> = has.iter().filter(|other| *other != name).collect();
            assert_eq!(left.iter().collect::<Vec<_>>(), others, "seed {seed}");
            assert_eq!((&before.key.a, &before.key.b), (&after.key.a, &after.key.b));
            assert!(before.rig != after.rig, "seed {seed} {name}");
        }
    }
}

#[test]
fn sizes_are_met_and_the_same_recipe_or_key_gives_the_same_rig() {
    let rigs = [(5, "backlash"), (2, "sensor_drift"), (3, "outliers")];
    rigs.into_par_iter().with_max_len(1).for_each(|(seed, effect)| {
        let recipe = recipe(seed).with(RequestedFault::plain(effect, 2.0).expect("an effect"));
        let made = recipe.make().expect("a rig");
        let found = made.key.effects[0].clone();
        assert!((found.size / 2.0 - 1.0).abs() < 0.1 && made.key.size == found.size, "{found:?}");
        // By the examiner of planted faults, on the records alone.
        let base = recipe.base().make().expect("a rig");
        let size = crate::generate::injection::Base::new(&base.rig).expect("a model").surviving(&made.rig);
        assert!((size / found.size - 1.0).abs() < 1e-9, "{size} against {found:?}");
        let same = |other: MadeRig| {
            assert!(other.rig == made.rig && other.key == made.key && other.truth == made.truth, "{found:?}");
        };
        same(recipe.make().expect("a rig"));
        same(recipe.again(&made.key).expect("a rig"));
        let searched = [(found.magnitude, found.size)];
        same(recipe.made_with(made.key.noise_sd, &searched).expect("a rig").expect("as many as effects"));
        assert!(recipe.base().again(&made.key).is_err());
        assert!(recipe.clone().setting(Setting::Laboratory).again(&made.key).is_err());
    });
}

#[test]
fn another_seed_is_another_machine() {
    assert_ne!(bare(1).rig.records, bare(2).rig.records);
    assert_eq!(bare(1).rig, bare(1).rig);
}

#[test]
fn of_magnitude_zero_every_law_leaves_the_machine_as_it_is() {
    let generator = recipe(4).generator();
    let before = generator.rig(&[]).expect("a rig");
    for law in EFFECTS.iter().chain(&FOREIGN).flat_map(|effect| laws_of(effect)) {
        let active = generator.active(0, *law, 0.0);
        assert!(generator.rig(&[active]).expect("a rig") == before, "{} {}", law.effect(), law.name());
    }
    let noises = generator.base().iter().filter(|p| p.law.nature() == Nature::Noise);
    assert!(noises.count() > 0);
}
