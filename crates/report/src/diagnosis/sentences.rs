//! The verdict in sentences: where, which, how far, what remains.

use super::place;
use super::probability::probability;
use super::{shift, stability};
use switchback_diagnose::differences::Basis;
use switchback_diagnose::posterior::Classification;
use switchback_diagnose::{Diagnosis, Effect, FittedParameter, Gap, Status, Verdict};
use switchback_io::diagnosis::{Report, Source, Units, reported};
use switchback_io::diagnosis::{digits, whole_percent, with_interval};

/// Least gain of the prediction, nats per sample, that is worth a sentence.
const WORTH_TELLING: f64 = 1e-4;

/// Parameters of one effect at most that are reported one by one.
const READABLE: usize = 8;

/// Multiples of the output's variance from which a gap is reported in these.
const MANY: f64 = 10.0;

/// The sentences of the verdict, in the order in which they are read.
pub(super) fn verdict(report: &Report) -> Vec<String> {
    let stability = report.stability.iter().flat_map(stability::sentences);
    of_all(report).into_iter().chain(stability).collect()
}

/// Those of all records together.
fn of_all(report: &Report) -> Vec<String> {
    let units = Units::of(&report.rig);
    let diagnosis = &report.diagnosis;
    let mut sentences: Vec<String> = report.shifts.iter().map(|s| shift::sentence(s, &units)).collect();
    sentences.push(size(report));
    let shows = !matches!(diagnosis.verdict.status, Status::None);
    // Of records taken under other conditions no model of the fit records says anything.
    let augments = shows && diagnosis.verdict.held_out_error_ratio.is_none();
    if shows {
        sentences.push(place::place(report).unwrap_or_else(|| "No place stands out on the map.".to_owned()));
    }
    if let Some(differences) = &diagnosis.differences {
        // Where no few differences align the source something else shows the cause.
        if differences.basis != Basis::Differences {
            sentences.push(cause(diagnosis, &units));
        }
        if differences.basis == Basis::Nominal {
            sentences.extend(augments.then(|| closure(report)).into_iter().flatten());
            sentences.extend(augments.then(|| remainder(diagnosis, &units)));
        }
        sentences.extend(super::differences::sentences(report, differences));
        return sentences;
    }
    sentences.push(cause(diagnosis, &units));
    sentences.extend(uncalibrated(report));
    if diagnosis.verdict.status != Status::Refit {
        sentences.extend(identified_anew(diagnosis));
        sentences.extend(augments.then(|| closure(report)).into_iter().flatten());
    }
    sentences.extend(augments.then(|| remainder(diagnosis, &units)));
    sentences
}

/// Share of the output's variance below which a gap is none: a thousandth of its spread, which a converter of ten bits rounds away.
const NOTHING: f64 = 1e-6;

/// Whether the model misses nothing worth a cause.
fn is_exact(gap: &Gap) -> bool {
    gap.before.estimate.abs() <= NOTHING && gap.before.ci90[1] <= NOTHING
}

/// How large the gap is.
fn size(report: &Report) -> String {
    let gap = &report.diagnosis.gap;
    let model = report.source.in_words();
    let percent = |x: f64| digits(100.0 * x, 2);
    let [low, high] = gap.before.ci90;
    let held_out = judged(report);
    if is_exact(gap) {
        return format!("On {held_out} {model} misses less than a thousandth of the output's spread.");
    }
    if gap.before.ci90[0] <= 0.0 {
        if high <= 0.0 {
            return format!(
                "On {held_out} {model} misses less than the noise floor, which is then no estimate of the noise: the gap cannot be measured."
            );
        }
        let at_most = percent(high);
        return format!(
            "On {held_out} {model} misses no more than the noise does: any gap is below {at_most} % of the output's variance."
        );
    }
    if low > MANY {
        let times = |x: f64| digits(x, 2);
        return format!(
            "On {held_out} {model} misses {} times [{}, {}] the output's variance.",
            times(gap.before.estimate),
            times(low),
            times(high)
        );
    }
    format!(
        "On {held_out} {model} misses {} % [{}, {}] of the output's variance beyond the noise.",
        percent(gap.before.estimate),
        percent(low),
        percent(high)
    )
}

/// What the gap was measured on: where no held-out record can be judged, the fit records are.
fn judged(report: &Report) -> &'static str {
    let records = &report.diagnosis.gap.per_record;
    let is_held_out = |name: &str| report.rig.holdout_records().any(|record| record.name == name);
    if records.iter().any(|record| is_held_out(&record.record)) {
        return "held-out records";
    }
    match report.rig.holdout_records().next() {
        Some(_) => "the fit records (no held-out record can be judged)",
        None => "the fit records (none is held out)",
    }
}

/// How two causes share what they explain.
fn shares(diagnosis: &Diagnosis) -> Option<String> {
    let pair = diagnosis.together.as_ref().filter(|pair| pair.effects == diagnosis.verdict.effects)?;
    let each = pair.effects.iter().zip(&pair.shares);
    let each: Vec<String> =
        each.map(|(e, share)| format!("{} % to {}", whole_percent(100.0 * share), e.name())).collect();
    Some(format!(" Of what both explain, {} (Shapley shares).", each.join(" and ")))
}

fn cause(diagnosis: &Diagnosis, units: &Units) -> String {
    let verdict = &diagnosis.verdict;
    let p = probability(verdict.probability);
    match verdict.status {
        // What is left though nothing shows on the judged records.
        Status::None if diagnosis.probability_none < 0.5 => {
            let [_, high] = diagnosis.gap.before.ci90;
            let missed = match high {
                high if high > 0.0 => format!(
                    "anything below {} % of the output's variance, the upper end of the gap's interval, would be missed",
                    digits(100.0 * high, 2)
                ),
                _ => "the noise floor is no estimate of the noise, so nobody knows what would be missed"
                    .to_owned(),
            };
            format!("No gap can be resolved: {missed}.")
        }
        Status::Refit | Status::Parameters => refit(diagnosis),
        Status::None => {
            // Of a model that was identified here the errors on held-out records were tested.
            let is_tested = diagnosis.gap.identified_anew.is_none() && !is_exact(&diagnosis.gap);
            let by_chance = match diagnosis.gap.before.ci90[0] > 0.0 && is_tested {
                true => format!(
                    ": beyond the noise it misses what chance and the error of a fit to {} samples make",
                    diagnosis.samples
                ),
                false => String::new(),
            };
            format!(
                "Nothing significant is missing from the model, probability {p}; the records are consistent with it{by_chance}."
            )
        }
        Status::Named if verdict.effects.len() > 1 => {
            let each: Vec<_> =
                verdict.effects.iter().map(|effect| described(*effect, diagnosis, units)).collect();
            format!(
                "Causes, acting together: {}; probability {p}{}.{}",
                each.join(" and "),
                next_best(diagnosis),
                shares(diagnosis).unwrap_or_default()
            )
        }
        Status::Named => {
            let effect = verdict.effects.first().map(|effect| described(*effect, diagnosis, units));
            let correction = verdict.corrected_by.map_or_else(String::new, |second| {
                format!(
                    " Its law misses a little, which {second} takes beside it: too little to be a cause of its own."
                )
            });
            let next = next_best(diagnosis);
            format!("Cause: {}, probability {p}{next}.{correction}", effect.unwrap_or_default())
        }
        Status::Class | Status::Ambiguous if verdict.class.len() == 1 => format!(
            "Cause: most likely {}; that is not certain enough to name it{}.",
            rivals(&verdict.class, diagnosis, units),
            next_best(diagnosis)
        ),
        Status::Shortlist => format!(
            "Cause: none is certain enough to be named; the likeliest: {}, together {p}.",
            ranked(diagnosis)
        ),
        Status::Class => format!(
            "Cause: one of {}, together {p}; no record here separates them.",
            rivals(&verdict.class, diagnosis, units)
        ),
        Status::Ambiguous => {
            format!("Cause: not settled between {}, together {p}.", rivals(&verdict.class, diagnosis, units))
        }
        Status::Unexplained if let Some(ratio) = verdict.held_out_error_ratio => format!(
            "The fit records show nothing missing, but on the held-out ones the same model errs {} times as much: the records were taken \
             under other conditions (an offset, a gain, a sign, a load?). No candidate is the cause, probability {p}.",
            digits(ratio, 2)
        ),
        Status::Unexplained => {
            let stage = verdict
                .stage
                .map_or_else(String::new, |stage| format!("; what is left points at the {stage} stage"));
            let best = diagnosis.candidates.first();
            let best = best.map_or_else(String::new, |c| {
                format!(". The nearest candidate, {}, does not explain it", c.effect)
            });
            format!("Cause: none of the candidates, probability {p}{stage}{best}.")
        }
    }
}

/// `backlash 0.52, then creep 0.21`, each with its probability.
fn ranked(diagnosis: &Diagnosis) -> String {
    let of = |effect: &Effect| diagnosis.classification.as_ref().map_or(0.0, |c| c.probability(*effect));
    let one = |effect: &Effect| format!("{effect} ({})", probability(of(effect)));
    diagnosis.verdict.class.iter().map(one).collect::<Vec<_>>().join(", then ")
}

/// What identifying the model anew does.
fn refit(diagnosis: &Diagnosis) -> String {
    let Some(refit) = diagnosis.verdict.refit else {
        return "The model's parameters (its order) are off: identified anew it lacks no cause.".to_owned();
    };
    let delay = match refit.delay {
        0 => String::new(),
        -1 => " and an output that follows the input within its sample".to_owned(),
        delay if delay < 0 => format!(" and an output {} sample ahead of the input", -delay - 1),
        delay => format!(" and {delay} samples of extra delay"),
    };
    let [low, high] = refit.closure.ci90.map(|x| whole_percent(100.0 * x));
    format!(
        "The model's parameters (its order) are off: identified anew from the fit records, with order {}{delay} and without any cause, it \
         closes {} % [{low}, {high}] of the gap, and no cause closes more beyond the error.",
        refit.order,
        whole_percent(100.0 * refit.closure.estimate)
    )
}

/// A word on probabilities that were calibrated on other records than these.
fn uncalibrated(report: &Report) -> Option<String> {
    let verdict = &report.diagnosis.verdict;
    let shows_one = match verdict.status {
        Status::Refit | Status::Parameters => false,
        // Then no probability is reported.
        Status::None => report.diagnosis.probability_none >= 0.5,
        _ => true,
    };
    let reason = match (report.source, report.rig.order, report.rig.holdout_records().next()) {
        _ if diagnosis_is_outside(report) => "they are unlike those that it was trained on",
        (Source::Given | Source::Predicted | Source::Against, ..) => "the model was given",
        (_, None, _) => "no order is declared",
        (.., None) => "no record is held out",
        _ => "models are compared by their free run",
    };
    (shows_one && !verdict.calibrated).then(|| {
        format!("This probability ranks and is no frequency: it was not calibrated for records like these ({reason}).")
    })
}

fn diagnosis_is_outside(report: &Report) -> bool {
    report.diagnosis.classification.as_ref().is_some_and(Classification::is_outside)
}

/// `backlash (play 0.12 ± 0.01 V)`
fn described(effect: Effect, diagnosis: &Diagnosis, units: &Units) -> String {
    let candidate = || diagnosis.candidates.iter().find(|candidate| candidate.effect == effect);
    let alone = || candidate().map(|candidate| &candidate.parameters[..]);
    match fitted_together(effect, diagnosis).or_else(alone).filter(|fitted| !fitted.is_empty()) {
        Some(fitted) => format!("{effect} ({})", parameters(fitted, units)),
        None => effect.to_string(),
    }
}

/// The parameters of an effect beside the other one of a pair that the verdict names: alone it takes some of what is the other's.
fn fitted_together(effect: Effect, diagnosis: &Diagnosis) -> Option<&[FittedParameter]> {
    let Verdict { effects, corrected_by, .. } = &diagnosis.verdict;
    let reported = |e: &Effect| effects.contains(e) || *corrected_by == Some(*e);
    let pair = diagnosis.together.as_ref().filter(|pair| pair.effects.iter().all(reported))?;
    let fitted = pair.effects.iter().zip(&pair.parameters).find(|(member, _)| **member == effect);
    fitted.map(|(_, parameters)| &parameters[..])
}

/// Parameters with their 90 % intervals; nothing for an effect without parameters of its own, and a number where they are too many to
/// be read.
pub(super) fn parameters(fitted: &[FittedParameter], units: &Units) -> String {
    if fitted.len() > READABLE {
        return format!("{} parameters, in the JSON", fitted.len());
    }
    let each = fitted.iter().map(|parameter| {
        let reported = reported(parameter, units);
        let figure = match parameter.unit {
            "count" => format!("{:.0}", reported.value),
            _ => with_interval(reported.value, reported.ci90),
        };
        let text = format!("{} {figure} {}", reported.name.replace('_', " "), reported.unit);
        text.trim_end().to_owned()
    });
    each.collect::<Vec<_>>().join(", ")
}

fn rivals(class: &[Effect], diagnosis: &Diagnosis, units: &Units) -> String {
    let one = |effect: &Effect| {
        let p = diagnosis.candidates.iter().find(|c| c.effect == *effect).map_or(f64::NAN, |c| c.probability);
        format!("{} with probability {}", described(*effect, diagnosis, units), probability(p))
    };
    class.iter().map(one).collect::<Vec<_>>().join(" or ")
}

/// The likeliest rival of what was named, be it another effect, none of these, or nothing at all.
fn next_best(diagnosis: &Diagnosis) -> String {
    let verdict = &diagnosis.verdict;
    let reported = |effect: &Effect| verdict.effects.contains(effect) || verdict.class.contains(effect);
    let others = diagnosis.candidates.iter().filter(|c| !reported(&c.effect));
    let effects = others.map(|c| (c.effect.name(), c.probability));
    let rest =
        [("none of these", diagnosis.probability_unexplained), ("nothing", diagnosis.probability_none)];
    let best = effects.chain(rest).max_by(|x, y| x.1.total_cmp(&y.1));
    best.filter(|(_, p)| *p >= 0.005)
        .map_or_else(String::new, |(name, p)| format!("; next best {name}, {}", probability(p)))
}

/// Share of the gap of a model that was given that a model without any cause closes, identified anew; nothing where there is no gap.
fn closed_anew(diagnosis: &Diagnosis) -> Option<f64> {
    let gap = &diagnosis.gap;
    let anew = gap.identified_anew.filter(|_| gap.before.ci90[0] > 0.0)?;
    Some((1.0 - anew.estimate / gap.before.estimate).clamp(0.0, 1.0))
}

/// How much of the gap of a model that was given is its parameters' alone.
fn identified_anew(diagnosis: &Diagnosis) -> Option<String> {
    let closes = match closed_anew(diagnosis)? {
        0.0 => "nothing".to_owned(),
        share => format!("{} %", whole_percent(100.0 * share)),
    };
    Some(format!(
        "Identified anew from the fit records, a model without any cause closes {closes} of the gap."
    ))
}

/// How far the gap closes, in simulation and in prediction.
fn closure(report: &Report) -> Vec<String> {
    let diagnosis = &report.diagnosis;
    let gap = &diagnosis.gap;
    let adding = match (diagnosis.verdict.status, diagnosis.verdict.effects.len()) {
        (Status::Named, 2..) => "Adding them",
        (Status::Named, _) if diagnosis.verdict.corrected_by.is_some() => "Adding both",
        (Status::Named, _) => "Adding it",
        _ => "Adding the best candidate",
    };
    let as_well = if gap.identified_anew.is_some() { " as well" } else { "" };
    let mut sentences = Vec::new();
    let noise_only =
        !diagnosis.verdict.effects.is_empty() && diagnosis.verdict.effects.iter().all(|e| e.is_noise());
    match &gap.closure {
        _ if noise_only => sentences
            .push("A cause in the noise moves no simulation error, so no closure is given.".to_owned()),
        Some(closure) => {
            let [low, high] = closure.ci90.map(|x| 100.0 * x);
            let percent = whole_percent;
            sentences.push(match closure.estimate {
                c if c > 0.0 => format!(
                    "{adding}{as_well} closes {} % [{}, {}] of the gap on {}.",
                    percent(100.0 * c),
                    percent(low),
                    percent(high),
                    judged(report)
                ),
                c => format!(
                    "{adding} closes nothing on {}: the simulation error grows by {} % [{}, {}].",
                    judged(report),
                    percent(-100.0 * c),
                    percent(-high),
                    percent(-low)
                ),
            });
        }
        None => sentences
            .push("The gap's interval includes zero, so how far it closes is not resolvable.".to_owned()),
    }
    if gap.predictive_gain.abs() >= WORTH_TELLING {
        let better = if gap.predictive_gain > 0.0 { "better" } else { "worse" };
        sentences.push(format!(
            "One-step predictions become {better} by {} nats per held-out sample.",
            digits(gap.predictive_gain.abs(), 2)
        ));
    }
    sentences
}

/// What remains after the augmentation.
fn remainder(diagnosis: &Diagnosis, units: &Units) -> String {
    let gap = &diagnosis.gap;
    let percent = |x: f64| digits(100.0 * x, 2);
    let floor = format!("sd {} {}", digits(gap.noise_floor, 2), units.output);
    let what = format!(
        "{} % [{}, {}] of the output's variance",
        percent(gap.after.estimate),
        percent(gap.after.ci90[0]),
        percent(gap.after.ci90[1])
    );
    let left = gap.after.estimate.max(0.0).sqrt() * output_sd(diagnosis);
    match gap.after.estimate {
        after if after >= 1.0 => {
            "The augmented model is no simulator: in free run it misses more than the output's mean would."
                .to_owned()
        }
        _ if gap.after.ci90[0] <= 0.0 => format!("What remains is the noise floor ({floor})."),
        _ if left < gap.noise_floor => {
            format!("What remains, {what}, is less than the noise floor ({floor}).")
        }
        _ => format!("What remains, {what}, lies above the noise floor ({floor})."),
    }
}

/// Standard deviation of the measured outputs about their records' means, over the judged records.
fn output_sd(diagnosis: &Diagnosis) -> f64 {
    let (mut energy, mut count) = (0.0, 0.0);
    for series in &diagnosis.series {
        let n = series.measured.len() as f64;
        let mean = series.measured.iter().sum::<f64>() / n.max(1.0);
        energy += series.measured.iter().map(|y| (y - mean).powi(2)).sum::<f64>();
        count += n;
    }
    (energy / f64::max(count, 1.0)).sqrt()
}
