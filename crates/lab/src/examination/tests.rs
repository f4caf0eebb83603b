//! Scores of cases made by hand, one of each kind of answer.

use super::calibration::calibration_error;
use super::case::{Answered, Baseline, Case};
use super::design::{Design, Kind};
use super::fault::Fault;
use super::how::How;
use super::measure::{Bound, Expect};
use super::rating::{BaseVerdicts, Rating};
use super::reply::{ClosureCheck, Evidence, Reply};
use super::results::not_observable;
use super::scores::Scores;
use super::table::{Cell, Table};
use super::{field, laboratory};
use switchback_diagnose::Status;

/// An answer: a status, and the effects that it points at.
fn answered(status: &'static str, effects: &[&'static str]) -> Answered {
    let (named, class) = if status == "named" { (effects, &[][..]) } else { (&[][..], effects) };
    let reply = Reply {
        status,
        effects: named.to_vec(),
        class: class.to_vec(),
        stage: None,
        probability: 0.9,
        top: (named.first().copied().unwrap_or("none"), 0.9),
    };
    Answered {
        with_model: false,
        reply,
        evidence: Evidence::default(),
        closure: None,
        baseline: Some(Baseline { plain_bic: Some("creep"), ..Baseline::default() }),
        places: Vec::new(),
    }
}

fn fault(effect: &'static str) -> Fault {
    Fault {
        effect,
        law: "some".to_owned(),
        plain: true,
        how: How::Carried,
        wanted: 2.0,
        size: 2.0,
        raw: Some(3.0),
    }
}

fn case(kind: Kind, base: &str, truth: &[&'static str], answer: Answered) -> Case {
    let mut faults = truth.iter().map(|effect| fault(effect));
    Case {
        id: 0,
        kind,
        base: base.to_owned(),
        is_measured: base == "seal",
        own: Vec::new(),
        fault: faults.next(),
        second: faults.next(),
        refused: None,
        answers: vec![answer],
    }
}

/// A rig of the laboratory.
fn drawn(kind: Kind, truth: &[&'static str], status: &'static str, effects: &[&'static str]) -> Case {
    case(kind, "0", truth, answered(status, effects))
}

/// A backlash in a made base.
fn injected(answer: Answered) -> Case {
    case(Kind::Injected, "made-1", &["backlash"], answer)
}

fn scored(design: Design, cases: &[Case], expect: &Expect) -> Scores {
    match design {
        Design::Laboratory => laboratory::score(cases, expect),
        Design::Field => field::score(cases, expect),
    }
}

fn scores(design: Design, cases: &[Case]) -> Scores {
    scored(design, cases, &Expect::new())
}

fn reached_in(design: Design, cases: &[Case], key: &str) -> Option<f64> {
    scores(design, cases).measures.into_iter().find(|m| m.key == key).expect("a measure").reached
}

fn reached_blind(cases: &[Case], key: &str) -> Option<f64> {
    reached_in(Design::Laboratory, cases, key)
}

fn reached(cases: &[Case], key: &str) -> Option<f64> {
    reached_in(Design::Field, cases, key)
}

fn rating(cases: &[Case]) -> Option<Rating> {
    BaseVerdicts::of(cases).asked(cases)[0].rating()
}

#[test]
fn an_expectation_that_nothing_shows_is_broken() {
    for (design, key, case) in [
        (Design::Laboratory, "pairs_exact", drawn(Kind::Bare, &[], "none", &[])),
        (Design::Field, "model_exact", injected(answered("named", &["backlash"]))),
    ] {
        let expect = Expect::from([(key.to_owned(), Bound::AtLeast(0.5))]);
        let measures = scored(design, &[case], &expect).measures;
        let broken: Vec<_> = measures.iter().filter(|m| m.is_unexpected()).map(|m| &m.key).collect();
        assert_eq!(broken, [key]);
    }
}

#[test]
fn a_confounded_is_the_right_class_but_not_exact() {
    let cases = [
        drawn(Kind::Injected, &["backlash"], "named", &["backlash"]),
        drawn(Kind::Injected, &["backlash"], "named", &["gradual_transition"]),
    ];
    assert_eq!(reached_blind(&cases, "exact"), Some(0.5));
    assert_eq!(reached_blind(&cases, "class"), Some(1.0));
    assert_eq!(reached_blind(&cases, "precision"), Some(0.5));
}

#[test]
fn rivals_name_a_cause_and_silence_does_not() {
    let rivals = drawn(Kind::Bare, &[], "ambiguous", &["creep", "stribeck"]);
    let cases = [rivals, drawn(Kind::Bare, &[], "none", &[]), drawn(Kind::Bare, &[], "unexplained", &[])];
    assert_eq!(reached_blind(&cases, "false_alarm"), Some(1.0 / 3.0));
}

#[test]
fn a_class_as_wide_as_the_library_is_no_class() {
    let wide = drawn(Kind::Injected, &["creep"], "class", &["creep", "stribeck", "backlash", "resonance"]);
    assert_eq!(reached_blind(&[wide], "class"), Some(0.0));
}

#[test]
fn pairs_count_in_any_order_and_phantoms_are_seconds_of_singles() {
    let cases = [
        drawn(Kind::Pair, &["creep", "outliers"], "named", &["outliers", "creep"]),
        drawn(Kind::Pair, &["creep", "outliers"], "named", &["creep"]),
        drawn(Kind::Injected, &["creep"], "named", &["creep", "outliers"]),
    ];
    assert_eq!(reached_blind(&cases, "pairs_exact"), Some(0.5));
    assert_eq!(reached_blind(&cases, "phantom"), Some(1.0));
}

#[test]
fn calibration_error_is_the_distance_of_claim_and_share() {
    let reported = |i: usize| if i < 10 { &["creep"] } else { &["outliers"] };
    let cases: Vec<Case> = (0..20).map(|i| drawn(Kind::Injected, &["creep"], "named", reported(i))).collect();
    assert!((reached_blind(&cases, "ece").unwrap() - 0.4).abs() < 1e-12);
}

#[test]
fn an_interval_covers_what_really_closes() {
    let with = |design: Design, actual: f64| {
        let mut case = match design {
            Design::Laboratory => drawn(Kind::Injected, &["creep"], "named", &["creep"]),
            Design::Field => injected(answered("named", &["backlash"])),
        };
        case.answers[0].closure = Some(ClosureCheck { estimate: 0.8, ci90: [0.7, 0.9], actual });
        case
    };
    for design in Design::ALL {
        let cases = [with(design, 0.75), with(design, 0.95)];
        assert_eq!(reached_in(design, &cases, "coverage"), Some(0.5));
    }
    let cases = [with(Design::Laboratory, 0.75), with(Design::Laboratory, 0.95)];
    assert!((reached_blind(&cases, "closure_error").unwrap() - 0.1).abs() < 1e-12);
}

#[test]
fn plain_bic_is_judged_on_the_same_rigs() {
    let cases = [drawn(Kind::Injected, &["creep"], "named", &["creep"]), drawn(Kind::Bare, &[], "none", &[])];
    let rows = &scores(Design::Laboratory, &cases).tables["baselines"].rows;
    let counts = |k: usize| ["exact", "false_alarm"].map(|name| Table::share(&rows[k], name).count);
    assert_eq!((counts(0), counts(3)), ([1, 0], [1, 1]));
}

#[test]
fn the_confusion_matrix_holds_every_large_single_and_every_none() {
    let cases = [
        drawn(Kind::Injected, &["creep"], "named", &["stribeck"]),
        drawn(Kind::Bare, &[], "none", &[]),
        drawn(Kind::Pair, &["creep", "outliers"], "none", &[]),
    ];
    let confusion = scores(Design::Laboratory, &cases).confusion;
    assert_eq!(confusion.counts.iter().flatten().sum::<usize>(), 2);
    let row = confusion.rows.iter().position(|r| *r == "creep").unwrap();
    let column = confusion.columns.iter().position(|c| *c == "stribeck").unwrap();
    assert_eq!(confusion.counts[row][column], 1);
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
fn every_answer_that_names_nothing_has_a_column_of_its_own() {
    for status in
        Status::ALL.map(Status::name).into_iter().filter(|status| *status != "named").chain(["failed"])
    {
        for (design, case) in [
            (Design::Field, injected(answered(status, &["creep"]))),
            (Design::Laboratory, drawn(Kind::Injected, &["backlash"], status, &["creep"])),
        ] {
            let table = scores(design, &[case]).confusion;
            let at = |names: &[&str], name: &str| names.iter().position(|n| *n == name).expect(name);
            assert_eq!(table.counts[at(&table.rows, "backlash")][at(&table.columns, status)], 1, "{status}");
            assert_eq!(table.counts.iter().flatten().sum::<usize>(), 1);
        }
    }
}

#[test]
fn what_a_measured_base_shows_by_itself_is_neither_right_nor_wrong() {
    let on_seal =
        |effects: &[&'static str]| case(Kind::Injected, "seal", &["backlash"], answered("named", effects));
    let bare = |effects: &[&'static str]| case(Kind::Bare, "seal", &[], answered("named", effects));
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
    assert_eq!(scores(Design::Field, &cases).claims.count, 0);
}

#[test]
fn of_negatives_only_what_is_new_is_an_alarm() {
    let made = |status, effects: &[&'static str]| case(Kind::Bare, "made-2", &[], answered(status, effects));
    let alarms = [made("named", &["creep"]), made("none", &[]), made("ambiguous", &["creep", "stribeck"])];
    assert_eq!(reached(&alarms, "false_alarm_made"), Some(2.0 / 3.0));
    let mut by_itself = made("named", &["creep"]);
    by_itself.own = vec!["creep"];
    assert_eq!(reached(&[by_itself], "false_alarm_made"), Some(0.0));
    let resampled = |effects: &[&'static str]| case(Kind::Resampled, "seal", &[], answered("named", effects));
    let bare = case(Kind::Bare, "seal", &[], answered("named", &["creep"]));
    let cases = [resampled(&["creep"]), resampled(&["outliers"]), bare];
    assert_eq!(reached(&cases, "false_alarm_resampled"), Some(0.5));
}

#[test]
fn a_foreign_fault_is_no_cause_of_the_library() {
    let foreign = |status, effects: &[&'static str]| {
        case(Kind::Outside, "made-1", &["thermal_step"], answered(status, effects))
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
    let scores = scores(Design::Field, &cases);
    assert_eq!(not_observable(&cases), 1);
    assert_eq!(reached(&cases, "exact"), Some(1.0));
    let rows = &scores.tables["by_size"].rows;
    let reported =
        rows.iter().map(|row| (row["of"].clone(), row["answers"].clone(), Table::share(row, "exact").of));
    let expected = [("1 to 2", 1), ("2 to 4", 1), ("below ½: not observable", 0)];
    let expected = expected.map(|(of, judged)| (Cell::word(of), Cell::Count(1), judged));
    assert_eq!(reported.collect::<Vec<_>>(), expected);
}

#[test]
fn with_the_model_and_without_are_distinguished() {
    let mut case = injected(answered("named", &["backlash"]));
    case.answers.push(Answered { with_model: true, ..answered("none", &[]) });
    let cases = [case];
    assert_eq!((reached(&cases, "exact"), reached(&cases, "model_exact")), (Some(1.0), Some(0.0)));
}

#[test]
fn a_fault_that_is_not_named_may_be_guessed_or_listed() {
    let listed = |top, effects: &[&'static str]| {
        let mut answer = answered("shortlist", &[]);
        (answer.reply.class, answer.reply.top) = (effects.to_vec(), (top, 0.4));
        injected(answer)
    };
    let named = injected(answered("named", &["backlash"]));
    let cases = [
        listed("gradual_transition", &["gradual_transition", "backlash"]),
        listed("creep", &["creep", "outliers"]),
        named,
    ];
    assert_eq!(reached(&cases[..2], "guess"), Some(0.5));
    assert_eq!(reached(&cases, "listed"), Some(0.5));
    assert_eq!(reached(&cases, "model_listed"), None);
}

#[test]
fn a_list_claims_that_the_fault_is_among_its_effects() {
    let share = |design, cases: &[Case]| match &scores(design, cases).claims.bins[..] {
        [bin] => bin.held.value(),
        _ => None,
    };
    let lists = [&["creep", "backlash"][..], &["creep", "outliers"]];
    let listed = lists.map(|effects| injected(answered("shortlist", effects)));
    assert_eq!(share(Design::Field, &listed), Some(0.5));
    let drawn = lists.map(|effects| drawn(Kind::Injected, &["backlash"], "shortlist", effects));
    assert_eq!(share(Design::Laboratory, &drawn), Some(0.5));
    // Values that are off, and nothing missing.
    let off = || answered("parameters", &[]);
    let cases = [injected(off()), case(Kind::Bare, "made-2", &[], off())];
    assert_eq!(share(Design::Field, &cases), Some(0.5));
}

#[test]
fn calibration_is_judged_against_perfect_claims() {
    // Claims of 0.9 of which nine in ten hold: no error, where chance alone would show some.
    let reported =
        |k: usize| injected(answered("named", if k.is_multiple_of(10) { &["creep"] } else { &["backlash"] }));
    let cases: Vec<Case> = (0..100).map(reported).collect();
    let claims = scores(Design::Field, &cases).claims;
    assert!(claims.error.expect("claims") < 1e-12);
    // The mean distance of a share of 100 from 0.9 is √(2/π)·√(0.9·0.1/100) = 0.0239.
    assert!((claims.perfect.expect("claims") - 0.0239).abs() < 0.003, "{claims:?}");
    assert_eq!(calibration_error(&claims.bins), claims.error);
}
