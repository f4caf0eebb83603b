//! The entry: records in, a system with its uncertainty out.

use super::data::{Data, Featured};
use super::doubt::Doubt;
use super::equation_error::Moments;
use super::error::FreeError;
use super::errors::{Errors, figures};
use super::examination::Examination;
use super::fit::{FitKind, Fitted, Ladder, refitted};
use super::halving::Places;
use super::input_noise::InputNoise;
use super::model::Model;
use super::normalise::{Figures, level_errors, normalise};
use super::problem::{Parameters, Segment, Structure};
use super::progress::Progress;
use super::rank_one::information;
use super::runs::Runs;
use super::selection::{Selection, select, with_best_rule};
use super::settings::Settings;
use super::simulation_error::Effort;
use super::undersmoothing::{GridFit, Undersmoothed, undersmoothed};
use super::units::OutputUnits;
use super::warning::Warning;
use crate::{BorderDistance, Estimate, LevelErrors};
use switchback_model::noise_model::noise_model;
use switchback_model::record::Record;
use switchback_model::reversal::Strokes;
use switchback_model::stray::screened;

/// What was identified, how it was chosen, and what speaks against it.
#[derive(Debug, Clone, PartialEq)]
pub struct Identified {
    /// Coefficients and borders with their standard errors, in the paper's normalisation. With two borders they come from a finer grid
    /// than the model's (see [`identify`]) and allow for what that one still leaves out.
    pub estimate: Estimate,
    /// Standard errors of the gain and the stationary outputs; none if a parameter has no information.
    pub level_errors: Option<LevelErrors>,
    /// The same system as a simulator.
    pub model: Model,
    /// How order, delay and knots were chosen.
    pub selection: Selection,
    /// How far the two borders lie apart against their errors; none for a model of one curve.
    pub distance: Option<BorderDistance>,
    /// Weak points.
    pub warnings: Vec<Warning>,
    /// Covariance of the model's coefficients `(a, b, f, c)`, row by row; absent where the records leave one of them open.
    pub covariance: Option<Vec<Vec<f64>>>,
    /// By how much noise found on the input moves the estimate; none where no noise was found, or the settings do not ask.
    pub input_noise: Option<InputNoise>,
}

/// Identifies a Hammerstein system from any records.
///
/// The output is centred and scaled first, so that the answer depends on neither its zero nor its unit:
///
/// 1. The branch at every sample is read off `v` ([`switchback_model::reversal::Branches`]).
/// 2. Whether reversals take effect at samples or between them is decided by the fit of a middling structure. Order, delay and knots are chosen by cross-validation where the settings leave them open.
/// 3. Least squares with one coefficient for every product `bᵢf_k`, drawn to rank one.
/// 4. With `refine`, Levenberg–Marquardt on the error of the free run. This is the model.
/// 5. With two borders, the same fit on grids of halved cells, twice at the most, until the bias that straight lines between knots leave is small against the noise. The
///    last of them is the estimate, at the model's knots: what predicts best is too coarse for an interval that holds the truth. What is left of
///    the bias joins the standard errors, and a point up to one cell beside a jump that was found gets an interval that spans both
///    sides. A jump below the noise is not found, and a point beside it may miss its truth.
///
/// 6. With `whiten`, step 5 once more on errors that an autoregressive model of the noise makes white, iterated with that model. Where the model of the system
///    is right this reaches the Cramér–Rao bound whatever the colour of the noise, and the two estimates differ by no more than the error of the
///    first. Where they differ by more, the model is wrong somewhere, what is reported depends on the filter, and the first is kept
///    (J. A. Hausman, Econometrica 46 (1978), doi 10.2307/1913827).
///
/// Where noise is found on the input, the fit is repeated on simulated records to see by how much it moves the estimate ([`InputNoise`]); neither estimate nor intervals
/// allow for it, a [`Warning::InputNoise`] shows.
///
/// Standard errors: without `refine` the equation error is taken as white; with it, each is the larger of the one for
/// white output errors and the one that the scatter of the gradient over batches of 128 samples gives, which allows for residuals of
/// any colour. Both take the structure as given and the branches as known.
///
/// # Errors
/// [`FreeError`] if there is nothing to identify from, or too little for the settings.
pub fn identify(records: &[&Record], settings: &Settings) -> Result<Identified, FreeError> {
    identify_watched(records, settings, &())
}

/// [`identify`], which shows how far it has come; the result does not depend on who hears.
///
/// # Errors
/// As [`identify`].
pub fn identify_watched(
    records: &[&Record],
    settings: &Settings,
    progress: &dyn Progress,
) -> Result<Identified, FreeError> {
    settings.check()?;
    let (records, stray) = screened(records);
    let units = OutputUnits::of(&records.iter().collect::<Vec<_>>());
    let centred: Vec<Record> = records.iter().map(|record| units.centred(record)).collect();
    let data = with_best_rule(Data::new(&centred.iter().collect::<Vec<_>>(), settings)?, settings);
    let (selection, found) = select(&data, settings, progress)?;
    let structure = selection.structure;
    let ladder = Ladder::new(&data, settings.input_map, selection.knots);
    let featured = ladder.top();
    let segments = featured.segments(structure);
    featured.basis.check_length(structure, &segments)?;
    let fitted = if settings.refine {
        let found = found.or_else(|| ladder.climb_from_smaller(structure));
        found.and_then(|found| featured.lifted(&found, &segments, Effort::FINAL))
    } else {
        ladder.one_shot(structure, &segments)
    };
    let theta = fitted.ok_or(FreeError::Unstable { order: structure.order })?.theta;
    let moments = Moments::of(structure, featured.basis.features(), &segments);
    let errors = if settings.refine {
        Errors::of_simulation(&moments, &theta, &Runs::new(segments.clone()), &[])
    } else {
        Errors::of_equation(&moments, &theta)
    };
    let basis = &featured.basis;
    let figures = figures(&moments, errors.variance, units);
    let mut estimate = normalise(&theta, structure, basis, errors.covariance.as_ref(), figures);
    let (information, covariance) = (&errors.information, errors.covariance.as_ref());
    let doubt = Doubt { structure, basis, theta: &theta, information, covariance, units };
    let hollow = estimate.hollow_coefficients();
    let hollow = hollow.map(|(coefficient, sum)| Warning::CarrierNotReported { coefficient, sum }).collect();
    let examined = examine(&data, featured, structure, &theta, &segments);
    let stray = stray.first().map(|&first| Warning::StraySamples { first, count: stray.len() });
    let mut warnings = [stray.into_iter().collect(), doubt.warnings(), hollow, examined].concat();
    let distance = doubt.distance();
    let mut level_errors = covariance.map(|covariance| level_errors(&theta, covariance, units));
    let mut reported =
        Fitted { structure, basis: basis.clone(), theta: theta.clone(), whitening: Vec::new() };
    let kind = if settings.refine { FitKind::Simulation } else { FitKind::Equation };
    if settings.undersmooth
        && basis.is_switched()
        && let Some(finer) = final_estimate(&data, &reported, (kind, settings.whiten), figures)
    {
        // The noise is that of the model's free run.
        estimate = Estimate { noise_sd: estimate.noise_sd, ..finer.estimate };
        level_errors = Some(finer.level_errors);
        let GridFit { basis, theta, whitening, .. } = finer.fit;
        reported = Fitted { structure, basis, theta, whitening };
    }
    let input_noise = settings
        .input_noise
        .then(|| InputNoise::of(&data, &reported, kind, settings.timing, &estimate, units))
        .flatten();
    warnings.extend(input_noise.and_then(|noise| noise.warning()));
    let covariance = covariance.map(|covariance| units.covariance(&theta, covariance.matrix()));
    let parameters = units.parameters(&theta);
    let model = Model { basis: basis.clone(), structure, parameters, rule: data.rule };
    Ok(Identified { estimate, level_errors, model, selection, distance, warnings, covariance, input_noise })
}

/// Each halving leaves a quarter of the bias of a smooth border. The grid that predicts best leaves about as much bias as noise, so that two
/// suffice; where more seem to be asked for, the border jumps, or something else is amiss that no grid mends.
const MOST_HALVINGS: usize = 2;

/// The estimate on ever finer grids. One that models the colour of the noise, where that is asked for, replaces the one that does not, unless it contradicts it.
fn final_estimate(
    data: &Data,
    start: &Fitted,
    (kind, whiten): (FitKind, bool),
    figures: Figures,
) -> Option<Undersmoothed> {
    let along = |kind| {
        undersmoothed(start.structure, figures, finer_fits(data, start.clone(), kind).take(1 + MOST_HALVINGS))
    };
    let plain = along(kind)?;
    let is_white = || {
        let featured = data.featured(start.basis.clone());
        let runs = Runs::new(featured.segments(start.structure));
        noise_model(&runs.residuals(start.structure, &start.theta)).is_empty()
    };
    if kind != FitKind::Simulation || !whiten || is_white() {
        return Some(plain);
    }
    let whitened = along(FitKind::Prewhitened);
    Some(
        whitened
            .filter(|whitened| plain.is_compatible_with(whitened, start.structure, figures))
            .unwrap_or(plain),
    )
}

/// The same fit on its own grid and on ever finer ones.
fn finer_fits(data: &Data, mut first: Fitted, kind: FitKind) -> impl Iterator<Item = GridFit> {
    let structure = first.structure;
    let visited: Vec<_> =
        data.records.iter().map(|(r, branches)| (r.v(), branches, branches.first_known()..r.len())).collect();
    let places = Places::of(&visited);
    if kind == FitKind::Prewhitened {
        let featured = data.featured(first.basis.clone());
        let runs = Runs::new(featured.segments(structure));
        (first.theta, first.whitening) = runs.prewhitened(structure, &first.basis, first.theta, Vec::new());
    }
    let mut start = Some(first);
    std::iter::from_fn(move || {
        let fitted = start.take()?;
        let fit = grid_fit(data, &fitted, kind)?;
        start = fitted.basis.halved_where_visited(&places, structure.numerator()).and_then(|finer| {
            let featured = data.featured(finer);
            let segments = featured.segments(structure);
            featured
                .basis
                .check_visits(&segments)
                .and(featured.basis.check_length(structure, &segments))
                .ok()?;
            refitted(&featured, &segments, &fitted, kind)
        });
        Some(fit)
    })
}

/// A fit with its errors and its information on the halved grid.
fn grid_fit(data: &Data, fitted: &Fitted, kind: FitKind) -> Option<GridFit> {
    let Fitted { structure, basis, theta, whitening } = fitted.clone();
    let featured = data.featured(basis.clone());
    let segments = featured.segments(structure);
    let moments = Moments::of(structure, basis.features(), &segments);
    let halved = data.featured(basis.halved());
    let on_halved = theta.on_basis(&basis, &halved.basis);
    let segments_on_halved = halved.segments(structure);
    let (errors, halved_information) = if kind != FitKind::Equation {
        let information = Runs::new(segments_on_halved).information(structure, &on_halved, &whitening);
        (Errors::of_simulation(&moments, &theta, &Runs::new(segments), &whitening), information)
    } else {
        let moments_on_halved = Moments::of(structure, halved.basis.features(), &segments_on_halved);
        (Errors::of_equation(&moments, &theta), information(&moments_on_halved, &on_halved))
    };
    Some(GridFit { basis, theta, errors, halved_information, whitening })
}

/// Collects the warnings.
fn examine(
    data: &Data,
    featured: &Featured,
    structure: Structure,
    theta: &Parameters,
    segments: &[Segment],
) -> Vec<Warning> {
    let visits = featured.basis.visits(segments);
    let reversals = data.records.iter().map(|(_, b)| b.reversals()).sum();
    let mut strokes = Strokes::default();
    data.records.iter().for_each(|(record, branches)| strokes.add(record.v(), branches));
    let (noise, threshold, range) = (data.noise, data.rule.threshold, data.interval.width());
    let (basis, stroke) = (&featured.basis, strokes.only_one());
    Examination { basis, structure, theta, noise, threshold, range, reversals, stroke, visits }.warnings()
}
