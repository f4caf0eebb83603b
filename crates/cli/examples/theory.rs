//! How near theory comes to a study: what is left of bias and standard deviation, and what the control variates are worth.
//!
//! `cargo run --example theory -- REPORT [OTHER]` reads the folder of a report, for each N over all parameters that have a theory. With the report
//! of the same study by another version, Monte-Carlo errors of the bias are compared.

use miette::{IntoDiagnostic, miette};
use std::collections::BTreeMap;
use std::path::Path;
use switchback_study::results::{Cell, Parameter, Results, read};

/// Chance that any of the parameters of an N is found beyond Monte-Carlo error where theory is right.
const LEVEL: f64 = 0.01;

fn main() -> miette::Result<()> {
    let mut arguments = std::env::args().skip(1);
    let folder = arguments.next().ok_or_else(|| miette!("name the folder of a report"))?;
    let results = read(Path::new(&folder))?;
    let other = arguments.next().map(|folder| read(Path::new(&folder))).transpose()?;
    let broken: Vec<_> = results.expectations.iter().filter(|e| !e.held).collect();
    println!(
        "{} of {} expectations hold",
        results.expectations.len() - broken.len(),
        results.expectations.len()
    );
    broken.iter().for_each(|e| println!("NOT expected: {}: {}", e.what, e.detail));
    let mut by_samples: BTreeMap<usize, Vec<(&Cell, &Parameter)>> = BTreeMap::new();
    for cell in &results.cells {
        let of_theory = cell.parameters.iter().filter(|p| p.theory_bias.is_some());
        by_samples.entry(cell.samples).or_default().extend(of_theory.map(|p| (cell, p)));
    }
    println!(
        "N, parameters: N·|bias − theory|/(sd·√N), median; largest in Monte-Carlo errors (limit); |sd/theory − 1|, rms and largest"
    );
    for (samples, parameters) in &by_samples {
        row(*samples, parameters).into_diagnostic()?;
        gains(parameters, other.as_ref());
    }
    Ok(())
}

/// What is left over theory.
fn row(samples: usize, parameters: &[(&Cell, &Parameter)]) -> Result<(), statrs::distribution::NormalError> {
    use statrs::distribution::{ContinuousCDF, Normal};
    let left = parameters.iter().filter_map(|(_, p)| Some((p, p.bias_controlled?, p.theory_bias?)));
    let left: Vec<_> = left.collect();
    let scale = (samples as f64).sqrt();
    let sizes = left
        .iter()
        .filter_map(|(p, bias, theory)| Some(scale * (bias.value() - theory).abs() / p.theory_sd?));
    let errors = left.iter().filter_map(|(_, bias, theory)| bias.z(*theory)).map(f64::abs);
    let limit = Normal::new(0.0, 1.0)?.inverse_cdf(1.0 - LEVEL / (2 * left.len()).max(1) as f64);
    let ratios: Vec<f64> = parameters
        .iter()
        .filter_map(|(_, p)| Some((p.sd_controlled?.value() / p.theory_sd? - 1.0).abs()))
        .collect();
    let square = ratios.iter().map(|r| r * r).sum::<f64>() / ratios.len() as f64;
    println!(
        "{samples}, {}: {:.2e}; {:.2} ({limit:.2}); {:.3} % and {:.3} %",
        left.len(),
        median(sizes.collect()),
        errors.fold(0.0, f64::max),
        100.0 * square.sqrt(),
        100.0 * ratios.iter().copied().fold(0.0, f64::max)
    );
    Ok(())
}

/// By how much Monte-Carlo errors are smaller.
fn gains(parameters: &[(&Cell, &Parameter)], other: Option<&Results>) {
    let coverage = parameters.iter().filter_map(|(_, p)| {
        let ratio = p.coverage?.mcse() / p.coverage_controlled?.mcse();
        ratio.is_finite().then_some(ratio)
    });
    println!("  error of coverage, plain over controlled: median {:.2}", median(coverage.collect()));
    let Some(other) = other else { return };
    let twin = |cell: &Cell, p: &Parameter| {
        let same = other.cells.iter().find(|c| c.series == cell.series && c.samples == cell.samples)?;
        let ratio = same.find(&p.name)?.bias_controlled?.mcse() / p.bias_controlled?.mcse();
        ratio.is_finite().then_some(ratio)
    };
    let ratios: Vec<f64> = parameters.iter().filter_map(|(cell, p)| twin(cell, p)).collect();
    let least = ratios.iter().copied().fold(f64::INFINITY, f64::min);
    println!("  error of the bias, other over this: least {least:.2}, median {:.2}", median(ratios));
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}
