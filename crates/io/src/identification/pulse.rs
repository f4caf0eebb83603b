//! Methods for the designed experiments of a rig.

use super::simulate::EstimatedSystem;
use super::{Examination, Flag, Found, Identification, IdentificationError, Method};
use crate::model::Points;
use switchback_identify::free::Warning;
use switchback_identify::pulse::{PulseData, PulseDataError, PulseFit, PulseMethod, StepMean};
use switchback_identify::{BorderDistance, Estimate};
use switchback_model::hysteresis::{Branch, Interval};
use switchback_model::linear::{is_stable, settling_samples, spectral_radius};
use switchback_model::rig::{Rig, RigRecord, Role};

/// Orders tried where the rig file names none.
const ORDERS: std::ops::RangeInclusive<usize> = 1..=6;

/// The share of a step's transient that may remain when its mean is taken.
const SETTLED: f64 = 1e-4;

/// A method for the designed experiments of a rig.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Designed {
    PaperDescendant,
    PaperAscendant,
    Joint,
    Efficient,
    Instrumental,
}

impl Designed {
    fn method(self) -> Method {
        match self {
            Self::PaperDescendant => Method::PaperDescendant,
            Self::PaperAscendant => Method::PaperAscendant,
            Self::Joint => Method::Joint,
            Self::Efficient => Method::Efficient,
            Self::Instrumental => Method::Instrumental,
        }
    }
}

/// Identifies from the pulse experiments among the fit records.
pub(super) fn identify(rig: &Rig, designed: Designed) -> Result<Identification, IdentificationError> {
    let method = designed.method();
    let records = experiments(rig, designed)?;
    let mut flags = Vec::new();
    let order = match rig.order {
        Some(order) => order,
        None => {
            let order = chosen_order(rig, designed, &records)?;
            let text = format!(
                "order {order} was chosen from the data (least BIC); set `order` in the rig file if it is known"
            );
            flags.push(Flag::new("order_chosen", order as f64, text));
            order
        }
    };
    let mut data = read(rig, method, &records, order, 0)?;
    if designed == Designed::Instrumental {
        let settling = settling(rig, method, &data)?;
        data = read(rig, method, &records, order, settling)?;
    }
    let data: Vec<&PulseData> = data.iter().collect();
    let (fit, covariance) = fit(rig, designed, &data)?;
    let estimate = fit.estimate(&data);
    let covariance = by_position(covariance, &data);
    if data.len() == 1 {
        let border = match data[0].branch {
            Branch::Descending => "descending",
            Branch::Ascending => "ascending",
        };
        flags.push(Flag {
            kind: "one_border",
            figure: None,
            text: format!("one experiment shows the {border} border only; records that run on the other cannot be simulated"),
        });
    }
    let distance = estimate.distance_at_common_points();
    flags.extend(doubts(&estimate, distance).iter().map(Flag::from));
    let (one, other) = (data[0].satellite, data[0].levels[0]);
    let interval =
        Interval::new(one.min(other), one.max(other)).map_err(|error| IdentificationError::Refused {
            rig: rig.name.clone(),
            method,
            reason: error.to_string(),
            remedy: format!("check the column of the input, `{}`", rig.input_label),
        })?;
    let system =
        EstimatedSystem::new(&estimate, interval).map_err(|reason| IdentificationError::Refused {
            rig: rig.name.clone(),
            method,
            reason: format!(
                "{reason} (largest pole {:.3}), so every free run diverges",
                spectral_radius(&estimate.a)
            ),
            remedy: "try a lower `order`, a longer record, or `--method free`".to_owned(),
        })?;
    let runs = rig.records.iter().map(|record| system.run(&record.record)).collect();
    let examination = Examination::default();
    let level_errors = Some(fit.level_errors);
    let obstacles = Vec::new();
    let model = Points::of(&estimate, interval, Some(covariance)).ok().map(Found::Points);
    Ok(Identification {
        method,
        estimate,
        level_errors,
        runs,
        distance,
        input_noise: None,
        obstacles,
        flags,
        examination,
        model,
    })
}

/// What the errors of an estimate say against it.
fn doubts(estimate: &Estimate, distance: Option<BorderDistance>) -> Vec<Warning> {
    let vanished = distance.filter(BorderDistance::has_vanished);
    let hollow = estimate.hollow_coefficients();
    let hollow = hollow.map(|(coefficient, sum)| Warning::CarrierNotReported { coefficient, sum });
    vanished.map(|distance| Warning::LoopVanished { distance }).into_iter().chain(hollow).collect()
}

/// The covariance of `a`, `b` and the points in the order of the experiments as that of `a`, `b` and the points by border, the descending
/// one first, and by increasing `v`: the order of an [`Estimate`](switchback_identify::Estimate).
fn by_position(covariance: Vec<Vec<f64>>, data: &[&PulseData]) -> Vec<Vec<f64>> {
    let points: Vec<(bool, f64)> =
        data.iter().flat_map(|d| d.levels.iter().map(move |&v| (d.branch == Branch::Ascending, v))).collect();
    let coefficients = covariance.len() - points.len();
    let mut order: Vec<usize> = (0..points.len()).collect();
    order.sort_by(|&i, &j| points[i].0.cmp(&points[j].0).then(points[i].1.total_cmp(&points[j].1)));
    let order: Vec<usize> = (0..coefficients).chain(order.into_iter().map(|k| coefficients + k)).collect();
    order.iter().map(|&i| order.iter().map(|&j| covariance[i][j]).collect()).collect()
}

/// The fit records that the method works on: the longest of each role it needs.
fn experiments(rig: &Rig, designed: Designed) -> Result<Vec<&RigRecord>, IdentificationError> {
    let method = designed.method();
    let missing = |needed| IdentificationError::MissingExperiment { rig: rig.name.clone(), method, needed };
    let descendant = || longest(rig, Role::Descendant).ok_or_else(|| missing("a `descendant` record"));
    let ascendant = || longest(rig, Role::Ascendant).ok_or_else(|| missing("an `ascendant` record"));
    match designed {
        Designed::PaperDescendant => Ok(vec![descendant()?]),
        Designed::PaperAscendant => Ok(vec![ascendant()?]),
        Designed::Joint => Ok(vec![descendant()?, ascendant()?]),
        Designed::Efficient | Designed::Instrumental => {
            let found: Vec<_> = descendant().into_iter().chain(ascendant()).collect();
            if found.is_empty() { Err(missing("a `descendant` or an `ascendant` record")) } else { Ok(found) }
        }
    }
}

fn longest(rig: &Rig, role: Role) -> Option<&RigRecord> {
    rig.fit_records().filter(|record| record.role == role).max_by_key(|record| record.record.len())
}

fn read(
    rig: &Rig,
    method: Method,
    records: &[&RigRecord],
    order: usize,
    settling: usize,
) -> Result<Vec<PulseData>, IdentificationError> {
    records
        .iter()
        .map(|record| {
            pulse_data(record, order, settling).map_err(|error| IdentificationError::Refused {
                rig: rig.name.clone(),
                method,
                reason: format!("record {}: {error}", record.name),
                remedy: "give the record its true `role`, or choose `--method free`, which takes any record"
                    .to_owned(),
            })
        })
        .collect()
}

/// Beside `settling` samples nothing but the lag window is left out: regression on measured lags needs no settled start.
fn pulse_data(record: &RigRecord, order: usize, settling: usize) -> Result<PulseData, PulseDataError> {
    let branch = match record.role {
        Role::Ascendant => Branch::Ascending,
        _ => Branch::Descending,
    };
    PulseData::from_record(&record.record, branch, order, settling)
}

/// Samples until the response of the estimated `A` repeats from period to period: what lies before is in no mean over periods.
fn settling(rig: &Rig, method: Method, data: &[PulseData]) -> Result<usize, IdentificationError> {
    let refused = |reason: String| IdentificationError::Refused {
        rig: rig.name.clone(),
        method,
        reason,
        remedy: "try a lower `order`, a longer record, or `--method efficient`".to_owned(),
    };
    let first = PulseMethod::Efficient(&data.iter().collect::<Vec<_>>()).fit();
    let first = first.map_err(|error| refused(error.to_string()))?;
    let a: Vec<f64> = first.a.iter().map(|x| x.value).collect();
    if !is_stable(&a) {
        return Err(refused("the estimated A is unstable, so the response never repeats".to_owned()));
    }
    Ok(settling_samples(&a, SETTLED))
}

/// The order of least `N ln σ² + p ln N` of the rank-one constrained fit.
fn chosen_order(rig: &Rig, designed: Designed, records: &[&RigRecord]) -> Result<usize, IdentificationError> {
    let criterion = |order: usize| -> Option<f64> {
        let data: Vec<PulseData> =
            records.iter().map(|record| pulse_data(record, order, 0)).collect::<Result<_, _>>().ok()?;
        let fit = PulseMethod::Efficient(&data.iter().collect::<Vec<_>>()).fit().ok()?;
        let samples: f64 = data.iter().map(|d| d.statistics.samples()).sum();
        let levels: usize = data.iter().map(|d| d.points() - 1).sum();
        Some(samples * 2.0 * fit.noise_sd.ln() + (2 * order + levels + 1) as f64 * samples.ln())
    };
    let best = ORDERS
        .filter_map(|order| criterion(order).map(|value| (order, value)))
        .min_by(|(_, x), (_, y)| x.total_cmp(y));
    match best {
        Some((order, _)) => Ok(order),
        // No order works: say why the simplest does not.
        None => read(rig, designed.method(), records, *ORDERS.start(), 0)
            .and_then(|data| fit(rig, designed, &data.iter().collect::<Vec<_>>()).map(|_| *ORDERS.start())),
    }
}

fn fit(
    rig: &Rig,
    designed: Designed,
    data: &[&PulseData],
) -> Result<(PulseFit, Vec<Vec<f64>>), IdentificationError> {
    let method = designed.method();
    let refused = |reason: String| IdentificationError::Refused {
        rig: rig.name.clone(),
        method,
        reason,
        remedy: "try a lower `order`, a longer record, or `--method free`".to_owned(),
    };
    let paper = |step: (Role, &'static str)| -> Result<_, IdentificationError> {
        // Any mean serves for a first a, which then says how long the step takes to settle.
        let first = PulseMethod::Efficient(data).fit().map_err(|error| refused(error.to_string()))?;
        let a: Vec<f64> = first.a.iter().map(|x| x.value).collect();
        Ok(PulseMethod::Paper { experiment: data[0], step: step_mean(rig, method, step, &a)? })
    };
    let fitted = match designed {
        Designed::PaperDescendant => paper((Role::StepHigh, "a `step_high` record"))?,
        Designed::PaperAscendant => paper((Role::StepLow, "a `step_low` record"))?,
        Designed::Joint => PulseMethod::Joint { descendant: data[0], ascendant: data[1] },
        Designed::Efficient => PulseMethod::Efficient(data),
        Designed::Instrumental => PulseMethod::Instrumental(data),
    }
    .fit_with_covariance();
    fitted.map_err(|error| refused(error.to_string()))
}

/// (3.6) without its transient, from the longest record of a role, which is given with the words for it.
fn step_mean(
    rig: &Rig,
    method: Method,
    (role, needed): (Role, &'static str),
    a: &[f64],
) -> Result<StepMean, IdentificationError> {
    let record = longest(rig, role).ok_or_else(|| IdentificationError::MissingExperiment {
        rig: rig.name.clone(),
        method,
        needed,
    })?;
    let refused = |reason: String| IdentificationError::Refused {
        rig: rig.name.clone(),
        method,
        reason,
        remedy: "record a longer step, or choose `--method efficient`, which needs none".to_owned(),
    };
    if !is_stable(a) {
        return Err(refused("the estimated A is unstable, so the step never settles".to_owned()));
    }
    // One sample loads the border; the step follows it.
    let from = 1 + settling_samples(a, SETTLED);
    let y = record.record.y();
    if y.len() < from + a.len() + 1 {
        return Err(refused(format!(
            "record {} has {} samples, but its transient lasts {from}",
            record.name,
            y.len()
        )));
    }
    let settled = &y[from..];
    Ok(StepMean { mean: settled.iter().sum::<f64>() / settled.len() as f64, samples: settled.len() as f64 })
}
