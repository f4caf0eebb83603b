//! Random rigs with known causes, for calibrating and checking the diagnosis.
//!
//! Every rig is simulated sample by sample by plain loops that share nothing with the fitted features, so that this doubles
//! as their oracle. Systems, borders, drives and magnitudes are random; the size of the effect is tuned until the *surviving*
//! gap (what remains of it in the residual after the best nominal re-fit) has the size asked for.

mod drive;
mod plant;

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use switchback_estimator::Record;
use switchback_estimator::hysteresis::Interval;
use switchback_estimator::rig::{Rig, RigRecord, Role, Usage};

use crate::effect::Effect;
use crate::nominal::identify::identify;
use crate::records::campaign::Campaign;
use drive::Drive;
use plant::Plant;

/// What is wrong with a specimen.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Cause {
    /// Nothing.
    Nothing,
    /// An effect of the library; of several laws one is drawn.
    Library(Effect),
    /// Something that no effect of the library describes.
    Foreign(Foreign),
}

/// Causes outside the library.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Foreign {
    /// A pole that moves with the level of the output.
    LevelDependentPole,
    /// The sensor now and then repeats its last value.
    Dropouts,
    /// The equation error grows with the output.
    MultiplicativeNoise,
    /// The borders swap their shape for another above a level that the output reaches.
    OutputDependentBorder,
}

impl Foreign {
    /// Every foreign cause.
    pub const ALL: [Self; 4] =
        [Self::LevelDependentPole, Self::Dropouts, Self::MultiplicativeNoise, Self::OutputDependentBorder];
}

/// A rig whose cause is known.
#[derive(Debug, Clone)]
pub struct Specimen {
    /// The records, as a user's folder would hold them.
    pub rig: Rig,
    /// What is wrong with it.
    pub causes: Vec<Cause>,
    /// Surviving gap in noise standard deviations; zero where nothing is wrong.
    pub surviving: f64,
}

/// Draws a rig with these causes (none, one or two), each tuned to a surviving gap of `size` noise standard deviations.
///
/// The same arguments give the same rig.
pub fn specimen(causes: &[Cause], size: f64, seed: u64) -> Specimen {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let mut plant = Plant::draw(&mut rng);
    let drive = Drive::draw(&mut rng, plant.order());
    let noise_seed = rng.random::<u64>();
    let draws: Vec<u64> = causes.iter().map(|_| rng.random::<u64>()).collect();
    let mut surviving = 0.0;
    for (cause, draw) in causes.iter().zip(draws) {
        let alone = plant.effects.clone();
        let mut magnitude: f64 = 0.15;
        for _ in 0..5 {
            plant.effects.clone_from(&alone);
            plant.add(*cause, magnitude, draw);
            let mut single = plant.clone();
            single.effects.retain(|e| !alone.contains(e));
            let rig = assemble(&single, &drive, noise_seed);
            surviving = surviving_gap(&rig, &single, noise_seed);
            let ratio = size / surviving.max(0.02);
            if (0.85..1.18).contains(&ratio) || *cause == Cause::Nothing {
                break;
            }
            let next = (magnitude * ratio.powf(0.8).clamp(0.2, 5.0)).clamp(0.002, 1.0);
            if next == magnitude {
                break;
            }
            magnitude = next;
        }
        plant.effects.clone_from(&alone);
        plant.add(*cause, magnitude, draw);
    }
    Specimen { rig: assemble(&plant, &drive, noise_seed), causes: causes.to_vec(), surviving }
}

/// Runs every experiment of the campaign, one after the other.
fn assemble(plant: &Plant, drive: &Drive, seed: u64) -> Rig {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let mut clock = 0;
    let total: usize = drive.records.iter().map(|r| r.v.len()).sum();
    let records = drive
        .records
        .iter()
        .map(|r| {
            let y = plant.run(&r.v, clock as f64 / total as f64, 1.0 / total as f64, &mut rng);
            clock += r.v.len();
            RigRecord {
                name: r.name.into(),
                role: r.role,
                usage: if r.held_out { Usage::Holdout } else { Usage::Fit },
                record: Record::new(r.v.clone(), y).expect("simulated signals are finite and equally long"),
                predicted: None,
            }
        })
        .collect();
    Rig {
        name: "specimen".into(),
        sample_time: 0.01,
        order: Some(plant.order()),
        interval: Interval::new(-1.0, 1.0).ok(),
        input_label: "v".into(),
        output_label: "y".into(),
        records,
    }
}

/// `√(σ²_nominal/σ² − 1)`: what the best nominal model leaves in its residual, in noise standard deviations.
fn surviving_gap(rig: &Rig, plant: &Plant, _seed: u64) -> f64 {
    let Ok(campaign) = Campaign::new(rig) else { return 0.0 };
    let Ok(fit) = identify(&campaign, plant.order()) else { return 0.0 };
    let sd = plant.noise / campaign.y_scale;
    (fit.power / (sd * sd) - 1.0).max(0.0).sqrt()
}

/// A record of the campaign before it is run.
struct Planned {
    name: &'static str,
    role: Role,
    held_out: bool,
    v: Vec<f64>,
}
