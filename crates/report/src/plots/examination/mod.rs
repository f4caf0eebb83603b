//! Figures of an examination, drawn from its tables alone.

mod closure;
mod confusion;
mod curves;
mod rules;

use super::Figure;
use switchback_lab::examination::{Design, Scores};

/// Every figure of a design.
pub(crate) fn figures(design: Design, scores: &Scores) -> Vec<Figure> {
    let table = |name: &str| &scores.tables[name];
    let calibration = ("calibration.svg", curves::calibration(&scores.claims.bins));
    let confusion = |large: &str| ("confusion.svg", confusion::confusion(&scores.confusion, large));
    let figures = match design {
        Design::Laboratory => vec![
            confusion("surviving gap ≥ 1 sd"),
            ("accuracy.svg", curves::accuracy(table("sizes"))),
            calibration,
            ("abstention.svg", curves::abstention(table("abstention"))),
            ("closure.svg", closure::closure(&scores.closures)),
            ("baselines.svg", rules::baselines(table("baselines"))),
        ],
        Design::Field => vec![confusion("size ≥ 2"), calibration],
    };
    figures.into_iter().map(|(name, svg)| Figure { name: name.to_owned(), svg }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plots::inspect::check;
    use switchback_lab::examination::{CalibrationBin, Cell, ClosureCheck, Confusion, Share, Table};

    fn share(count: usize, of: usize) -> Share {
        Share { count, of }
    }

    /// A row an item.
    fn table<T>(items: Vec<T>, row: impl Fn(T) -> Vec<(&'static str, Cell)>) -> Table {
        let row = |item: T| row(item).into_iter().map(|(name, cell)| (name.to_owned(), cell)).collect();
        Table { rows: items.into_iter().map(row).collect() }
    }

    fn drawn() -> Vec<String> {
        let confusion = Confusion {
            rows: vec!["creep", "none", "outside", "a very long name of an effect"],
            columns: vec!["creep", "none", "unexplained", "failed"],
            counts: vec![vec![3, 0, 0, 0], vec![0, 370, 0, 1], vec![2, 1, 9, 0], vec![0; 4]],
        };
        let sizes = table(vec![0.5, 1.0, 2.0, 4.0], |size| {
            let shares = [share(9, 10), share(10, 10), share(0, 0), share(0, 10)];
            let names = ["exact", "class", "mismatch_class", "wrong"];
            [("size", Cell::Given(size))]
                .into_iter()
                .chain(names.into_iter().zip(shares.map(Cell::Share)))
                .collect()
        });
        let bins = [(0.24, share(0, 1)), (0.55, share(5, 13)), (0.97, share(375, 376))];
        let bins = bins.map(|(claimed, held)| CalibrationBin { claimed, held });
        let abstention = table(vec![0.0, 0.5, 1.0], |threshold| {
            let shares = [("answered", share(50, 100)), ("right", share(49, 50))];
            let shares = shares.map(|(name, share)| (name, Cell::Share(share)));
            [("threshold", Cell::Given(threshold))].into_iter().chain(shares).collect()
        });
        let closures = [(0.9, 0.91), (-7.0, -3.0), (0.5, 1.9), (0.2, -9.0)]
            .map(|(actual, estimate)| (actual > 0.0, ClosureCheck { estimate, ci90: [0.0, 1.0], actual }));
        let rules = table(vec!["this diagnosis", "lowest RMSE"], |rule| {
            let shares = [share(145, 151), share(0, 37), share(2, 25), share(0, 0)].map(Cell::Share);
            let names = ["exact", "false_alarm", "outside_named", "precision"];
            [("rule", Cell::Word(rule.to_owned()))].into_iter().chain(names.into_iter().zip(shares)).collect()
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
            curves::accuracy(&Table::default()),
            curves::calibration(&[]),
            curves::abstention(&Table::default()),
            closure::closure(&[]),
            rules::baselines(&Table::default()),
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
