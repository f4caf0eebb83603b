//! Figures of a blind study, drawn from its tables alone.

mod closure;
pub(super) mod confusion;
pub(super) mod curves;
mod rules;

use super::Figure;
use switchback_lab::blind::{Case, Scores};

/// Every figure.
pub fn figures(cases: &[Case], scores: &Scores) -> Vec<Figure> {
    let closures: Vec<_> = cases.iter().filter_map(|c| Some((c.is_large(), c.closure?))).collect();
    let figures = [
        ("confusion.svg", confusion::confusion(&scores.confusion, "surviving gap ≥ 1 sd")),
        ("accuracy.svg", curves::accuracy(&scores.sizes)),
        ("calibration.svg", curves::calibration(&scores.calibration.bins)),
        ("abstention.svg", curves::abstention(&scores.abstention)),
        ("closure.svg", closure::closure(&closures)),
        ("baselines.svg", rules::baselines(&scores.baselines)),
    ];
    figures.map(|(name, svg)| Figure { name: name.to_owned(), svg }).into()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plots::inspect::check;
    use switchback_lab::blind::{AbstentionRow, BaselineRow, Confusion, SizeRow};
    use switchback_lab::examination::{CalibrationBin, ClosureCheck, Share};

    fn share(count: usize, of: usize) -> Share {
        Share { count, of }
    }

    fn drawn() -> Vec<String> {
        let confusion = Confusion {
            rows: vec!["creep", "none", "outside", "a very long name of an effect"],
            columns: vec!["creep", "none", "unexplained", "failed"],
            counts: vec![vec![3, 0, 0, 0], vec![0, 370, 0, 1], vec![2, 1, 9, 0], vec![0; 4]],
        };
        let sizes = [0.5, 1.0, 2.0, 4.0].map(|wanted| SizeRow {
            wanted,
            exact: share(9, 10),
            class: share(10, 10),
            mismatch_class: share(0, 0),
            wrong: share(0, 10),
        });
        let bins = [(0.24, share(0, 1)), (0.55, share(5, 13)), (0.97, share(375, 376))];
        let bins = bins.map(|(claimed, held)| CalibrationBin { claimed, held });
        let abstention = [0.0, 0.5, 1.0].map(|threshold| AbstentionRow {
            threshold,
            answered: share(50, 100),
            right: share(49, 50),
        });
        let closures = [(0.9, 0.91), (-7.0, -3.0), (0.5, 1.9), (0.2, -9.0)]
            .map(|(actual, estimate)| (actual > 0.0, ClosureCheck { estimate, ci90: [0.0, 1.0], actual }));
        let rules = ["this diagnosis", "lowest RMSE"].map(|rule| BaselineRow {
            rule,
            exact: share(145, 151),
            false_alarm: share(0, 37),
            outside_named: share(2, 25),
            precision: share(0, 0),
        });
        vec![
            confusion::confusion(&confusion, "size ≥ 2"),
            curves::accuracy(&sizes),
            curves::calibration(&bins),
            curves::abstention(&abstention),
            closure::closure(&closures),
            rules::baselines(&rules),
        ]
    }

    #[test]
    fn figures_repeat_and_stay_on_the_page() {
        let figures = drawn();
        assert_eq!(figures, drawn());
        for svg in &figures {
            assert_eq!(check(svg), Ok(()));
        }
    }

    #[test]
    fn empty_tables_give_figures_that_say_so() {
        let confusion = Confusion { rows: vec![], columns: vec![], counts: vec![] };
        let figures = [
            confusion::confusion(&confusion, "size ≥ 2"),
            curves::accuracy(&[]),
            curves::calibration(&[]),
            curves::abstention(&[]),
            closure::closure(&[]),
            rules::baselines(&[]),
        ];
        for svg in figures {
            assert_eq!(check(&svg), Ok(()));
            assert!(svg.contains("No rig"), "{svg}");
        }
    }

    #[test]
    fn rows_describe_how_many_rigs_they_are_of_and_bins_too() {
        let figures = drawn();
        assert!(figures[0].contains("\n371\n"), "none has 371 rigs");
        assert!(figures[2].contains("\n376\n") && figures[2].contains("\n1\n"));
    }

    #[test]
    fn closures_beyond_the_frame_are_arrows() {
        let svg = &drawn()[4];
        // One inside, two in the legend; three beyond, one in the legend.
        assert_eq!(svg.matches("<circle cx").count(), 1 + 2);
        assert_eq!(svg.matches("<polygon").count(), 3 + 1);
        assert!(svg.contains("3 of 4"));
    }
}
