//! How a posterior does on each population: its best guess, and what is reported.

use super::table::Table;
use switchback_diagnose::Effect;
use switchback_diagnose::posterior::{Decision, Outcome, Thresholds, decide};

/// Least size of a cause that counts as one that should be found.
const VISIBLE: f64 = 2.0;

/// Shares of one population's rows.
#[derive(Debug, Clone, PartialEq)]
pub struct Population {
    /// Its name.
    pub name: String,
    /// Rows with one visible cause.
    pub causes: usize,
    /// Of these: the cause is the most probable outcome, it is that or confounded with it, the same with each effect counted alike, it is among the first five.
    pub guess: [f64; 4],
    /// Of these: named or reported as a class, and wrong among those; not named but on the shortlist among those not named.
    pub reported: [f64; 3],
    /// Rows with nothing put in, and the share of these for which a cause is named.
    pub nothing: (usize, f64),
    /// Rows with a foreign effect, and the share for which a cause is named.
    pub foreign: (usize, f64),
}

/// Whether two names are the same cause or confounded.
fn is_alike(x: &str, y: &str) -> bool {
    let confounded = |x: &str, y: &str| {
        let [x, y] = [x, y].map(Effect::from_name);
        x.zip(y).is_some_and(|(x, y)| x.confounded_effects().contains(&y))
    };
    x == y || confounded(x, y) || confounded(y, x)
}

/// One population a family, with and without a model, and all together.
pub fn populations(
    table: &Table,
    p: &[Vec<f64>],
    outcomes: &[Outcome],
    thresholds: &Thresholds,
) -> Vec<Population> {
    let mut families: Vec<&str> = table.groups.iter().map(|g| g.family.as_str()).collect();
    families.sort_unstable();
    families.dedup();
    families.push("all");
    let mut all = Vec::new();
    for is_given in [true, false] {
        for family in &families {
            let is = |row: &usize| {
                table.truths[*row].is_given == is_given
                    && (*family == "all" || table.groups[*row].family == *family)
            };
            let rows: Vec<usize> = (0..table.rows()).filter(is).collect();
            let name = format!("{family}, {}", if is_given { "model given" } else { "nothing given" });
            all.push(population(name, table, &rows, (p, outcomes, thresholds)));
        }
    }
    all
}

fn population(
    name: String,
    table: &Table,
    rows: &[usize],
    (p, outcomes, thresholds): (&[Vec<f64>], &[Outcome], &Thresholds),
) -> Population {
    let share = |count: usize, of: usize| count as f64 / of.max(1) as f64;
    let of_kind = |kind: &'static str| rows.iter().copied().filter(move |r| table.truths[*r].kind == kind);
    let decision = |row: usize| decide(&p[row], outcomes, thresholds, false);
    let name_of = |class: usize| table.classes[class].as_str();
    // A machine has effects by itself: whoever names one of these is not wrong.
    let is_right = |row: usize, class: usize| {
        is_alike(name_of(class), name_of(table.labels[row]))
            || table.truths[row].also.iter().any(|also| also == name_of(class))
    };
    let reported = |row: usize| -> Option<bool> {
        match decision(row) {
            Decision::Named(class) => Some(is_right(row, class)),
            Decision::Class(classes) => Some(classes.iter().any(|class| is_right(row, *class))),
            Decision::Shortlist(_) | Decision::None => None,
        }
    };
    let wrongly = |kind: &'static str| {
        let wrong = of_kind(kind).filter(|row| reported(*row) == Some(false)).count();
        (of_kind(kind).count(), share(wrong, of_kind(kind).count()))
    };
    let is_cause =
        |row: &usize| outcomes[table.labels[*row]] == Outcome::Effect && table.truths[*row].size >= VISIBLE;
    let causes: Vec<usize> = of_kind("one").filter(is_cause).collect();
    let first = |row: usize| (0..p[row].len()).max_by(|i, j| p[row][*i].total_cmp(&p[row][*j])).unwrap_or(0);
    let count = |is: &dyn Fn(usize) -> bool| share(causes.iter().filter(|r| is(**r)).count(), causes.len());
    let alike = |row: usize| is_alike(name_of(first(row)), name_of(table.labels[row]));
    let each = (0..table.classes.len()).filter_map(|class| {
        let own: Vec<usize> = causes.iter().copied().filter(|r| table.labels[*r] == class).collect();
        (!own.is_empty()).then(|| share(own.iter().filter(|r| alike(**r)).count(), own.len()))
    });
    let each: Vec<f64> = each.collect();
    let better = |row: usize| p[row].iter().filter(|x| **x > p[row][table.labels[row]]).count();
    let said: Vec<usize> = causes.iter().copied().filter(|r| reported(*r).is_some()).collect();
    let wrong = said.iter().filter(|r| reported(**r) == Some(false)).count();
    let on_list = |row: &usize| match decision(*row) {
        Decision::Shortlist(classes) => classes.iter().any(|class| is_right(*row, *class)),
        _ => false,
    };
    let silent = causes.len() - said.len();
    Population {
        name,
        causes: causes.len(),
        guess: [
            count(&|row| first(row) == table.labels[row]),
            count(&alike),
            each.iter().sum::<f64>() / each.len().max(1) as f64,
            count(&|row| better(row) < 5),
        ],
        reported: [
            share(said.len(), causes.len()),
            share(wrong, said.len()),
            share(causes.iter().filter(|r| on_list(r)).count(), silent),
        ],
        nothing: wrongly("nothing"),
        foreign: wrongly("foreign"),
    }
}
