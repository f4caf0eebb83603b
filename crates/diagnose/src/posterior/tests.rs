use super::*;
use proptest::prelude::*;

const OUTCOMES: [Outcome; 5] =
    [Outcome::Effect, Outcome::Effect, Outcome::Effect, Outcome::Nothing, Outcome::NoneOfThese];

#[test]
fn sure_is_named_two_together_are_a_class_and_the_rest_is_a_shortlist() {
    let limits = Thresholds::default();
    let report = |p: [f64; 5], is_outside: bool| decide(&p, &OUTCOMES, &limits, is_outside);
    assert_eq!(report([0.01, 0.97, 0.01, 0.005, 0.005], false), Decision::Named(1));
    assert_eq!(report([0.01, 0.97, 0.01, 0.005, 0.005], true), Decision::Shortlist(vec![1]));
    assert_eq!(report([0.57, 0.005, 0.41, 0.005, 0.01], false), Decision::Class(vec![0, 2]));
    assert_eq!(report([0.5, 0.1, 0.2, 0.1, 0.1], false), Decision::Shortlist(vec![0, 2, 1]));
    assert_eq!(report([0.2, 0.1, 0.2, 0.3, 0.2], false), Decision::Shortlist(vec![0, 2, 1]));
    assert_eq!(report([0.1, 0.1, 0.1, 0.4, 0.3], false), Decision::None);
    assert_eq!(report([0.2, 0.1, 0.1, 0.1, 0.5], false), Decision::None);
    assert_eq!(decide(&[], &[], &limits, false), Decision::None);
}

#[test]
fn losses_are_twenty_one_and_what_a_class_leaves_open() {
    let losses = Losses::default();
    let of = |decision: Decision, truth: usize| losses.of(&decision, truth, &OUTCOMES);
    assert_eq!(of(Decision::Named(1), 1), 0.0);
    assert_eq!(of(Decision::Named(1), 2), 20.0);
    assert_eq!(of(Decision::Named(1), 3), 20.0);
    assert_eq!(of(Decision::Class(vec![0, 1]), 1), 0.25);
    assert_eq!(of(Decision::Class(vec![0, 1]), 4), 20.0);
    assert_eq!(of(Decision::Shortlist(vec![0]), 0), 1.0);
    assert_eq!(of(Decision::None, 0), 1.0);
    assert_eq!(of(Decision::None, 3), 0.0);
}

proptest! {
    /// The thresholds of the defaults are those of least expected loss where probabilities hold: a name is worth more than silence
    /// from `1 − silence/wrong` on.
    #[test]
    fn what_is_named_costs_less_than_silence(scores in prop::array::uniform5(-4.0..6.0_f64)) {
        let p = softmax(&scores);
        let losses = Losses::default();
        let expected = |report: &Decision| (0..5).map(|k| p[k] * losses.of(report, k, &OUTCOMES)).sum::<f64>();
        let report = decide(&p, &OUTCOMES, &Thresholds::default(), false);
        if matches!(report, Decision::Named(_) | Decision::Class(_)) {
            // Silence costs what the effects weigh.
            let silence: f64 = p[..3].iter().sum();
            prop_assert!(expected(&report) <= silence + 0.2, "{:?} {:?}", report, p);
        }
        if let Decision::Class(class) = &report {
            prop_assert!(class.iter().map(|k| p[*k]).sum::<f64>() >= 0.975);
        }
    }

    #[test]
    fn probabilities_are_positive_and_sum_to_one(scores in prop::collection::vec(-700.0..700.0_f64, 1..30)) {
        let p = softmax(&scores);
        prop_assert!((p.iter().sum::<f64>() - 1.0).abs() < 1e-12);
        prop_assert!(p.iter().all(|p| (0.0..=1.0).contains(p)));
    }
}

fn two_columns() -> Standard {
    Standard { centre: vec![1.0, 0.0], scale: vec![2.0, 1.0] }
}

fn posterior() -> Posterior {
    // x ≤ 0.5 ? (y ≤ −1 ? 2 : −1) : 0.25
    let tree = Tree(vec![
        Node::Split { column: 0, edge: 0, right: 4 },
        Node::Split { column: 1, edge: 1, right: 3 },
        Node::Leaf(2.0),
        Node::Leaf(-1.0),
        Node::Leaf(0.25),
    ]);
    Posterior {
        provenance: "by hand".to_owned(),
        rows: 7,
        prior: Prior { effect: 0.5, none: 0.25, none_of_these: 0.25 },
        thresholds: Thresholds { named: 0.75, class: 0.875, ..Thresholds::default() },
        columns: vec!["x".to_owned(), "y".to_owned()],
        classes: vec!["creep".to_owned(), "none".to_owned()],
        trees: Trees {
            edges: vec![vec![0.5], vec![-2.0, -1.0]],
            start: vec![0.1, -0.1],
            rounds: vec![vec![tree, Tree(vec![Node::Leaf(0.0)])]],
        },
        network: None,
        ranker: None,
        second: None,
        shares: Shares { trees: 1.0, network: 0.0, ranker: 0.0 },
        temperatures: vec![("made".to_owned(), 2.0)],
        novelty: Novelty {
            standard: two_columns(),
            mean: vec![0.0, 0.0],
            directions: vec![vec![0.6, 0.8]],
            variances: vec![3.0],
            left: 0.5,
            held_out: vec![0.1, 0.5, 2.0],
        },
    }
}

#[test]
fn a_tree_goes_left_up_to_its_edge() {
    let scores = |x: f64, y: f64| posterior().trees.scores(&[x, y])[0];
    let near =
        |x: f64, y: f64, expected: f64| assert!((scores(x, y) - 0.1 - expected).abs() < 1e-6, "{x} {y}");
    near(0.5, -1.0, 2.0);
    near(0.5, -0.999, -1.0);
    near(0.501, -5.0, 0.25);
}

#[test]
fn a_temperature_divides_the_logarithm_of_the_odds() {
    let p = posterior().probabilities(&[0.0, -3.0], "made").expect("a population");
    assert!((p.iter().sum::<f64>() - 1.0).abs() < 1e-15);
    assert!(((p[0] / p[1]).ln() - (0.2 + 2.0) / 2.0).abs() < 1e-6, "{p:?}");
}

#[test]
fn the_distance_is_that_of_its_formula() {
    // z = ((3 − 1)/2, 2) = (1, 2): along (0.6, 0.8) 2.2, beyond it √(5 − 4.84).
    let expected: f64 = 0.5 * 2.2 * 2.2 / 3.5 + 0.5 * (5.0 - 4.84) / (2.0 * 0.5);
    let novelty = posterior().novelty;
    assert!((novelty.distance(&[3.0, 2.0]) - expected.sqrt()).abs() < 1e-6);
    assert_eq!(novelty.quantile(&[3.0, 2.0]), 2.0 / 3.0);
}

#[test]
fn bytes_give_the_posterior_back_and_a_changed_one_is_refused_or_read_but_never_trusted_blindly() {
    let bytes = posterior().write();
    assert_eq!(Posterior::read(&bytes).expect("a posterior"), posterior());
    for at in 0..bytes.len() {
        for with in [0, 0xFF] {
            let mut changed = bytes.clone();
            changed[at] = with;
            // Whatever is read evaluates without a panic.
            if let Ok(read) = Posterior::read(&changed) {
                let row = vec![0.3; read.columns.len()];
                assert!(read.raw(&row).iter().all(|p| p.is_finite()));
            }
        }
    }
}
