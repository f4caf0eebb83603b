//! Training of the ranker on pairs of a rig and an outcome.

use super::binned::Binned;
use super::boosting::{Target, boost};
use super::settings::LearningSettings;
use super::table::Table;
use std::collections::{BTreeMap, BTreeSet};
use switchback_diagnose::posterior::{Ranker, Trees};

/// Own columns of classes by name, `CLASS.STATISTIC`, for the statistics that all classes with such columns have; the rest is common.
fn layout(table: &Table) -> (Vec<Vec<u16>>, Vec<u16>) {
    let mut of_class: BTreeMap<usize, BTreeMap<&str, u16>> = BTreeMap::new();
    let mut owned: BTreeSet<u16> = BTreeSet::new();
    for (number, column) in table.columns.iter().enumerate() {
        let Some((class, statistic)) = column.split_once('.') else { continue };
        owned.insert(number as u16);
        if let Some(class) = table.classes.iter().position(|known| known == class) {
            of_class.entry(class).or_default().insert(statistic, number as u16);
        }
    }
    let mut shared: Option<BTreeSet<&str>> = None;
    for statistics in of_class.values() {
        let here: BTreeSet<&str> = statistics.keys().copied().collect();
        shared = Some(shared.map_or(here.clone(), |all| all.intersection(&here).copied().collect()));
    }
    let shared = shared.unwrap_or_default();
    let own = |class: usize| {
        let statistics = of_class.get(&class);
        statistics.map_or_else(Vec::new, |s| shared.iter().map(|name| s[name]).collect())
    };
    let common = (0..table.columns.len() as u16).filter(|column| !owned.contains(column)).collect();
    ((0..table.classes.len()).map(own).collect(), common)
}

/// Trains a ranker; none where fewer than two classes have columns of their own.
pub(super) fn train_ranker(table: &Table, settings: &LearningSettings) -> Option<Ranker> {
    let (own, common) = layout(table);
    if own.iter().filter(|own| !own.is_empty()).count() < 2 {
        return None;
    }
    let trees = Trees { edges: Vec::new(), start: vec![0.0], rounds: Vec::new() };
    let mut ranker = Ranker { own, common, trees };
    let classes = table.classes.len();
    let mut values: Vec<Vec<f64>> = vec![Vec::with_capacity(table.rows() * classes); ranker.width()];
    for row in 0..table.rows() {
        let numbers = table.row(row);
        for class in 0..classes {
            let pair = ranker.row(&numbers, class);
            values.iter_mut().zip(pair).for_each(|(column, x)| column.push(x));
        }
    }
    let weights: Vec<f64> = table.weights.iter().flat_map(|w| std::iter::repeat_n(*w, classes)).collect();
    let target = Target::Choice(table.labels.clone(), classes);
    ranker.trees = boost(&Binned::new(&values), &target, &weights, &settings.ranker);
    Some(ranker)
}
