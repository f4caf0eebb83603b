//! What the residuals of an identification say against it.

use super::errors_of_run::RunErrors;
use super::{Flag, Identification};
use switchback_identify::statistics::{MeanInterval, Whiteness};
use switchback_model::rig::{Rig, Usage};

/// Share of a variance from which on an effect counts as large: `f² = R²/(1 − R²) = 0.35` of J. Cohen, "Statistical Power Analysis for the
/// Behavioral Sciences", 2nd ed. 1988, §9.2.1.
const LARGE: f64 = 0.35 / 1.35;

/// How white the innovations are over the records that the method was fitted to; `None` where they are too few.
///
/// The noise may enter as equation error, and then the one-step residuals `ε = A(q⁻¹)(y − ŷ)` of an exact model are white, or behind the
/// system, and then its free-run errors `y − ŷ` are. Either is no fault of the model, so the whiter of the two is taken.
pub(super) fn innovations(rig: &Rig, identification: &Identification) -> Option<Whiteness> {
    let mut runs = RunErrors::of(rig, identification, Usage::Fit);
    runs.retain(|run| identification.method.is_fitted_to(run.record.role));
    let a = &identification.estimate.a;
    let one_step = |e: &[f64]| -> Vec<f64> {
        let past = |t: usize| a.iter().enumerate().map(move |(i, a)| a * e[t - 1 - i]).sum::<f64>();
        (a.len()..e.len()).map(|t| e[t] + past(t)).collect()
    };
    let residuals: Vec<Vec<f64>> = runs.iter().map(|run| one_step(&run.errors)).collect();
    let of = |parts: Vec<&[f64]>| Whiteness::of(&parts);
    let candidates = [
        of(residuals.iter().map(Vec::as_slice).collect()),
        of(runs.iter().map(|run| &run.errors[..]).collect()),
    ];
    candidates.into_iter().flatten().min_by(|x, y| x.forecast.total_cmp(&y.forecast))
}

/// Points at `gap` where the innovations' own past predicts a large share of them.
pub(super) fn colour(whiteness: &Whiteness) -> Option<Flag> {
    let Whiteness { forecast, ljung_box, lags, p_value } = *whiteness;
    (forecast > LARGE && p_value < 0.001).then(|| {
        Flag::new(
            "coloured_innovations",
            forecast,
            format!(
                "the innovations are far from white: their past predicts {:.0} % of their variance (Ljung–Box {ljung_box:.0} over {lags} lags), so something is left that the model does not explain; `switchback gap` looks for its cause",
                100.0 * forecast
            ),
        )
    })
}

/// Records whose free run misses more than their mean would, beyond chance.
pub(super) fn worse_than_the_mean(rig: &Rig, identification: &Identification) -> Vec<Flag> {
    let runs = [Usage::Fit, Usage::Holdout].map(|usage| RunErrors::of(rig, identification, usage));
    let flags = runs.iter().flatten().filter_map(|run| {
        let excess: Vec<f64> =
            run.squares_from(run.start).zip(run.squares_about_mean()).map(|(missed, there)| missed - there).collect();
        let beyond_chance = MeanInterval::of(&[&excess]).is_some_and(|excess| excess.low > 0.0);
        let (missed, there): (f64, f64) = (run.squares_from(run.start).sum(), run.squares_about_mean().sum());
        let fit = 100.0 * (1.0 - (missed / there).sqrt());
        let name = &run.record.name;
        beyond_chance.then(|| {
            Flag::new(
                "free_run_useless",
                fit,
                format!("the free run over {name} is further from the record than its mean is (fit {fit:.1} %): do not simulate such inputs with this model"),
            )
        })
    });
    flags.collect()
}
