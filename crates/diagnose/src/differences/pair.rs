//! The comparison itself.

use super::errors::{carrying_without_initial_state, errors, run_from_the_state_of};
use super::rows::{Row, rows};
use super::selection::{Context, Difference, with};
use super::source::Source;
use super::surrogate::SMALL_MISFIT;
use crate::evidence::nominal;
use crate::workers::{Serial, Workers};
use switchback_identify::free::FreeError;
use switchback_identify::record::{Criterion, Stretch};
use switchback_model::Record;
use switchback_model::alignment::{Alignment, align, regression};
use switchback_model::stray::screened;
use switchback_model::sums::mean_over_pieces;
use switchback_model::system::{Quantity, Scale, System};

/// A record of the machine.
#[derive(Debug, Clone, Copy)]
pub struct MachineRecord<'a> {
    /// Input and measured output.
    pub record: &'a Record,
    /// The prediction of the source, one value a sample, where it is known.
    pub predicted: Option<&'a [f64]>,
    /// Whether differences are fitted to it.
    pub is_fitted: bool,
}

/// Differences between a machine and a source.
#[derive(Debug, Clone, PartialEq)]
pub struct Differences {
    /// Every quantity on both sides: those that differ first.
    pub rows: Vec<Row>,
    /// The system that stands for the source.
    pub source: System,
    /// The same with the values of the machine.
    pub aligned: System,
    /// Standard deviation of the filtered error that is left, output units.
    pub noise: f64,
    /// For every record of the machine the run of the source and that of the aligned one.
    pub runs: Vec<[Vec<f64>; 2]>,
    /// Records that were not fitted and differ from those that were.
    pub shifts: Vec<Shift>,
    /// The ground of the verdict.
    pub basis: Basis,
}

/// The ground of a verdict on a source.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Basis {
    /// The differences.
    Differences,
    /// The posterior on the source's errors: no few differences align it.
    Errors,
    /// The diagnosis of the machine's own nominal model: the source runs as this does, and no few differences align it.
    Nominal,
}

/// A record whose output lies beside the aligned run of the source by a constant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shift {
    /// Number of the record.
    pub record: usize,
    /// Mean error of the aligned run, output units.
    pub offset: f64,
    /// Its standard error.
    pub se: f64,
}

/// Rounds of selection at most, each with the noise model of the errors that the last one left.
const ROUNDS: usize = 3;

/// Compares a machine with a source. None where the machine or the source has no gain at rest, so that no system of the kind describes it.
///
/// # Errors
/// [`FreeError`] where one of both sides cannot be identified.
pub fn compare(machine: &[MachineRecord<'_>], source: &Source) -> Result<Option<Differences>, FreeError> {
    compare_with(&Serial, machine, source)
}

/// [`compare`], its independent pieces of work given to `workers`; the answer does not depend on them.
///
/// # Errors
/// As [`compare`].
pub fn compare_with(
    workers: &impl Workers,
    machine: &[MachineRecord<'_>],
    source: &Source,
) -> Result<Option<Differences>, FreeError> {
    let (screened, _) = screened(&machine.iter().map(|m| m.record).collect::<Vec<_>>());
    let all = Stretch::all(&screened.iter().map(|r| (r.v(), r.y())).collect::<Vec<_>>());
    let is_used =
        |m: &MachineRecord<'_>| m.is_fitted && (*source != Source::Predictions || m.predicted.is_some());
    let used: Vec<usize> = (0..machine.len()).filter(|&k| is_used(&machine[k])).collect();
    let fitted: Vec<&Record> = used.iter().map(|&k| &screened[k]).collect();
    let Some(own) = nominal(&fitted, (None, None))? else { return Ok(None) };
    let plain: Vec<Stretch> = used.iter().map(|&k| all[k].clone().behind_earlier_inputs(&own, 0)).collect();
    let criterion = Criterion { filter: Vec::new(), sd: Criterion::of(&errors(&own, &plain)).sd };
    let predicted: Vec<Record> = used
        .iter()
        .filter_map(|&k| Record::new(screened[k].v().to_vec(), machine[k].predicted?.to_vec()).ok())
        .collect();
    let outputs: Vec<(&[f64], &[f64])> = fitted.iter().zip(&predicted).map(|(m, p)| (m.y(), p.y())).collect();
    // A sign or a unit is no small change: the prediction shows it before anything is fitted.
    let aligned = align(&outputs);
    let noise = criterion.sd / aligned.map_or(1.0, |a| a.factor.abs().max(f64::MIN_POSITIVE));
    let Some(found) = source.identified(workers, &predicted, noise)? else { return Ok(None) };
    let inputs = all.iter().flat_map(|s| s.v.iter());
    let range = inputs.fold((f64::MAX, f64::MIN), |(low, high), v| (low.min(*v), high.max(*v)));
    let base = found.base(own.rule, range);
    // A machine that is later than the source depends on earlier inputs for as long.
    let later = aligned.map_or(0, |a| a.delay.max(0).unsigned_abs());
    let predicted_of = |k: usize| machine[k].predicted.filter(|_| found.is_carried);
    let stretch_for = |k: usize, system: &System| {
        let own = all[k].clone().behind_earlier_inputs(&base, later);
        let carrying = predicted_of(k).map(|p| carrying_without_initial_state(&own, &base, p));
        carrying.unwrap_or(own).behind_earlier_inputs(system, later)
    };
    let stretches_for = |system: &System| used.iter().map(|&k| stretch_for(k, system)).collect();
    let scale =
        Scale::of(&base.linear, base.rule, &plain.iter().map(|s| (&s.v[..], &s.y[..])).collect::<Vec<_>>());
    let samples = plain.iter().map(|s| s.v.len()).sum();
    let mut context = Context {
        workers,
        base: &base,
        stretches: stretches_for(&base),
        criterion,
        scale: &scale,
        samples,
        misfit: found.misfit(noise).max(SMALL_MISFIT * samples as f64),
    };
    let mut selected = context.select(start(regression(&outputs, 0), aligned));
    for _ in 1..ROUNDS {
        let (aligned, _) = with(&base, &selected.differences);
        context.stretches = stretches_for(&aligned);
        context.criterion = Criterion::of(&errors(&aligned, &context.stretches));
        let before = selected;
        selected = context.reselect(&before.differences);
        if selected.is_of_the_kinds_of(&before) {
            break;
        }
    }
    let rows = rows(&context, &selected, &found);
    let (aligned, _) = with(&base, &selected.differences);
    let noise = Criterion::of(&errors(&aligned, &context.stretches)).sd;
    let run_of_the_source = |k: usize| {
        predicted_of(k).map_or_else(|| all[k].clone(), |p| all[k].carrying(&base, p)).simulate(&base)
    };
    let runs: Vec<[Vec<f64>; 2]> = (0..machine.len())
        .map(|k| [run_of_the_source(k), run_from_the_state_of(&stretch_for(k, &aligned), &aligned)])
        .collect();
    let shifts = (0..machine.len())
        .filter(|k| !machine[*k].is_fitted)
        .filter_map(|k| shift(k, screened[k].y(), &runs[k][1], noise))
        .collect();
    Ok(Some(Differences {
        rows,
        source: found.system,
        aligned,
        noise,
        runs,
        shifts,
        basis: Basis::Differences,
    }))
}

/// The differences from which a selection starts: a factor far from one, where the regression on the prediction finds it.
fn start(now: Option<Alignment>, best: Option<Alignment>) -> Vec<Difference> {
    let far = now.and(best).filter(|best| !(0.2..5.0).contains(&best.factor));
    far.map(|best| Difference::Quantity(Quantity::Gain, best.factor)).into_iter().collect()
}

/// Pieces of a record whose means are compared; Student's quantile of 19 degrees of freedom at a two-sided level of 10⁻³.
const PIECES: usize = 20;
const BEYOND_CHANCE: f64 = 3.88;

/// The mean error of a record, where it is beyond chance by its scatter over pieces, and as large as a tenth of the noise.
fn shift(record: usize, y: &[f64], run: &[f64], noise: f64) -> Option<Shift> {
    let errors: Vec<f64> = y.iter().zip(run).map(|(y, run)| y - run).collect();
    let (offset, se) = mean_over_pieces(&errors, PIECES)?;
    (offset.abs() > BEYOND_CHANCE * se && offset.abs() > 0.1 * noise).then_some(Shift { record, offset, se })
}
