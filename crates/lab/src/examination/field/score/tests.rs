use super::*;
use crate::examination::{ClosureCheck, Evidence, Reply, calibration_error};
use crate::field::case::{Answered, Fault};
use crate::field::design::Kind;
use crate::field::seal::How;

/// An answer without the model: a status, and the effects that it points at.
fn answered(status: &'static str, effects: &[&'static str]) -> Answered {
    let (named, class) = if status == "named" { (effects, &[][..]) } else { (&[][..], effects) };
    let reply = Reply {
        status,
        effects: named.to_vec(),
        class: class.to_vec(),
        stage: None,
        probability: 0.9,
        top: ("none", 0.9),
    };
    Answered { with_model: false, reply, by_rules: None, evidence: Evidence::default(), closure: None }
}

fn case(kind: Kind, base: &str, effect: Option<&'static str>, answer: Answered) -> Case {
    let fault = effect.map(|effect| Fault {
        effect,
        law: "some".to_owned(),
        plain: true,
        how: How::Carried,
        wanted: 2.0,
        size: 2.0,
        raw: 3.0,
    });
    Case {
        id: 0,
        kind,
        base: base.to_owned(),
        is_measured: base == "seal",
        own: Vec::new(),
        fault,
        refused: None,
        answers: vec![answer],
    }
}

/// A backlash in a made base.
fn injected(answer: Answered) -> Case {
    case(Kind::Injected, "made-1", Some("backlash"), answer)
}

fn rating(cases: &[Case]) -> Option<Rating> {
    BaseVerdicts::of(cases).asked(cases)[0].rating()
}

fn reached(cases: &[Case], key: &str) -> Option<f64> {
    score(cases, &Expect::default()).measures.into_iter().find(|m| m.key == key).expect("a measure").reached
}

#[test]
fn each_answer_about_a_fault_has_its_worth() {
    let known = [
        ("named", &["backlash"][..], Rating::Exact),
        ("named", &["gradual_transition"], Rating::Class),
        ("named", &["backlash", "gradual_transition"], Rating::Class),
        ("class", &["gradual_transition", "backlash"], Rating::Class),
        ("ambiguous", &["creep", "backlash", "stribeck"], Rating::Class),
        ("ambiguous", &["creep", "backlash", "stribeck", "resonance"], Rating::Wrong),
        ("ambiguous", &["creep", "stribeck"], Rating::Wrong),
        ("named", &["creep"], Rating::Wrong),
        ("named", &["backlash", "creep"], Rating::Wrong),
        ("none", &[], Rating::Silent),
        ("unexplained", &[], Rating::Silent),
        ("refit", &[], Rating::Silent),
        ("failed", &[], Rating::Silent),
    ];
    for (status, effects, worth) in known {
        assert_eq!(rating(&[injected(answered(status, effects))]), Some(worth), "{status} {effects:?}");
    }
}

#[test]
fn other_parameters_are_an_answer_of_their_own() {
    let table = score(&[injected(answered("refit", &[]))], &Expect::default()).confusion;
    let at = |names: &[&str], name: &str| names.iter().position(|n| *n == name).expect(name);
    assert_eq!(table.counts[at(&table.rows, "backlash")][at(&table.columns, "refit")], 1);
    assert_eq!(table.counts.iter().flatten().sum::<usize>(), 1);
}

#[test]
fn what_a_measured_base_shows_by_itself_is_neither_right_nor_wrong() {
    let on_seal =
        |effects: &[&'static str]| case(Kind::Injected, "seal", Some("backlash"), answered("named", effects));
    let bare = |effects: &[&'static str]| case(Kind::Bare, "seal", None, answered("named", effects));
    let rated = |reported: &[&'static str], own: &[&'static str]| rating(&[on_seal(reported), bare(own)]);
    assert_eq!(rated(&["backlash", "creep"], &["creep"]), Some(Rating::Exact));
    assert_eq!(rated(&["creep"], &["creep"]), Some(Rating::Silent));
    assert_eq!(rated(&["outliers"], &["creep"]), Some(Rating::Wrong));
    // A fault that the base shows anyway, and a base whose own verdict is not known.
    assert_eq!(rated(&["backlash"], &["backlash"]), None);
    assert_eq!(rating(&[on_seal(&["backlash"])]), None);
    // The base itself is unlabelled, and repeating what it shows claims nothing that could be checked.
    assert_eq!(rating(&[bare(&["creep"])]), None);
    let cases = [on_seal(&["creep"]), bare(&["creep"])];
    assert_eq!(score(&cases, &Expect::default()).claims.count, 0);
}

#[test]
fn of_negatives_only_what_is_new_is_an_alarm() {
    let made = |status, effects: &[&'static str]| case(Kind::Bare, "made-2", None, answered(status, effects));
    let alarms = [made("named", &["creep"]), made("none", &[]), made("ambiguous", &["creep", "stribeck"])];
    assert_eq!(reached(&alarms, "false_alarm_made"), Some(2.0 / 3.0));
    let mut by_itself = made("named", &["creep"]);
    by_itself.own = vec!["creep"];
    assert_eq!(reached(&[by_itself], "false_alarm_made"), Some(0.0));
    let resampled =
        |effects: &[&'static str]| case(Kind::Resampled, "seal", None, answered("named", effects));
    let bare = case(Kind::Bare, "seal", None, answered("named", &["creep"]));
    let cases = [resampled(&["creep"]), resampled(&["outliers"]), bare];
    assert_eq!(reached(&cases, "false_alarm_resampled"), Some(0.5));
}

#[test]
fn a_foreign_fault_is_no_cause_of_the_library() {
    let foreign = |status, effects: &[&'static str]| {
        case(Kind::Outside, "made-1", Some("thermal_step"), answered(status, effects))
    };
    let cases = [foreign("unexplained", &[]), foreign("named", &["gain_drift"])];
    assert_eq!(reached(&cases, "outside_named"), Some(0.5));
    assert_eq!(reached(&cases, "wrong"), Some(1.0));
    assert_eq!(reached(&cases, "class"), None);
}

#[test]
fn sizes_count_as_reached_and_small_faults_apart() {
    let mut small = injected(answered("none", &[]));
    small.fault.as_mut().expect("a fault").size = 0.49;
    let mut middling = injected(answered("none", &[]));
    middling.fault.as_mut().expect("a fault").size = 1.2;
    let cases = [injected(answered("named", &["backlash"])), small, middling];
    let scores = score(&cases, &Expect::default());
    assert_eq!(scores.not_observable, 1);
    assert_eq!(reached(&cases, "exact"), Some(1.0));
    let reported: Vec<(&str, usize, usize)> =
        scores.by_size.iter().map(|row| (row.of.as_str(), row.asked, row.exact.of)).collect();
    assert_eq!(reported, [("1 to 2", 1, 1), ("2 to 4", 1, 1), ("below ½: not observable", 1, 0)]);
}

#[test]
fn with_the_model_and_without_are_distinguished() {
    let mut case = injected(answered("named", &["backlash"]));
    case.answers.push(Answered { with_model: true, ..answered("none", &[]) });
    let cases = [case];
    assert_eq!((reached(&cases, "exact"), reached(&cases, "model_exact")), (Some(1.0), Some(0.0)));
}

#[test]
fn calibration_is_judged_against_perfect_claims() {
    // Claims of 0.9 of which nine in ten hold: no error, where chance alone would show some.
    let reported =
        |k: usize| injected(answered("named", if k.is_multiple_of(10) { &["creep"] } else { &["backlash"] }));
    let cases: Vec<Case> = (0..100).map(reported).collect();
    let claims = score(&cases, &Expect::default()).claims;
    assert!(claims.error.expect("claims") < 1e-12);
    // The mean distance of a share of 100 from 0.9 is √(2/π)·√(0.9·0.1/100) = 0.0239.
    assert!((claims.perfect.expect("claims") - 0.0239).abs() < 0.003, "{claims:?}");
    assert_eq!(calibration_error(&claims.bins), claims.error);
}

#[test]
fn an_interval_covers_the_share_of_the_gap_that_is_the_faults() {
    let with = |actual: f64| {
        let mut case = injected(answered("named", &["backlash"]));
        let check = ClosureCheck { estimate: 0.8, ci90: [0.7, 0.9], actual };
        case.answers[0] = Answered { with_model: true, closure: Some(check), ..case.answers[0].clone() };
        case
    };
    assert_eq!(reached(&[with(0.75), with(0.95)], "coverage"), Some(0.5));
}

#[test]
fn an_expectation_that_nothing_shows_is_broken() {
    let expect = Expect { model_exact: Some(0.5), ..Expect::default() };
    let scores = score(&[injected(answered("named", &["backlash"]))], &expect);
    let broken: Vec<_> = scores.measures.iter().filter(|m| m.is_unexpected()).map(|m| m.key).collect();
    assert_eq!(broken, ["model_exact"]);
}
