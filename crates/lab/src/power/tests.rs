//! What draws made by hand come to.

use super::*;
use crate::examination::Reply;
use crate::generate::{EFFECTS, InjectedFault, Injection, Nature, Stage};

fn plan(draws: usize) -> Plan {
    Plan { effects: vec!["creep", "backlash"], draws, seed: 7 }
}

fn fault(size: f64) -> InjectedFault {
    InjectedFault {
        effect: "creep",
        law: "logarithmic",
        stage: Stage::Operator,
        nature: Nature::Systematic,
        injection: Injection::Carried,
        magnitude: 0.01 * size,
        unit: crate::generate::INTERVAL_WIDTHS,
        quantity: None,
        wanted: size,
        size,
        raw: 2.0 * size,
        residual: 0.5,
    }
}

fn drawn(size: f64, answer: Answer) -> Draw {
    Draw::Diagnosed { fault: fault(size), answer }
}

fn missed(size: f64, reported: &str) -> Draw {
    drawn(size, Answer::Other(reported.to_owned()))
}

fn refused() -> Draw {
    Draw::Refused("the loop is too narrow".to_owned())
}

fn searched(draws: Vec<Draw>) -> Search {
    let mut search = Search::new("creep", 0.01, &plan(6));
    draws.into_iter().for_each(|draw| search.take(draw));
    search
}

fn finding(draws: Vec<Draw>) -> Finding {
    Finding::of(&searched(draws), &[Reply::refused()])
}

#[test]
fn a_size_is_stated_where_all_from_there_on_are_found() {
    let mut draws: Vec<Draw> = (0..12).map(|k| drawn(2.0 + 0.5 * f64::from(k), Answer::Named)).collect();
    draws.extend([missed(0.6, "nothing"), missed(0.7, "nothing")]);
    let Outcome::From(size) = finding(draws).outcome() else { panic!("it is found") };
    assert!((0.7..3.0).contains(&size), "{size}");
}

#[test]
fn what_is_missed_at_every_size_is_not_found_up_to_the_largest() {
    let always_missed = |largest: f64| finding((0..6).map(|_| missed(largest, "backlash")).collect());
    assert_eq!(always_missed(9.0).outcome(), Outcome::NotUpTo(LARGEST));
    // Of what is larger than anything put in nothing is said.
    assert_eq!(always_missed(1.5).outcome(), Outcome::NotUpTo(1.5));
    assert!(always_missed(9.0).found_at_most < 0.5);
}

#[test]
fn few_draws_leave_it_undecided() {
    let few = finding(vec![drawn(4.0, Answer::Named), missed(1.0, "nothing")]);
    assert_eq!(few.outcome(), Outcome::Undecided);
    assert!((0.5..0.9).contains(&few.found_next), "{}", few.found_next);
}

#[test]
fn what_is_refused_three_times_running_is_given_up() {
    assert!(!searched(vec![refused(), refused()]).is_done(&plan(6)));
    let all = searched(vec![refused(), refused(), refused()]);
    assert!(all.is_done(&plan(6)));
    let outcome = Finding::of(&all, &[]).outcome();
    assert_eq!(outcome, Outcome::NotInjected("the loop is too narrow".to_owned()));
    let between = searched(vec![refused(), refused(), drawn(2.0, Answer::InClass), refused()]);
    assert!(!between.is_done(&plan(6)));
    // One draw each on average, and four at most.
    let many: Vec<Draw> = (0..4).map(|k| drawn(f64::from(k + 1), Answer::Named)).collect();
    assert!(searched(many.clone()).is_done(&plan(1)) && !searched(many).is_done(&plan(2)));
}

#[test]
fn answers_are_counted_by_size_and_kind() {
    let draws = vec![
        drawn(1.5, Answer::Named),
        drawn(1.9, Answer::InClass),
        missed(1.2, "nothing"),
        missed(3.0, "backlash"),
        missed(2.5, "backlash"),
        refused(),
    ];
    let finding = finding(draws);
    assert_eq!(finding.answers(1.0, 2.0), Answers { named: 1, in_class: 1, of: 3 });
    assert_eq!(finding.answers(0.0, f64::INFINITY).of, 5);
    assert_eq!(finding.instead(), Some(("backlash", 2)));
    assert_eq!(finding.reached(), 3.0);
    assert_eq!(finding.closest_to(1.6).map(|fault| fault.size), Some(1.5));
    let power = Power { plan: plan(6), bare: vec![Reply::refused()], findings: vec![finding] };
    assert_eq!(csv(&power).lines().count(), 7);
    assert!(csv(&power).ends_with("creep,6,,,,,,,,the loop is too narrow\n"), "{}", csv(&power));
}

#[test]
fn every_draw_has_a_seed_of_its_own() {
    let plan = plan(3);
    let mut seeds: Vec<u64> = EFFECTS.iter().map(|effect| plan.seed_of(effect)).collect();
    seeds.extend((0..3).map(|k| plan.seed_of_bare(k)));
    seeds.sort_unstable();
    seeds.dedup();
    assert_eq!(seeds.len(), EFFECTS.len() + 3);
    // An effect's draws do not depend on what else is asked for.
    let alone = Plan { effects: vec!["creep"], ..plan.clone() };
    assert_eq!(alone.seed_of("creep"), plan.seed_of("creep"));
    assert_eq!((plan.budget(), plan.diagnoses(), plan.most()), (6, 9, 12));
}
