//! How a population is distributed.

use super::pairs::PairTruth;
use super::training_rig::{Kind, TrainingTruth};
use std::collections::BTreeMap;
use std::fmt::Write;

/// Bounds of the sizes in a table.
const SIZES: [f64; 6] = [0.0, 0.5, 2.0, 8.0, 30.0, f64::INFINITY];

/// Tables of a population: families by kinds; effects by size; bases, borders, orders and laws.
pub fn summary(truths: &[TrainingTruth]) -> String {
    let mut text = String::new();
    let _ = writeln!(text, "{} rigs\n", truths.len());
    families(&mut text, truths);
    let first = truths.iter().filter_map(|truth| truth.effects.first());
    sized(&mut text, "effect", first.map(|effect| (effect.effect.to_owned(), effect.size)));
    counted(&mut text, "bases", truths.iter().map(|t| t.base.clone()));
    counted(&mut text, "borders", truths.iter().map(|t| t.borders.to_owned()));
    counted(&mut text, "orders", truths.iter().map(|t| t.order.to_string()));
    let laws = truths.iter().filter_map(|t| t.effects.first()).map(|e| format!("{}: {}", e.effect, e.law));
    counted(&mut text, "laws", laws);
    text
}

/// Tables of pairs: rows and effects by the size of the difference.
pub fn pair_summary(truths: &[PairTruth]) -> String {
    let named = |truth: &PairTruth| match truth.difference.effect {
        Some((effect, _, side)) => format!("{effect} ({side:?})"),
        None => truth.difference.row.name().to_owned(),
    };
    let mut text = format!(
        "{} pairs, A measured in {}\n\n",
        truths.len(),
        truths.iter().filter(|t| t.is_measured).count()
    );
    sized(&mut text, "difference", truths.iter().map(|truth| (named(truth), truth.size)));
    text
}

fn families(text: &mut String, truths: &[TrainingTruth]) {
    let mut rows: BTreeMap<&str, [usize; 4]> = BTreeMap::new();
    for truth in truths {
        let kind = Kind::ALL.iter().position(|kind| *kind == truth.kind).unwrap_or_default();
        rows.entry(truth.family.name()).or_default()[kind] += 1;
    }
    let _ = writeln!(text, "| family | {} | all |", Kind::ALL.map(Kind::name).join(" | "));
    let _ = writeln!(text, "|---|--:|--:|--:|--:|--:|");
    for (family, counts) in rows {
        let cells = counts.map(|n| n.to_string()).join(" | ");
        let _ = writeln!(text, "| {family} | {cells} | {} |", counts.iter().sum::<usize>());
    }
    text.push('\n');
}

/// Names by size.
fn sized(text: &mut String, title: &str, named: impl Iterator<Item = (String, f64)>) {
    let mut rows: BTreeMap<String, Vec<f64>> = BTreeMap::new();
    named.for_each(|(name, size)| rows.entry(name).or_default().push(size));
    let _ = writeln!(text, "| {title} | rigs | < 0.5 | 0.5–2 | 2–8 | 8–30 | > 30 | median size |");
    let _ = writeln!(text, "|---|--:|--:|--:|--:|--:|--:|--:|");
    for (name, mut sizes) in rows {
        sizes.sort_by(f64::total_cmp);
        let within = |k: usize| sizes.iter().filter(|s| (SIZES[k]..SIZES[k + 1]).contains(*s)).count();
        let cells: Vec<String> = (0..SIZES.len() - 1).map(|k| within(k).to_string()).collect();
        let median = sizes[sizes.len() / 2];
        let _ = writeln!(text, "| {name} | {} | {} | {median:.1} |", sizes.len(), cells.join(" | "));
    }
    text.push('\n');
}

fn counted(text: &mut String, title: &str, names: impl Iterator<Item = String>) {
    let mut counts: BTreeMap<String, usize> = BTreeMap::new();
    names.for_each(|name| *counts.entry(name).or_default() += 1);
    let _ = writeln!(text, "| {title} | rigs |\n|---|--:|");
    for (name, count) in counts {
        let _ = writeln!(text, "| {name} | {count} |");
    }
    text.push('\n');
}
