//! What is put into a setup, and how much of it.

use super::family::Family;
use super::random::{log_uniform, one_of, weighted};
use super::reidentification::Reidentification;
use super::setup::{Setup, Signals};
use super::training_rig::Kind;
use crate::generate::TrueEffect;
use crate::generate::effects::{EFFECTS, FOREIGN, FURTHER_FOREIGN, UNNAMED, further_laws_of, laws_of};
use crate::generate::law::{Amount, Law};
use crate::generate::simulate::Active;
use crate::generate::stream::{Purpose, stream};
use rand::RngExt;
use rand_chacha::ChaCha8Rng;

/// How often each kind is drawn, in the order of [`Kind::ALL`].
const KINDS: [f64; 4] = [0.12, 0.68, 0.07, 0.13];
/// How often a second effect is there, and its size over the first's.
const WITH_SECOND: f64 = 0.2;
const SECOND: (f64, f64) = (0.1, 0.5);
/// Sizes, evenly over the logarithm.
const SIZES: (f64, f64) = (0.5, 80.0);
/// A size is met to this distance of its logarithm, in so many trials.
const TOLERANCE: f64 = 0.2;
const TRIALS: usize = 9;

/// An effect that is wanted.
#[derive(Debug, Clone, Copy)]
pub(super) struct Wanted {
    law: &'static dyn Law,
    is_plain: bool,
    size: f64,
}

/// What a rig is to show.
#[derive(Debug, Clone)]
pub(super) struct Cause {
    pub kind: Kind,
    pub wanted: Vec<Wanted>,
}

/// What was put in.
pub(super) struct PutIn {
    pub effects: Vec<TrueEffect>,
    pub signals: Vec<Signals>,
    pub size: f64,
    /// Distance from the sizes that were wanted, in logarithms.
    pub miss: f64,
}

/// Effects that a family's rigs may show: noise has a colour everywhere but in the laboratory.
pub(super) fn candidates(family: Family) -> Vec<&'static str> {
    let is_candidate = |effect: &&str| family == Family::Laboratory || *effect != "coloured_noise";
    EFFECTS.into_iter().chain(UNNAMED).filter(is_candidate).collect()
}

/// Every law of an effect.
pub(super) fn all_laws(effect: &str) -> Vec<&'static dyn Law> {
    [laws_of(effect), further_laws_of(effect)].concat()
}

impl Cause {
    pub(super) fn draw(family: Family, rng: &mut ChaCha8Rng) -> Self {
        let kind = Kind::ALL[weighted(rng, &KINDS)];
        let candidates = candidates(family);
        let size = log_uniform(rng, SIZES.0, SIZES.1);
        let wanted = match kind {
            Kind::Nothing => Vec::new(),
            Kind::Foreign => {
                let foreign = [FOREIGN.as_slice(), FURTHER_FOREIGN.as_slice()].concat();
                vec![wanted(one_of(rng, &foreign), size, rng)]
            }
            Kind::Pair => {
                let first = one_of(rng, &candidates);
                let size = size.max(1.5);
                let other = size * log_uniform(rng, 0.6, 1.0);
                vec![wanted(first, size, rng), wanted(another(first, &candidates, rng), other, rng)]
            }
            Kind::One => {
                let first = one_of(rng, &candidates);
                let mut all = vec![wanted(first, size, rng)];
                if rng.random_bool(WITH_SECOND) {
                    let share = log_uniform(rng, SECOND.0, SECOND.1);
                    all.push(wanted(another(first, &candidates, rng), share * size, rng));
                }
                all
            }
        };
        Self { kind, wanted }
    }

    /// Names of what is put in: a machine does not have these by itself.
    pub(super) fn names(&self) -> Vec<&'static str> {
        self.wanted.iter().map(|wanted| wanted.law.effect()).collect()
    }

    /// Puts it into a setup; none where a signal is not finite or the machine leaves nothing.
    pub(super) fn put_into(
        &self,
        setup: &Setup,
        before: &[Signals],
        anew: &Reidentification,
    ) -> Option<PutIn> {
        let residual = anew.left(&setup.unexplained(before));
        if residual.is_nan() || residual <= 0.0 {
            return None;
        }
        let size_of = |signals: &[Signals]| anew.left(&Setup::change(before, signals)) / residual;
        let (mut effects, mut active, mut miss) = (Vec::new(), Vec::new(), 0.0);
        for (slot, wanted) in self.wanted.iter().enumerate() {
            let found = search(setup, (slot, wanted), size_of)?;
            // A second effect only has to be smaller than the first.
            if slot == 0 || self.kind == Kind::Pair {
                miss = f64::max(miss, (found.1 / wanted.size).ln().abs());
            }
            effects.push(wanted.found(&found.0, found.1));
            active.push(found.0);
        }
        let signals = setup.signals(&active);
        let size = if active.is_empty() { 0.0 } else { size_of(&signals) };
        let is_finite = signals.iter().all(|s| s.y.iter().chain(&s.v).all(|x| x.is_finite()));
        effects.sort_by(|one, other| other.size.total_cmp(&one.size));
        (is_finite && size.is_finite()).then_some(PutIn { effects, signals, size, miss })
    }
}

/// The nominal predictions as signals: what is left of the records is the change from these.
pub(super) fn nominal(setup: &Setup) -> Vec<Signals> {
    let one = |run: &super::setup::Run| Signals { v: Vec::new(), y: run.nominal.clone(), moved: None };
    setup.runs.iter().map(one).collect()
}

impl Wanted {
    fn found(&self, active: &Active, size: f64) -> TrueEffect {
        TrueEffect {
            effect: self.law.effect(),
            law: self.law.name(),
            plain: self.is_plain,
            stage: self.law.stage(),
            nature: self.law.nature(),
            magnitude: active.amount.magnitude,
            unit: self.law.unit(),
            quantity: self.law.quantity(),
            wanted: self.size,
            size,
        }
    }
}

fn wanted(effect: &'static str, size: f64, rng: &mut ChaCha8Rng) -> Wanted {
    let laws = all_laws(effect);
    let number = rng.random_range(0..laws.len());
    Wanted { law: laws[number], is_plain: number == 0, size }
}

fn another(first: &str, candidates: &[&'static str], rng: &mut ChaCha8Rng) -> &'static str {
    let others: Vec<&'static str> = candidates.iter().copied().filter(|other| *other != first).collect();
    one_of(rng, &others)
}

/// Finds the magnitude of one effect alone, by secants in logarithms.
fn search(
    setup: &Setup,
    (slot, wanted): (usize, &Wanted),
    size_of: impl Fn(&[Signals]) -> f64,
) -> Option<(Active, f64)> {
    let law = wanted.law;
    let mut shapes = stream(setup.seed, Purpose::Shape(slot));
    let shape = std::array::from_fn(|_| shapes.random());
    // What counts noise sds has no limit of its own; slow poles make the same equation noise larger in the output.
    let larger = if law.counts_noise() { setup.machine.noise_amplification().max(1.0) } else { 1.0 };
    let limit = larger * law.limit();
    let mut magnitude = 0.05 * limit;
    let mut best: Option<(Active, f64)> = None;
    let miss = |size: f64| (size / wanted.size).max(1e-9).ln().abs();
    for _ in 0..TRIALS {
        let active = Active { law, amount: Amount { magnitude, shape }, slot };
        let size = size_of(&setup.signals(std::slice::from_ref(&active)));
        if !size.is_finite() {
            magnitude *= 0.2;
            continue;
        }
        if best.as_ref().is_none_or(|(_, other)| miss(size) < miss(*other)) {
            best = Some((active, size));
        }
        let next = (magnitude * (wanted.size / size.max(1e-9)).clamp(0.1, 8.0)).clamp(1e-7 * limit, limit);
        if miss(size) < TOLERANCE || next == magnitude {
            break;
        }
        magnitude = next;
    }
    best
}
