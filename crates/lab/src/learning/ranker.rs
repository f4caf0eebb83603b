//! Training of the ranker on pairs of a rig and an effect.

use super::binned::Binned;
use super::boosting::{Target, boost};
use super::settings::LearningSettings;
use super::table::Table;
use rand::SeedableRng;
use rand::seq::index::sample;
use rand_chacha::ChaCha8Rng;
use std::collections::{BTreeMap, BTreeSet};
use switchback_diagnose::posterior::{Ranker, Trees};

/// Own columns of classes by name, `CLASS.STATISTIC`, for the statistics that all of these classes have; the rest is common.
fn layout(table: &Table) -> (Vec<u16>, Vec<Vec<u16>>, Vec<u16>) {
    let mut of_class: BTreeMap<usize, BTreeMap<&str, u16>> = BTreeMap::new();
    for (number, column) in table.columns.iter().enumerate() {
        if let Some((class, statistic)) = column.split_once('.')
            && let Some(class) = table.classes.iter().position(|known| known == class)
        {
            of_class.entry(class).or_default().insert(statistic, number as u16);
        }
    }
    let mut shared: Option<BTreeSet<&str>> = None;
    for statistics in of_class.values() {
        let here: BTreeSet<&str> = statistics.keys().copied().collect();
        shared = Some(shared.map_or(here.clone(), |all| all.intersection(&here).copied().collect()));
    }
    let shared = shared.unwrap_or_default();
    let own: Vec<Vec<u16>> = of_class.values().map(|s| shared.iter().map(|name| s[name]).collect()).collect();
    let owned: BTreeSet<u16> = of_class.values().flat_map(BTreeMap::values).copied().collect();
    let common = (0..table.columns.len() as u16).filter(|column| !owned.contains(column)).collect();
    (of_class.keys().map(|class| *class as u16).collect(), own, common)
}

/// Trains a ranker; none where fewer than two classes have columns of their own.
pub(super) fn train_ranker(table: &Table, settings: &LearningSettings) -> Option<Ranker> {
    let (classes, own, common) = layout(table);
    if classes.len() < 2 || own[0].is_empty() {
        return None;
    }
    let width = 2 * own[0].len() + common.len() + 1;
    let trees = Trees { edges: vec![Vec::new(); width], start: vec![0.0], rounds: Vec::new() };
    let mut ranker = Ranker { classes, own, common, trees };
    let (mut values, mut is_cause, mut weights) = (vec![Vec::new(); width], Vec::new(), Vec::new());
    for row in 0..table.rows() {
        let numbers = table.row(row);
        for (effect, weight) in shown(&ranker, table.labels[row], row, settings) {
            let pair = ranker.row(&numbers, effect);
            values.iter_mut().zip(pair).for_each(|(column, x)| column.push(x));
            is_cause.push(usize::from(ranker.classes[effect]) == table.labels[row]);
            weights.push(weight * table.weights[row]);
        }
    }
    ranker.trees = boost(&Binned::new(&values), &Target::Binary(is_cause), &weights, &settings.ranker);
    Some(ranker)
}

/// The effects that a row is shown with: its own, and some others that stand for all others.
fn shown(ranker: &Ranker, label: usize, row: usize, settings: &LearningSettings) -> Vec<(usize, f64)> {
    let own = ranker.classes.iter().position(|class| usize::from(*class) == label);
    let others: Vec<usize> = (0..ranker.classes.len()).filter(|effect| Some(*effect) != own).collect();
    let count = settings.others.min(others.len());
    let mut rng = ChaCha8Rng::seed_from_u64(settings.ranker.seed);
    rng.set_stream(row as u64 | 1 << 40);
    let weight = others.len() as f64 / count.max(1) as f64;
    let mut drawn: Vec<usize> = sample(&mut rng, others.len(), count).into_vec();
    drawn.sort_unstable();
    own.map(|effect| (effect, 1.0))
        .into_iter()
        .chain(drawn.into_iter().map(|k| (others[k], weight)))
        .collect()
}
