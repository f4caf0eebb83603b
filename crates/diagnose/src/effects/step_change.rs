//! The gain or the distance of the borders changes at one instant.
//!
//! ```text
//! A y = (1 + g·h(t))·B (u + u₀)                        the gain
//! u = (1 − w·h/2)·C(v) + (w·h/2)·C_other(v)            the loop between the borders
//! h = 0 before the instant, 1 after it, straight over a short ramp between
//! ```
//!
//! `u₀` as in a gain that drifts: the output's zero is unknown. Starts: the instants at which the errors of the known model change most as `g` or
//! `w` would change them, each with the size seen there, of all instants; and large changes between records. The instant costs `ln N` of
//! deviance beyond its place among the parameters, as it was chosen among all (N. R. Zhang and D. O. Siegmund, "A modified Bayes
//! information criterion with applications to the analysis of array comparative genomic hybridization data", Biometrics 63, 2007).
//!
//! Records differ in more than their time: one alone on its side of a change has whatever its own input makes of an inexact law. So the change falls
//! well within a record, or between records of which two at least lie on either side.
//!
//! Parameters: change `g` of the gain (−0.95…4) or narrowing `w` of the loop (−1.5…1.5), `instant` in samples of the dataset, the middle of a
//! `ramp` of 1 sample to [`LONGEST`] of the dataset. Reported: the record by its number, the sample and the time in it, the change in per cent. Stage: operator.
//! Left by a setting of the actuator that somebody changed, a belt that slipped, a bolt that came loose. Confused with: gain drift, border wear.

use super::gain_drift::{drift, turns_about_an_output};
use super::{Card, Reading, Scene, Variant, known, parameter};
use crate::effect::{Effect, Stage};
use crate::fitted_parameter::FittedParameter;
use crate::likelihood::design::Design;
use crate::likelihood::engine::{Fit, NonlinearParameter};
use crate::model::augmented::{AugmentedModel, Clock, Slow};
use crate::records::dataset::Dataset;
use switchback_model::change_point::{ChangePoint, change_points, likeliest};

pub(super) const CARD: Card = Card {
    confounded_effects: &[Effect::GainDrift, Effect::BorderWear],
    of_its_record: true,
    dominates_dynamics: true,
    reported_first: when_and_how_much,
    ..Card::of(Stage::Operator, variants)
};

/// What changes: its name and the bounds of the change.
struct Changing {
    name: &'static str,
    bounds: (f64, f64),
}

const GAIN: Changing = Changing { name: "gain_step", bounds: (-0.95, 4.0) };
const LOOP: Changing = Changing { name: "loop_narrowing", bounds: (-1.5, 1.5) };

/// The name of the instant.
const INSTANT: &str = "instant";

/// Boundaries between records from which a search starts, and sizes there: borders in which every record has refinements of its own may have
/// taken all of a change between records, so that the errors show nothing of it.
const BOUNDARIES: usize = 4;
const SIZES: [f64; 2] = [-0.5, 0.5];

/// Instants from which a search starts, and how far apart they are, as a share of the samples.
const INSTANTS: usize = 3;
const APART: f64 = 0.02;
/// Length of a ramp in the beginning, samples: the next instant is found from half of it away. And the longest, as a share of the
/// dataset: what takes longer is a drift.
const RAMP: f64 = 8.0;
const LONGEST: f64 = 0.02;

fn variants(scene: &Scene<'_>) -> Vec<Variant> {
    let gain = |augmented: &mut AugmentedModel, step| augmented.gain = Some(step);
    let wear = |augmented: &mut AugmentedModel, step| augmented.wear = Some(step);
    let penalty = (scene.fit.samples.max(1) as f64).ln();
    let law = |starts: Vec<Vec<NonlinearParameter>>, apply: fn(&mut AugmentedModel, Slow)| {
        let law = Variant::new(starts, move |p, augmented| apply(augmented, step(p)));
        Variant { size_penalty: penalty, ..law }
    };
    let laws = [
        law(starts(scene, &GAIN, gain), drift)
            .sound_if(|own, fit| turns_about_an_output(own, fit) && is_within_its_range(fit)),
        law(starts(scene, &LOOP, wear), wear).sound_if(|_, fit| is_within_its_range(fit)),
    ];
    laws.into_iter().filter(|law| !law.starts.is_empty()).collect()
}

/// A change by `size` over a ramp, given `[size, instant, ramp]`.
fn step(p: &[f64]) -> Slow {
    let &[size, instant, ramp] = p else { return Slow::on(Clock::Samples) };
    let bends = vec![(instant - 0.5 * ramp, 0.0), (instant + 0.5 * ramp, size)];
    Slow { bends, ..Slow::on(Clock::Samples) }
}

/// Share of a record that must lie on either side of a change in it: among the trimmings that J. Bai and P. Perron tabulate ("Computation and
/// analysis of multiple structural change models", J. Applied Econometrics 18, 2003).
const MARGIN: f64 = 0.1;
/// Records on either side of a change between records at least.
const RECORDS: usize = 2;

/// Where a change may be distinguished from what differs between records: ranges of the dataset's samples.
fn ranges(dataset: &Dataset) -> Vec<(f64, f64)> {
    let count = dataset.fit().count();
    let mut ranges: Vec<(f64, f64)> = Vec::new();
    for (before, scaled) in dataset.fit().enumerate() {
        let at = |share: f64| scaled.clock as f64 + share * scaled.v.len() as f64;
        let end = at(1.0 - MARGIN);
        match ranges.last_mut() {
            Some(range) if before >= RECORDS && count - before >= RECORDS => range.1 = end,
            _ => ranges.push((at(MARGIN), end)),
        }
    }
    ranges
}

/// Whether the instant lies within its range: at an end, it is beyond.
fn is_within_its_range(fit: &Fit) -> bool {
    let mut instants = fit.nonlinear.iter().filter(|o| o.name == INSTANT);
    instants.all(|o| o.low < o.value && o.value < o.high)
}

/// Size of a change that probes what the errors would be after it.
const PROBE: f64 = 1e-3;

/// Starts of what `apply` changes: the instants at which the errors change most as that would change them.
fn starts(
    scene: &Scene<'_>,
    changing: &Changing,
    apply: impl Fn(&mut AugmentedModel, Slow),
) -> Vec<Vec<NonlinearParameter>> {
    let fit = scene.fit;
    let mut augmented = fit.augmented.clone();
    apply(&mut augmented, Slow { bends: vec![(0.0, PROBE)], ..Slow::on(Clock::Samples) });
    let design = Design::like(Some(fit.near()), scene.dataset, &fit.grid, &augmented);
    let probed = design.innovations(&fit.linear, &design.whitener(&augmented.noise, &fit.linear.a));
    let (mut errors, mut slopes, mut clocks) = (Vec::new(), Vec::new(), Vec::new());
    let mut firsts_of_records = Vec::new();
    for ((scaled, w), probed) in scene.dataset.fit().zip(scene.innovations).zip(&probed) {
        errors.extend(w);
        firsts_of_records.push(errors.len() - w.len());
        slopes.extend(w.iter().zip(probed).map(|(w, probed)| (probed - w) / PROBE));
        clocks.extend((0..w.len()).map(|k| (scaled.clock + scaled.from + k) as f64));
    }
    let longest = (LONGEST * scene.dataset.total as f64).max(2.0 * RAMP);
    let apart = ((APART * errors.len() as f64) as usize).max(1);
    let ranges = ranges(scene.dataset);
    let range =
        |at: usize| ranges.iter().find(|(low, high)| (*low..*high).contains(&(clocks[at] - 0.5))).copied();
    let bounds = changing.bounds;
    let start = |at: usize, size: f64| {
        let range = range(at).unwrap_or_default();
        vec![
            parameter(changing.name, "1", size.clamp(0.9 * bounds.0, 0.9 * bounds.1), bounds, 0.001),
            parameter(INSTANT, "samples of the dataset", clocks[at] - 0.5, range, 0.5),
            parameter("ramp", "samples", RAMP, (1.0, longest), 0.5),
        ]
    };
    let mut all = change_points(&errors, &slopes);
    all.retain(|point| range(point.at).is_some());
    let between: Vec<ChangePoint> =
        all.iter().filter(|p| firsts_of_records.contains(&p.at)).copied().collect();
    // What the errors have, the law takes away.
    let seen = likeliest(&all, INSTANTS, apart).into_iter().map(|point| start(point.at, -point.change));
    let between = likeliest(&between, BOUNDARIES, 1).into_iter();
    seen.chain(between.flat_map(|point| SIZES.map(|size| start(point.at, size)))).collect()
}

/// Where the change begins to act, and by how many per cent.
fn when_and_how_much(reading: &Reading<'_>) -> Vec<FittedParameter> {
    let [size, instant, _] = reading.searched else { return Vec::new() };
    let (number, sample) = place(reading.dataset, instant.value);
    let [low, high] = size.ci90.map(|end| 100.0 * end);
    let (name, value, ci90) = match size.name {
        name if name == LOOP.name => ("loop_change", -100.0 * size.value, [-high, -low]),
        _ => ("gain_change", 100.0 * size.value, [low, high]),
    };
    vec![
        FittedParameter { name, unit: "%", value, ci90 },
        known("record", "count", (number + 1) as f64),
        known("sample_in_record", "count", sample as f64),
        known("time_in_record", "s", sample as f64 * reading.dataset.sample_time),
    ]
}

/// Number of the record, and sample in it, that is the first after an instant of the dataset.
fn place(dataset: &Dataset, instant: f64) -> (usize, usize) {
    let first = instant.ceil().max(0.0) as usize;
    let number = dataset.scaled_records.partition_point(|scaled| scaled.clock <= first).saturating_sub(1);
    (number, first - dataset.scaled_records[number].clock)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::attribution::SIGNIFICANT;
    use crate::effects::tests::{HALF, explained, loop_of, measured};
    use crate::records::dataset::ScaledRecord;

    /// The parameters reported for a change of a known kind, by the laws of the effect.
    fn reported(augmented: &AugmentedModel) -> Vec<FittedParameter> {
        let dataset = measured(augmented, &loop_of(HALF, &[]));
        let (best, gain) = explained(&dataset, Effect::StepChange).expect("a fit");
        assert!(gain > SIGNIFICANT, "{gain}");
        let intervals = best.fit.intervals();
        let searched = best.fit.nonlinear.iter().zip(intervals);
        let searched: Vec<FittedParameter> = searched
            .map(|(o, ci90)| FittedParameter { name: o.name, unit: o.unit, value: o.value, ci90 })
            .collect();
        when_and_how_much(&Reading { dataset: &dataset, fit: &best.fit, searched: &searched })
    }

    fn at_130(size: f64) -> Slow {
        step(&[size, 129.5, 1.0])
    }

    #[test]
    fn a_step_is_nothing_before_its_instant_and_all_after_it() {
        let step = at_130(0.3);
        assert_eq!([0.0, 129.0, 130.0, 999.0].map(|t| step.at(t)), [0.0, 0.0, 0.3, 0.3]);
    }

    /// The oracle: the machine that the records were made with.
    #[test]
    fn instant_and_size_are_those_of_the_machine() {
        let gain = AugmentedModel { gain: Some(at_130(0.25)), ..AugmentedModel::default() };
        let narrower = AugmentedModel { wear: Some(at_130(0.4)), ..AugmentedModel::default() };
        for (augmented, name, percent) in [(gain, "gain_change", 25.0), (narrower, "loop_change", -40.0)] {
            let reported = reported(&augmented);
            assert_eq!(reported[0].name, name);
            assert!((reported[0].value / percent - 1.0).abs() < 0.05, "{reported:?}");
            assert_eq!(reported[1].value, 1.0);
            assert!((reported[2].value - 130.0).abs() <= 2.0, "{reported:?}");
        }
    }

    #[test]
    fn a_record_alone_on_its_side_shows_nothing_of_a_change_beside_it() {
        let mut dataset = measured(&AugmentedModel::default(), &loop_of(HALF, &[]));
        let record = dataset.scaled_records.remove(0);
        let taken = |count: usize| {
            let scaled_records = (0..count).map(|k| ScaledRecord { clock: 240 * k, ..record.clone() });
            ranges(&Dataset { scaled_records: scaled_records.collect(), ..dataset.clone() })
        };
        assert_eq!(taken(1), [(24.0, 216.0)]);
        assert_eq!(taken(2), [(24.0, 216.0), (264.0, 456.0)]);
        assert_eq!(taken(5), [(24.0, 216.0), (264.0, 936.0), (984.0, 1176.0)]);
    }

    #[test]
    fn an_instant_is_reported_by_record_and_sample() {
        let mut dataset = measured(&AugmentedModel::default(), &loop_of(HALF, &[]));
        let mut second = dataset.scaled_records[0].clone();
        second.clock = 240;
        dataset.scaled_records.push(second);
        assert_eq!(place(&dataset, 239.5), (1, 0));
        assert_eq!(place(&dataset, 239.0), (0, 239));
        assert_eq!(place(&dataset, 300.2), (1, 61));
    }
}
