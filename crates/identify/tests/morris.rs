//! Performance measures and their Monte-Carlo errors against published ones.
//!
//! The formulas are those of Morris, White, Crowther, "Using simulation studies to evaluate statistical methods", Statistics in Medicine 38
//! (2019), 2074–2102, Table 6. Their authors' program is `simsum` for Stata (White, Stata Journal 10, 2010, 369–385), its port `rsimsum` for R
//! (Gasparini, Journal of Open Source Software 3, 2018, 739). What these print of two studies is held here against our measures:
//!
//! - `simsum` 2.3.1 on its test data `check.dta`, 100 replicates, methods b_1 and b_2, as logged in `test/cscript1.log` of the repository
//!   UCL/simsum, section "handling mcse" (22 Sep 2025), seven digits;
//! - `rsimsum` on White's study of missing data `MIsim`, 1,000 replicates, methods CC, MI_LOGT, MI_T, as printed in `README.md` of the repository
//!   ellessenne/rsimsum ("Summarising the results"), four decimals;
//! - the numbers of replicates that section 5.3 of the article works out.
//!
//! Single estimates are printed nowhere, so replicates are made up that have the published bias, empirical standard error, model standard error
//! with its error, and coverage. All other figures then follow by formula. That of the error of the mean squared error asks for a fourth
//! moment, which is not published; that of the model standard error is the one taken over. Both are tried by their definitions beside
//! the code, and by repetition in `switchback selftest`.

use switchback_identify::statistics::{ErrorSums, KnownControl, Measured, Performance, ReplicateError};

/// A figure as printed: it stands for all that round to it.
#[derive(Debug, Clone, Copy)]
struct Printed(&'static str);

impl Printed {
    fn value(self) -> f64 {
        self.0.parse().expect("a number")
    }

    /// Half a unit of the last digit.
    fn rounding(self) -> f64 {
        let decimals = self.0.split_once('.').map_or(0, |(_, digits)| digits.len());
        0.5 * 0.1_f64.powi(decimals as i32)
    }
}

/// What is printed of one method: value and Monte-Carlo error; shares, not per cent.
struct Study {
    name: &'static str,
    replicates: usize,
    /// Intervals that hold the truth.
    covered: usize,
    bias: [Printed; 2],
    empirical: [Printed; 2],
    /// Value only.
    mse: Printed,
    model: [Printed; 2],
    /// In per cent.
    relative_error: [Printed; 2],
    /// Of the error of the coverage, as a share.
    coverage_error: Printed,
}

const fn pair(value: &'static str, error: &'static str) -> [Printed; 2] {
    [Printed(value), Printed(error)]
}

const STUDIES: [Study; 5] = [
    Study {
        name: "simsum, check.dta, b_1",
        replicates: 100,
        covered: 92,
        bias: pair("-0.0119478", "0.02102"),
        empirical: pair("0.2101996", "0.0149382"),
        mse: Printed("0.0438848"),
        model: pair("0.2058237", "0.0014974"),
        relative_error: pair("-2.081764", "6.995112"),
        coverage_error: Printed("0.02712932"),
    },
    Study {
        name: "simsum, check.dta, b_2",
        replicates: 100,
        covered: 92,
        bias: pair("-0.0117727", "0.0206127"),
        empirical: pair("0.2061269", "0.0146488"),
        mse: Printed("0.042202"),
        model: pair("0.2016575", "0.0014092"),
        relative_error: pair("-2.168266", "6.98613"),
        coverage_error: Printed("0.02712932"),
    },
    Study {
        name: "rsimsum, MIsim, CC",
        replicates: 1000,
        covered: 943,
        bias: pair("0.0168", "0.0048"),
        empirical: pair("0.1511", "0.0034"),
        mse: Printed("0.0231"),
        model: pair("0.1471", "0.0005"),
        relative_error: pair("-2.6594", "2.2049"),
        coverage_error: Printed("0.0073"),
    },
    Study {
        name: "rsimsum, MIsim, MI_LOGT",
        replicates: 1000,
        covered: 949,
        bias: pair("0.0009", "0.0042"),
        empirical: pair("0.1320", "0.0030"),
        mse: Printed("0.0174"),
        model: pair("0.1349", "0.0006"),
        relative_error: pair("2.2233", "2.3318"),
        coverage_error: Printed("0.0070"),
    },
    Study {
        name: "rsimsum, MIsim, MI_T",
        replicates: 1000,
        covered: 943,
        bias: pair("-0.0012", "0.0043"),
        empirical: pair("0.1344", "0.0030"),
        mse: Printed("0.0181"),
        model: pair("0.1338", "0.0006"),
        relative_error: pair("-0.4412", "2.2690"),
        coverage_error: Printed("0.0073"),
    },
];

impl Study {
    /// Our measures of replicates that have the figures given.
    fn performance(&self, [bias, empirical, model, model_error]: [f64; 4]) -> Performance {
        let n = self.replicates;
        // A few far out, so that their intervals miss; the others near. Both signs in turn, then mean 0 and variance 1 exactly.
        let outside = n - self.covered;
        let raw: Vec<f64> = (0..n)
            .map(|i| (if i < outside { 3.0 } else { 0.7 }) * (if i % 2 == 0 { 1.0 } else { -1.0 }))
            .collect();
        let errors = standardised(&raw);
        // MCSE(ModSE)² = Var(se²)/(4n·ModSE²).
        let spread = 2.0 * (n as f64).sqrt() * model * model_error;
        let squares = standardised(&(0..n).map(|i| f64::from(u8::from(i % 4 < 2))).collect::<Vec<_>>());
        let mut sums = ErrorSums::default();
        for (error, square) in errors.iter().zip(squares) {
            let se = (model * model + spread * square).sqrt();
            sums.push(ReplicateError {
                error: bias + empirical * error,
                se,
                first_order: None,
                second_order: 0.0,
                first_order_variance: None,
            });
        }
        sums.performance(KnownControl::default()).expect("replicates enough")
    }

    /// A measure must round to what is printed, for some of the numbers that round to the figures it follows from.
    #[track_caller]
    fn agrees(&self, what: &str, printed: Printed, of: impl Fn(&Performance) -> f64) {
        let inputs = [self.bias[0], self.empirical[0], self.model[0], self.model[1]];
        let (mut least, mut most) = (f64::INFINITY, f64::NEG_INFINITY);
        for corner in 0..16_u32 {
            let input: [f64; 4] = std::array::from_fn(|k| {
                let side = if corner >> k & 1 == 0 { -1.0 } else { 1.0 };
                inputs[k].value() + side * inputs[k].rounding()
            });
            let value = of(&self.performance(input));
            (least, most) = (least.min(value), most.max(value));
        }
        let (low, high) = (printed.value() - printed.rounding(), printed.value() + printed.rounding());
        let slack = 1e-12;
        assert!(
            least <= high + slack && most >= low - slack,
            "{}: {what} is {least} to {most}, printed {}",
            self.name,
            printed.0
        );
    }
}

/// The same numbers moved and scaled to mean 0 and variance 1, with the divisor `n − 1`.
fn standardised(x: &[f64]) -> Vec<f64> {
    let n = x.len() as f64;
    let mean = x.iter().sum::<f64>() / n;
    let sd = (x.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / (n - 1.0)).sqrt();
    x.iter().map(|x| (x - mean) / sd).collect()
}

#[test]
fn measures_and_errors_are_those_that_simsum_and_rsimsum_print() {
    for study in &STUDIES {
        study.agrees("bias", study.bias[0], |p| p.bias.value);
        study.agrees("error of the bias", study.bias[1], |p| p.bias.mcse);
        study.agrees("empirical standard error", study.empirical[0], |p| p.sd.value);
        study.agrees("its error", study.empirical[1], |p| p.sd.mcse);
        study.agrees("mean squared error", study.mse, |p| p.mse.value);
        study.agrees("model standard error", study.model[0], |p| p.model_sd.value);
        study.agrees("its error", study.model[1], |p| p.model_sd.mcse);
        let per_cent =
            |of: fn(&Measured) -> f64| move |p: &Performance| 100.0 * of(&p.model_sd_relative_error);
        study.agrees("relative error in per cent", study.relative_error[0], per_cent(|m| m.value));
        study.agrees("its error", study.relative_error[1], per_cent(|m| m.mcse));
        study.agrees("error of the coverage", study.coverage_error, |p| p.coverage.mcse);
        let covered = study.performance(
            [study.bias[0], study.empirical[0], study.model[0], study.model[1]].map(Printed::value),
        );
        assert_eq!((covered.coverage.value * study.replicates as f64).round(), study.covered as f64);
    }
}

/// Section 5.3: with an sd of at most 0.2 a bias with an error of 0.005 takes 1,600 replicates; a coverage of 95 % with an error of 0.5 % takes 1,900,
/// and one of 50 % takes 10,000.
#[test]
fn as_many_replicates_are_needed_as_the_article_works_out() {
    let error_after = |replicates: usize, covered: usize| {
        let study = Study { replicates, covered, ..STUDIES[0] };
        // Intervals so short or long that the near replicates alone are held.
        study.performance([0.0, 0.2, 0.1, 0.0])
    };
    let planned = error_after(1600, 1520);
    assert!((planned.bias.mcse - 0.005).abs() < 1e-12, "{:?}", planned.bias);
    for (replicates, covered) in [(1900, 1805), (10_000, 5_000)] {
        let coverage = error_after(replicates, covered).coverage;
        assert_eq!(coverage.value, covered as f64 / replicates as f64);
        assert!((coverage.mcse - 0.005).abs() < 1e-12, "{coverage:?}");
    }
}
