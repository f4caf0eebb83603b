use super::*;
use crate::blind::case::Baseline;
use crate::blind::design::Kind;
use crate::examination::{ClosureCheck, Evidence, Reply, Share};

fn case(kind: Kind, truth: &[&'static str], status: &'static str, effects: &[&'static str]) -> Case {
    Case {
        id: 0,
        kind,
        system: 0,
        truth: truth.to_vec(),
        law: "",
        plain: true,
        wanted: 1.0,
        size: 1.0,
        reply: Reply {
            status,
            effects: effects.to_vec(),
            class: Vec::new(),
            stage: None,
            probability: 0.95,
            top: (effects.first().copied().unwrap_or("none"), 0.95),
        },
        baseline: Baseline { lowest_rmse: None, heldout_winner: None, plain_bic: Some("creep") },
        evidence: Evidence::default(),
        closure: None,
        places: Vec::new(),
    }
}

fn reached(cases: &[Case], key: &str) -> Option<f64> {
    let scores = score(cases, &Expect::default());
    scores.measures.into_iter().find(|m| m.key == key).unwrap().reached
}

#[test]
fn a_confounded_is_the_right_class_but_not_exact() {
    let cases = [
        case(Kind::Single, &["backlash"], "named", &["backlash"]),
        case(Kind::Single, &["backlash"], "named", &["gradual_transition"]),
    ];
    assert_eq!(reached(&cases, "exact"), Some(0.5));
    assert_eq!(reached(&cases, "class"), Some(1.0));
    assert_eq!(reached(&cases, "precision"), Some(0.5));
}

#[test]
fn rivals_name_a_cause_and_silence_does_not() {
    let mut rivals = case(Kind::None, &[], "ambiguous", &[]);
    rivals.reply.class = vec!["creep", "stribeck"];
    let cases = [rivals, case(Kind::None, &[], "none", &[]), case(Kind::None, &[], "unexplained", &[])];
    assert_eq!(reached(&cases, "false_alarm"), Some(1.0 / 3.0));
}

#[test]
fn a_class_as_wide_as_the_library_is_no_class() {
    let mut wide = case(Kind::Single, &["creep"], "class", &[]);
    wide.reply.class = vec!["creep", "stribeck", "backlash", "resonance"];
    assert_eq!(reached(&[wide], "class"), Some(0.0));
}

#[test]
fn pairs_count_in_any_order_and_phantoms_are_seconds_of_singles() {
    let cases = [
        case(Kind::Pair, &["creep", "outliers"], "named", &["outliers", "creep"]),
        case(Kind::Pair, &["creep", "outliers"], "named", &["creep"]),
        case(Kind::Single, &["creep"], "named", &["creep", "outliers"]),
    ];
    assert_eq!(reached(&cases, "pairs_exact"), Some(0.5));
    assert_eq!(reached(&cases, "phantom"), Some(1.0));
}

#[test]
fn calibration_error_is_the_distance_of_claim_and_share() {
    let cases: Vec<Case> = (0..20)
        .map(|i| case(Kind::Single, &["creep"], "named", if i < 10 { &["creep"] } else { &["outliers"] }))
        .collect();
    assert!((reached(&cases, "ece").unwrap() - 0.45).abs() < 1e-12);
}

#[test]
fn an_interval_covers_what_the_models_really_close() {
    let mut one = case(Kind::Single, &["creep"], "named", &["creep"]);
    one.closure = Some(ClosureCheck { estimate: 0.9, ci90: [0.85, 0.95], actual: 0.93 });
    let mut other = one.clone();
    other.closure = Some(ClosureCheck { estimate: 0.9, ci90: [0.85, 0.95], actual: 0.97 });
    let cases = [one, other];
    assert_eq!(reached(&cases, "coverage"), Some(0.5));
    assert!((reached(&cases, "closure_error").unwrap() - 0.05).abs() < 1e-12);
}

#[test]
fn an_expectation_that_nothing_shows_is_broken() {
    let expect = Expect { pairs_exact: Some(0.5), ..Expect::default() };
    let scores = score(&[case(Kind::None, &[], "none", &[])], &expect);
    let broken: Vec<_> = scores.measures.iter().filter(|m| m.is_unexpected()).map(|m| m.key).collect();
    assert_eq!(broken, ["pairs_exact"]);
}

#[test]
fn plain_bic_is_judged_on_the_same_rigs() {
    let cases = [case(Kind::Single, &["creep"], "named", &["creep"]), case(Kind::None, &[], "none", &[])];
    let rows = score(&cases, &Expect::default()).baselines;
    assert_eq!((rows[3].rule, rows[3].exact.count, rows[3].false_alarm.count), ("plain BIC", 1, 1));
    assert_eq!((rows[0].exact.count, rows[0].false_alarm.count), (1, 0));
}

#[test]
fn the_confusion_matrix_holds_every_large_single_and_every_none() {
    let cases = [
        case(Kind::Single, &["creep"], "named", &["stribeck"]),
        case(Kind::None, &[], "none", &[]),
        case(Kind::Pair, &["creep", "outliers"], "none", &[]),
    ];
    let confusion = score(&cases, &Expect::default()).confusion;
    assert_eq!(confusion.counts.iter().flatten().sum::<usize>(), 2);
    let row = confusion.rows.iter().position(|r| *r == "creep").unwrap();
    let column = confusion.columns.iter().position(|c| *c == "stribeck").unwrap();
    assert_eq!(confusion.counts[row][column], 1);
}

#[test]
fn an_interval_solves_the_score_equation_and_none_of_many_is_not_none() {
    for (count, of) in [(0, 22), (5, 25), (16, 17), (300, 300)] {
        let share = Share { count, of };
        let p = share.value().unwrap();
        let [low, high] = share.interval().unwrap();
        for end in [low, high].into_iter().filter(|x| *x > 1e-9 && *x < 1.0 - 1e-9) {
            // The ends are where the observed share is 1.96 standard errors of the end away.
            let errors = (p - end).abs() / (end * (1.0 - end) / of as f64).sqrt();
            assert!((errors - 1.96).abs() < 1e-9, "{count} of {of}: {errors}");
        }
    }
    let high = Share { count: 0, of: 22 }.interval().unwrap()[1];
    assert!((high - 1.96 * 1.96 / (22.0 + 1.96 * 1.96)).abs() < 1e-12);
    assert_eq!(Share::default().interval(), None);
}
