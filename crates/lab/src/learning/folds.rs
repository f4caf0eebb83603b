//! Folds that share neither where a rig comes from nor the law of its cause.

use super::table::Table;
use std::collections::BTreeMap;

/// Rows to learn from and rows to judge by.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Fold {
    /// Rows to learn from.
    pub learnt: Vec<usize>,
    /// Rows to judge by.
    pub judged: Vec<usize>,
}

/// The two-way folds of a table: `parts` parts of the bases, made families being bases of their own, times `parts` parts of the laws of each
/// class. A fold judges rows of one part of both, and learns from rows that are in neither part. Every row is judged once.
///
/// Laws are dealt out within their class, so that a class of several laws is in every part; rows without a law are dealt out one by one.
pub fn folds(table: &Table, parts: usize) -> Vec<Fold> {
    let bases = dealt(table.groups.iter().map(|group| group.base.clone()), parts);
    let base: Vec<usize> = table.groups.iter().map(|group| bases[&group.base]).collect();
    let law = laws(table, parts);
    let mut folds = Vec::new();
    for (i, j) in (0..parts).flat_map(|i| (0..parts).map(move |j| (i, j))) {
        let rows = |is: &dyn Fn(usize) -> bool| (0..table.rows()).filter(|r| is(*r)).collect::<Vec<usize>>();
        let judged = rows(&|r| base[r] == i && law[r] == j);
        let learnt = rows(&|r| base[r] != i && law[r] != j);
        if !judged.is_empty() && !learnt.is_empty() {
            folds.push(Fold { learnt, judged });
        }
    }
    folds
}

/// Names to parts of much the same number of rows: the largest first, each to the part that has least.
fn dealt(names: impl Iterator<Item = String>, parts: usize) -> BTreeMap<String, usize> {
    let mut counts: BTreeMap<String, usize> = BTreeMap::new();
    names.for_each(|name| *counts.entry(name).or_default() += 1);
    let mut by_size: Vec<(String, usize)> = counts.into_iter().collect();
    by_size.sort_by(|(a, n), (b, m)| m.cmp(n).then(a.cmp(b)));
    let mut filled = vec![0; parts];
    by_size
        .into_iter()
        .map(|(name, count)| {
            let part = (0..parts).min_by_key(|part| (filled[*part], *part)).unwrap_or_default();
            filled[part] += count;
            (name, part)
        })
        .collect()
}

fn laws(table: &Table, parts: usize) -> Vec<usize> {
    let mut of_rows = vec![0; table.rows()];
    for class in 0..table.classes.len() {
        let rows: Vec<usize> = (0..table.rows()).filter(|r| table.labels[*r] == class).collect();
        let name = |row: usize| match table.groups[row].law.as_str() {
            "" => format!("\u{0}{row}"),
            law => law.to_owned(),
        };
        let parts = dealt(rows.iter().map(|r| name(*r)), parts);
        rows.iter().for_each(|r| of_rows[*r] = parts[&name(*r)]);
    }
    of_rows
}
