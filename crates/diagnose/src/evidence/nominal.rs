//! The nominal system of a rig: identified, with border knots at the levels of a designed input.

use switchback_identify::free::{FreeError, InputMap, Settings, identify};
use switchback_identify::record::{Criterion, Effort, Sensitivities, Stretch, bare_system, fit};
use switchback_model::Record;
use switchback_model::hysteresis::Branch;
use switchback_model::system::{Borders, Mode, Quantity, Scale, System, Term};

/// Iterations of a fit.
const EFFORT: Effort = Effort { iterations: 20, tolerance: 1e-3 };

/// Order and delay, samples beyond the one of the paper's model, each where it is known: whoever declares an order declares no further delay.
pub(crate) type Known = (Option<usize>, Option<isize>);

/// The system without effects that runs as these records do. None where it has no gain at rest.
///
/// # Errors
/// [`FreeError`] where the records show no model.
pub(crate) fn nominal(records: &[&Record], (order, delay): Known) -> Result<Option<System>, FreeError> {
    let Some(system) = settled(records, (order, delay))? else { return Ok(None) };
    let records = Records::of(records);
    Ok(Some(match levels(&records.pairs) {
        Some(levels) => records.at_levels(&system, &levels).unwrap_or(system),
        None => system,
    }))
}

/// The system that runs as these records do with a term which moves the position, identified behind that; of a known order where it is given.
///
/// # Errors
/// As [`nominal`].
pub(crate) fn behind(
    records: &[&Record],
    term: &Term,
    order: Option<usize>,
) -> Result<Option<System>, FreeError> {
    let moved = |record: &&Record| {
        let mut position = record.v().to_vec();
        term.law.position(&term.values, &mut position);
        Record::new(position, record.y().to_vec()).expect("as many finite values")
    };
    let moved: Vec<Record> = records.iter().map(moved).collect();
    let system = settled(&moved.iter().collect::<Vec<_>>(), (order, None))?;
    Ok(system.map(|system| System { terms: vec![term.clone()], ..system }))
}

/// The identified system, without poles that settle in no record.
fn settled(records: &[&Record], (order, delay): Known) -> Result<Option<System>, FreeError> {
    let settings = Settings {
        order,
        delay,
        whiten: false,
        undersmooth: false,
        input_noise: false,
        ..Settings::new(InputMap::Borders)
    };
    let system = bare_system(&identify(records, &settings)?.model);
    Ok(system.map(|system| Records::of(records).without_what_outlasts(system)))
}

/// Records that a system is fitted to.
struct Records<'a> {
    pairs: Vec<(&'a [f64], &'a [f64])>,
    stretches: Vec<Stretch>,
}

impl<'a> Records<'a> {
    fn of(records: &[&'a Record]) -> Self {
        let pairs: Vec<(&[f64], &[f64])> = records.iter().map(|r| (r.v(), r.y())).collect();
        let stretches = Stretch::all(&pairs);
        Self { pairs, stretches }
    }

    /// Fits borders and linear part by the free run's error; with the deviance of that under the criterion of the start.
    fn fit(&self, start: &System, criterion: &Criterion) -> (System, f64) {
        let scale = Scale::of(&start.linear, start.rule, &self.pairs);
        fit(start, &Quantity::coordinates(start), &self.stretches, (criterion, &scale), EFFORT)
    }

    fn criterion(&self, system: &System) -> Criterion {
        let error = |s: &Stretch| s.simulate(system).iter().zip(&s.y).map(|(run, y)| y - run).collect();
        let errors: Vec<Vec<f64>> = self.stretches.iter().map(error).collect();
        Criterion { filter: Vec::new(), ..Criterion::of(&errors) }
    }

    /// Without real poles that settle in no record: such a pole follows whatever changes slowly, and its initial state takes any offset.
    fn without_what_outlasts(&self, mut system: System) -> System {
        let longest = self.pairs.iter().map(|(v, _)| v.len()).max().unwrap_or(0) as f64;
        // An order is lower each time.
        for _ in 0..=system.linear.modes().len() {
            let Some(fewer) = without_the_slowest(&system, longest) else { break };
            let criterion = self.criterion(&fewer);
            system = self.fit(&fewer, &criterion).0;
        }
        system
    }

    /// The same with knots at the levels, fitted to the records.
    fn at_levels(&self, system: &System, levels: &[f64]) -> Option<System> {
        let (low, high) = system.borders.range();
        let table = |branch: Branch| -> Vec<(f64, f64)> {
            let side = if branch == Branch::Ascending { 1.0 } else { -1.0 };
            let is_apart = |v: &f64| levels.iter().all(|level| (v - level).abs() > APART * (high - low));
            let own = system.borders.points(branch).map(|(v, _)| v).filter(is_apart);
            let mut knots: Vec<f64> = levels.iter().copied().chain(own).collect();
            knots.sort_by(f64::total_cmp);
            let value = |v: f64| {
                let (mean, half) = system.borders.at(v);
                (v, mean + side * half)
            };
            knots.into_iter().map(value).collect()
        };
        let borders = Borders::new(&table(Branch::Descending), &table(Branch::Ascending))?;
        let start = System { borders, ..system.clone() };
        let criterion = self.criterion(system);
        let before = Sensitivities::deviance(system, &self.stretches, &criterion);
        let (fitted, after) = self.fit(&start, &criterion);
        (after < before).then_some(fitted)
    }
}

/// The system without a real pole that outlasts a number of samples.
fn without_the_slowest(system: &System, samples: f64) -> Option<System> {
    let modes = system.linear.modes();
    let outlasts = |m: &Mode| m.time_constant().is_some_and(|tau| tau > samples);
    let at = modes.iter().position(outlasts)?;
    let smaller = match modes.len() {
        // Without any pole there is no linear part: the only one becomes one that settles.
        1 => system.linear.with_modes(&[Mode::Real(libm::exp(-10.0 / samples))]),
        _ => system.linear.smaller().into_iter().nth(at)?,
    };
    Some(System { linear: smaller, ..system.clone() })
}

/// Levels of an input that is designed, at most.
const MOST_LEVELS: usize = 80;
/// Samples that lie on a level, at least: so many, and this share of all.
const LEAST_SAMPLES: f64 = 5.0;
const LEAST_SHARE: f64 = 0.002;
/// Knots are no nearer to a level than this share of the range.
const APART: f64 = 0.01;

/// The levels at which the input rests; none where it never does, or at so many that no design has them.
fn levels(records: &[(&[f64], &[f64])]) -> Option<Vec<f64>> {
    let mut values: Vec<f64> = records.iter().flat_map(|(v, _)| v.iter().copied()).collect();
    values.sort_by(f64::total_cmp);
    let near = 1e-9 * (values.last()? - values.first()?);
    let least = f64::max(LEAST_SAMPLES, LEAST_SHARE * values.len() as f64);
    let same = values.chunk_by(|x, y| y - x <= near);
    let levels: Vec<f64> = same.filter(|same| same.len() as f64 >= least).map(|same| same[0]).collect();
    (3..=MOST_LEVELS).contains(&levels.len()).then_some(levels)
}
