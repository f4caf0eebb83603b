use super::*;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use switchback_diagnose::posterior::{Decision, Losses, Outcome, Posterior, PosteriorError, decide};
use switchback_io::output::sha256;

/// Four classes of which three have columns of their own, each large where its class holds.
fn table(rows: usize, seed: u64) -> Table {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let classes = ["backlash", "creep", "none", "slack"];
    let names = [
        "backlash.gain",
        "backlash.share",
        "creep.gain",
        "creep.share",
        "kurtosis",
        "slack.gain",
        "slack.share",
    ];
    let mut text = format!("label,weight,family,law,base,size,kind,given,also,{}\n", names.join(","));
    for row in 0..rows {
        let class = row % 4;
        let values: Vec<String> = names
            .iter()
            .map(|name| {
                let noise: f64 = StandardNormal.sample(&mut rng);
                let shift = if name.starts_with(classes[class]) { 2.0 } else { 0.0 };
                format!("{}", shift + noise)
            })
            .collect();
        let law = if class == 2 { String::new() } else { format!("{}-{}", classes[class], row / 4 % 3) };
        let base = format!("base-{}", rng.random_range(0..6));
        text += &format!(
            "{},1,{},{law},{base},2,one,no,,{}\n",
            classes[class],
            ["made", "measured"][row % 2],
            values.join(",")
        );
    }
    Table::from_csv(&text).expect("a table")
}

fn small() -> LearningSettings {
    let trees = BoostingSettings {
        rounds: 25,
        leaves: 6,
        least_rows: 5,
        columns: 0.6,
        ..BoostingSettings::default()
    };
    LearningSettings {
        ranker: BoostingSettings { rounds: 30, ..trees.clone() },
        trees,
        network: NetworkSettings {
            hidden: [12, 8],
            epochs: 20,
            batch: 16,
            rate: 5e-3,
            ..NetworkSettings::default()
        },
        directions: 3,
        folds: 2,
    }
}

#[test]
fn a_small_posterior_has_the_same_bytes_every_time_and_says_the_same_when_it_is_read() {
    let table = table(240, 3);
    let one = fit(&table, &small(), "a test").expect("enough rows").posterior;
    let bytes = one.write();
    let serial = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a pool");
    assert_eq!(
        bytes,
        serial.install(|| fit(&table, &small(), "a test")).expect("enough rows").posterior.write()
    );
    assert_eq!(&sha256(&bytes)[..16], "5a03cd2641b5afa5");
    let read = Posterior::read(&bytes).expect("a posterior");
    assert_eq!(read, one);
    let mut right = 0;
    for row in 0..table.rows() {
        let named: Vec<(&str, f64)> =
            table.columns.iter().map(String::as_str).zip(table.row(row)).rev().collect();
        let p = read.probabilities(&read.row(&named).expect("a row"), "made").expect("a population");
        assert!((p.iter().sum::<f64>() - 1.0).abs() < 1e-12 && p.iter().all(|p| *p >= 0.0));
        right += usize::from((0..4).all(|k| p[k] <= p[table.labels[row]]));
    }
    assert!(right > 180, "{right}");
    let mut far = table.row(0);
    let near = read.novelty.quantile(&far);
    far.iter_mut().for_each(|x| *x += 40.0);
    assert!(near < 1.0 && read.novelty.quantile(&far) == 1.0);
}

#[test]
fn what_is_no_posterior_and_columns_that_do_not_fit_are_refused() {
    let one = fit(&table(80, 3), &small(), "a test").expect("enough rows").posterior;
    let bytes = one.write();
    assert_eq!(Posterior::read(b"PK\x03\x04").expect_err("refused"), PosteriorError::NoPosterior);
    for end in (8..bytes.len()).step_by(97) {
        assert!(matches!(Posterior::read(&bytes[..end]), Err(PosteriorError::Damaged { .. })), "{end}");
    }
    let longer = [&bytes[..], &[0]].concat();
    assert!(matches!(Posterior::read(&longer), Err(PosteriorError::Damaged { .. })));
    let mut other = bytes.clone();
    other[4] = 9;
    assert_eq!(Posterior::read(&other).expect_err("refused"), PosteriorError::Version { found: 9, known: 2 });
    let named: Vec<(&str, f64)> = one.columns.iter().map(|c| (c.as_str(), 0.0)).collect();
    assert!(matches!(one.row(&named[1..]), Err(PosteriorError::MissingColumn(_))));
    let extra = [&named[..], &[("further", 0.0)]].concat();
    assert_eq!(one.row(&extra).expect_err("refused"), PosteriorError::UnknownColumn("further".to_owned()));
    let bad: Vec<(&str, f64)> = named.iter().map(|(n, _)| (*n, f64::NAN)).collect();
    assert!(matches!(one.row(&bad), Err(PosteriorError::NotFinite { .. })));
    let row = one.row(&named).expect("a row");
    assert!(matches!(one.probabilities(&row, "ship"), Err(PosteriorError::UnknownPopulation { .. })));
}

#[test]
fn folds_share_neither_base_nor_law_and_judge_every_row_once() {
    let table = table(240, 5);
    let folds = folds(&table, 3);
    let mut judged: Vec<usize> = folds.iter().flat_map(|fold| fold.judged.clone()).collect();
    judged.sort_unstable();
    assert_eq!(judged, (0..240).collect::<Vec<usize>>());
    for fold in &folds {
        for row in &fold.judged {
            let group = &table.groups[*row];
            let shares = |other: &usize| {
                let other = &table.groups[*other];
                other.base == group.base || (!group.law.is_empty() && other.law == group.law)
            };
            assert!(!fold.learnt.iter().any(shares), "{group:?}");
        }
    }
}

#[test]
fn learners_learn_and_more_rows_teach_more() {
    let comparison = compare(&table(480, 9), &small());
    let log = |name: &str, share: f64| {
        let found = comparison.iter().find(|c| c.name == name && c.share == share);
        found.expect("a learner").scores.log
    };
    // Knowing nothing costs ln 4 = 1.39 nats.
    for name in ["trees", "network", "ranker", "together"] {
        assert!(log(name, 1.0) < 1.0, "{name}: {}", log(name, 1.0));
    }
    assert!(log("trees", 1.0) < log("trees", 0.25), "{} {}", log("trees", 1.0), log("trees", 0.25));
    assert!(log("together", 1.0) <= log("trees", 1.0));
}

#[test]
fn a_cell_that_is_no_number_is_named() {
    let header = "label,weight,family,law,base,size,kind,given,also,x\n";
    let bad = |text: &str| Table::from_csv(&format!("{header}{text}")).expect_err("refused").to_string();
    assert_eq!(bad("a,1,f,l,b,2,one,no,,x\n"), "line 2, column `x`: `x` is no finite number; correct it");
    assert_eq!(
        bad("a,1,f,l,b,2,one,no,,1\nb,0,f,l,b,2,one,no,,1\n"),
        "line 3, column `weight`: `0` is no positive number; correct it"
    );
    assert!(bad("a,1,f,l,b,2,one,no,,1\n").contains("1 rows in 1 classes"));
    assert!(matches!(Table::from_csv("label,x\n"), Err(TableError::Header("weight"))));
}

#[test]
fn a_table_of_which_nothing_can_be_held_out_is_refused() {
    let few = table(240, 3).of_rows(&[0, 1]);
    assert_eq!(fit(&few, &small(), "a test").expect_err("refused"), TableError::NotHeldOut { rows: 2 });
}

#[test]
fn thresholds_rise_until_names_are_right() {
    let outcomes = outcomes(&["creep".to_owned(), "none".to_owned(), "slack".to_owned()]);
    assert_eq!(outcomes, [Outcome::Effect, Outcome::Nothing, Outcome::Effect]);
    // At 0.9 every other name is wrong, at 0.97 none.
    let mut p = vec![vec![0.9, 0.04, 0.06]; 40];
    p.extend(vec![vec![0.97, 0.01, 0.02]; 40]);
    let labels: Vec<usize> = (0..80).map(|k| if k < 40 && k % 2 == 0 { 1 } else { 0 }).collect();
    let (thresholds, loss) = fit_thresholds(&p, &labels, &outcomes, &Losses::default());
    assert!(thresholds.named > 0.9 && thresholds.named <= 0.97, "{thresholds:?}");
    assert_eq!(decide(&p[0], &outcomes, &thresholds, false), Decision::Shortlist(vec![0, 2]));
    assert!((loss - 0.5).abs() < 1e-12, "{loss}");
}
