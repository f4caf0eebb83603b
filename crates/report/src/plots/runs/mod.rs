//! Figures of series.csv, which a diagnosis and an identification have in common: the loop, and outputs over time with their residuals.

mod loops;
mod outputs;
mod shown;
mod thin;

pub(crate) use loops::loops;
pub(crate) use outputs::outputs;
pub(crate) use shown::Shown;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plots::inspect::check;
    use switchback_io::model::{Banded, RecordSeries, Series};

    /// A record with a run that leaves every range, and one without.
    fn series(samples: usize) -> Series {
        let t: Vec<f64> = (0..samples).map(|k| 0.01 * k as f64).collect();
        let wave = |scale: f64| t.iter().map(|t| scale * (7.0 * t).sin()).collect::<Vec<f64>>();
        let mut runaway = wave(1.1);
        runaway[samples / 2] = -1e9;
        let record = |name: &str, usage: &str, runs| RecordSeries {
            record: name.to_owned(),
            usage: usage.to_owned(),
            t: t.clone(),
            v: wave(2.0),
            y: wave(1.0),
            runs,
        };
        let banded = Banded { y: wave(1.05), band: Some(vec![0.1; samples]) };
        Series {
            names: vec!["nominal".to_owned(), "augmented".to_owned()],
            records: vec![
                record("a", "fit", vec![None, None]),
                record("b <c>", "holdout", vec![Some(Banded { y: runaway, band: None }), Some(banded)]),
            ],
        }
    }

    #[test]
    fn figures_stay_on_the_page_and_name_their_series() {
        for samples in [2, 400, 5000] {
            let series = series(samples);
            let records = vec!["a".to_owned(), "b <c>".to_owned()];
            let shown =
                Shown { series: &series, input: "v [mm]", output: "y [N]", records, noise: Some(0.05) };
            for (svg, frames) in loops(&shown).iter().zip([1; 2]).chain(outputs(&shown).iter().zip([2; 2])) {
                assert_eq!(check(svg), Ok(()));
                assert_eq!(svg.matches(" data-frame=").count(), frames);
            }
            assert_eq!(loops(&shown), loops(&shown));
            assert!(outputs(&shown)[1].contains("data-series=\"augmented, 95 % band\""));
        }
    }

    #[test]
    fn the_first_record_is_drawn_where_none_is_named() {
        let series = series(10);
        let shown = Shown { series: &series, input: "v", output: "y", records: Vec::new(), noise: None };
        assert_eq!((loops(&shown).len(), outputs(&shown).len(), shown.left_out()), (1, 1, 0));
    }
}
