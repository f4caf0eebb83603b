//! Methods and borders against each other on the same noise.
//!
//! Nothing more need be summed for it: a section of the replicates is the same noise in every cell, so a jackknife that leaves a section out of
//! both sides at once has the error of their ratio or difference, however they are correlated.

use super::cell::CellSpec;
use super::views::{CellViews, Figures, Jackknifed, View, mean};
use crate::results::{
    Comparison, Group, Overall, Paired, PairedGroup, PairedParameter, Pairing, Series, Subject,
};
use rayon::prelude::*;

/// Every comparison; `groups` are the cells that share their noise, in their order.
pub(super) fn pairing(specs: &[CellSpec], views: &[CellViews], groups: &[Vec<usize>]) -> Pairing {
    let table = Table { specs, views };
    let mut pairs: Vec<Pair> = groups.iter().flat_map(|group| table.pairs_of_methods(group)).collect();
    let borders: Vec<Pair> = groups.iter().flat_map(|group| table.pairs_of_borders(group)).collect();
    let largest = specs.iter().map(|s| s.samples).max().unwrap_or_default();
    let mut overall = table.overall(&pairs, largest, |series| Subject::Method(series.method.clone()));
    overall.extend(table.overall(&borders, largest, |series| Subject::Border(series.border.clone())));
    pairs.extend(borders);
    Pairing { overall, comparisons: table.comparisons(&pairs, largest) }
}

/// Two cells that differ in their method or their border only, and the parameters that both estimate.
#[derive(Debug)]
struct Pair {
    cell: usize,
    over: usize,
    /// Index in either cell.
    parameters: Vec<(usize, usize)>,
}

/// The cells, each with what its replicates said.
struct Table<'a> {
    specs: &'a [CellSpec],
    views: &'a [CellViews],
}

/// A cell, and the index of a parameter in it.
type Side<'a> = (&'a CellViews, usize);

/// One parameter in two cells.
#[derive(Clone, Copy)]
struct Match<'a> {
    cell: Side<'a>,
    over: Side<'a>,
}

impl<'a> Table<'a> {
    /// Each parameter of a cell with the first method that estimates it too.
    fn pairs_of_methods(&self, group: &[usize]) -> Vec<Pair> {
        let of_cell = |(place, &cell): (usize, &usize)| {
            let before = group[..place].iter().copied();
            let before: Vec<usize> = before.filter(|&over| self.differ_in_method(cell, over)).collect();
            let mut pairs: Vec<Pair> = Vec::new();
            for k in 0..self.specs[cell].parameters.len() {
                let first = before.iter().find_map(|&over| Some((over, self.twin(cell, k, over)?)));
                let Some((over, twin)) = first else { continue };
                match pairs.iter_mut().find(|p| p.over == over) {
                    Some(pair) => pair.parameters.push((k, twin)),
                    None => pairs.push(Pair { cell, over, parameters: vec![(k, twin)] }),
                }
            }
            pairs
        };
        group.par_iter().enumerate().flat_map_iter(of_cell).collect()
    }

    /// Each cell with the same of the first border.
    fn pairs_of_borders(&self, group: &[usize]) -> Vec<Pair> {
        let of_cell = |(place, &cell): (usize, &usize)| {
            let over = group[..place].iter().copied().find(|&over| self.differ_in_border(cell, over))?;
            let parameters: Vec<(usize, usize)> = (0..self.specs[cell].parameters.len())
                .filter_map(|k| Some((k, self.twin(cell, k, over)?)))
                .collect();
            (!parameters.is_empty()).then_some(Pair { cell, over, parameters })
        };
        group.par_iter().enumerate().filter_map(of_cell).collect()
    }

    fn differ_in_method(&self, cell: usize, over: usize) -> bool {
        let (one, other) = (&self.specs[cell].series, &self.specs[over].series);
        self.share_design(cell, over) && one.method != other.method && one.border == other.border
    }

    fn differ_in_border(&self, cell: usize, over: usize) -> bool {
        let (one, other) = (&self.specs[cell].series, &self.specs[over].series);
        self.share_design(cell, over) && one.method == other.method && one.border != other.border
    }

    /// Whether two cells agree in all but method and border.
    fn share_design(&self, cell: usize, over: usize) -> bool {
        let (cell, over) = (&self.specs[cell], &self.specs[over]);
        let (one, other) = (&cell.series, &over.series);
        cell.samples == over.samples
            && (one.points, one.noise, &one.case) == (other.points, other.noise, &other.case)
    }

    /// The parameter of the same name and place in another cell.
    fn twin(&self, cell: usize, k: usize, over: usize) -> Option<usize> {
        let name = &self.specs[cell].parameters[k];
        self.specs[over].parameters.iter().position(|other| other == name)
    }

    fn matches<'p>(&self, pair: &'p Pair) -> impl Iterator<Item = Match<'a>> + use<'a, 'p> {
        let (cell, over) = (&self.views[pair.cell], &self.views[pair.over]);
        pair.parameters.iter().map(move |&(k, twin)| Match { cell: (cell, k), over: (over, twin) })
    }

    /// All pairs of a case and subject in one, at the largest number of samples.
    fn overall(
        &self,
        pairs: &[Pair],
        samples: usize,
        subject: impl Fn(&Series) -> Subject + Sync,
    ) -> Vec<Overall> {
        let mut gathered: Vec<(&str, Subject, Vec<&Pair>)> = Vec::new();
        for pair in pairs.iter().filter(|p| self.specs[p.cell].samples == samples) {
            let series = &self.specs[pair.cell].series;
            let (case, own) = (series.case.as_str(), subject(series));
            match gathered.iter_mut().find(|g| g.0 == case && g.1 == own) {
                Some((.., pairs)) => pairs.push(pair),
                None => gathered.push((case, own, vec![pair])),
            }
        }
        let entry = |(case, own, pairs): (&str, Subject, Vec<&Pair>)| {
            let matches: Vec<Match<'_>> = pairs.iter().flat_map(|p| self.matches(p)).collect();
            let mut over: Vec<String> = Vec::new();
            for pair in pairs {
                let name = subject(&self.specs[pair.over].series).to_string();
                if !over.contains(&name) {
                    over.push(name);
                }
            }
            Some(Overall {
                case: case.to_owned(),
                subject: own,
                over,
                samples,
                parameters: matches.len(),
                variance_ratio: ratio(&matches, |f| Some(f.variance))?,
                variance_ratio_controlled: ratio(&matches, |f| f.variance_controlled),
                mse_ratio: ratio(&matches, |f| Some(f.mse))?,
            })
        };
        gathered.into_par_iter().filter_map(entry).collect()
    }

    fn comparisons(&self, pairs: &[Pair], largest: usize) -> Vec<Comparison> {
        let figures = |pair: &Pair| {
            let at_largest = self.specs[pair.cell].samples == largest;
            (self.groups(pair), if at_largest { self.parameters(pair) } else { Vec::new() })
        };
        let figures: Vec<_> = pairs.par_iter().map(figures).collect();
        let mut comparisons: Vec<Comparison> = Vec::new();
        for (pair, (groups, parameters)) in pairs.iter().zip(figures) {
            let (series, over) = (&self.specs[pair.cell].series, &self.specs[pair.over].series);
            let found = comparisons.iter().position(|c| c.series == *series && c.over == *over);
            let at = found.unwrap_or_else(|| {
                let (series, over) = (series.clone(), over.clone());
                comparisons.push(Comparison {
                    series,
                    over,
                    groups: Vec::new(),
                    samples: largest,
                    parameters: Vec::new(),
                });
                comparisons.len() - 1
            });
            comparisons[at].groups.extend(groups);
            comparisons[at].parameters.extend(parameters);
        }
        comparisons
    }

    fn groups(&self, pair: &Pair) -> Vec<PairedGroup> {
        let spec = &self.specs[pair.cell];
        let of_group = |group: Group| {
            let is_in = |k: usize| spec.parameters[k].group == group;
            let matches: Vec<Match<'_>> = self.matches(pair).filter(|m| is_in(m.cell.1)).collect();
            Some(PairedGroup {
                samples: spec.samples,
                group,
                variance_ratio: ratio(&matches, |f| Some(f.variance))?,
                variance_ratio_controlled: ratio(&matches, |f| f.variance_controlled),
                mse_ratio: ratio(&matches, |f| Some(f.mse))?,
            })
        };
        Group::ALL.into_iter().filter_map(of_group).collect()
    }

    fn parameters(&self, pair: &Pair) -> Vec<PairedParameter> {
        let spec = &self.specs[pair.cell];
        let of_match = |m: Match<'_>| {
            Some(PairedParameter {
                name: spec.parameters[m.cell.1].name.clone(),
                variance_ratio: ratio(&[m], |f| Some(f.variance))?,
                variance_ratio_controlled: ratio(&[m], |f| f.variance_controlled),
                mse_ratio: ratio(&[m], |f| Some(f.mse))?,
                bias_difference: bias_difference(m)?,
            })
        };
        self.matches(pair).filter_map(of_match).collect()
    }
}

/// Geometric mean of the ratios of a positive figure.
fn ratio<'a>(matches: &[Match<'a>], figure: impl Fn(&Figures) -> Option<f64>) -> Option<Paired> {
    let side = |of: fn(&Match<'a>) -> Side<'a>, view: View| {
        let logarithm = |(views, k): Side<'_>| Some(figure(&views.at(view, k)?)?.ln());
        let logarithms: Option<Vec<f64>> = matches.iter().map(|m| logarithm(of(m))).collect();
        mean(&logarithms?)
    };
    let (paired, alone) = difference(|view| side(|m| m.cell, view), |view| side(|m| m.over, view))?;
    let ratio = paired.value.exp();
    Paired::new(ratio, ratio * paired.se, ratio * alone)
}

/// Controlled where both sides are, else plain: the two differ in what they leave to chance.
fn bias_difference(m: Match<'_>) -> Option<Paired> {
    let is_controlled = |(views, k): Side<'_>| Some(views.at(None, k)?.bias_controlled.is_some());
    let controlled = is_controlled(m.cell)? && is_controlled(m.over)?;
    let bias = |(views, k): Side<'_>, view: View| {
        let figures = views.at(view, k)?;
        Some(if controlled { figures.best_bias().value } else { figures.bias.value })
    };
    let (paired, alone) = difference(|view| bias(m.cell, view), |view| bias(m.over, view))?;
    Paired::new(paired.value, paired.se, alone)
}

/// One figure less another with its error on shared noise, and the error that two independent runs would leave.
fn difference(
    one: impl Fn(View) -> Option<f64>,
    other: impl Fn(View) -> Option<f64>,
) -> Option<(Jackknifed, f64)> {
    let paired = Jackknifed::of(|view| Some(one(view)? - other(view)?))?;
    Some((paired, Jackknifed::of(&one)?.se.hypot(Jackknifed::of(&other)?.se)))
}
