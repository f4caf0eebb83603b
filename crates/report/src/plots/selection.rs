//! Which part of a table one figure shows.

use switchback_study::MethodName;
use switchback_study::results::{Cell, Group, Results};

/// The cells of one case and method, in the order of the table.
pub(super) struct Selection<'r> {
    /// The case's name.
    pub(super) case: &'r str,
    /// The method.
    pub(super) method: &'r MethodName,
    /// Its cells.
    pub(super) cells: Vec<&'r Cell>,
}

/// Every case with every method that ran in it.
pub(super) fn selections(results: &Results) -> Vec<Selection<'_>> {
    let mut found: Vec<Selection<'_>> = Vec::new();
    for cell in &results.cells {
        let (case, method) = (cell.series.case.as_str(), &cell.series.method);
        match found.iter_mut().find(|s| s.case == case && s.method == method) {
            Some(selection) => selection.cells.push(cell),
            None => found.push(Selection { case, method, cells: vec![cell] }),
        }
    }
    found
}

/// One case with all its methods.
pub(super) struct CaseSelection<'r> {
    /// The case's name.
    pub(super) case: &'r str,
    /// A selection a method, in the order of the table.
    pub(super) methods: Vec<Selection<'r>>,
}

/// Every case.
pub(super) fn cases(results: &Results) -> Vec<CaseSelection<'_>> {
    let mut found: Vec<CaseSelection<'_>> = Vec::new();
    for selection in selections(results) {
        match found.iter_mut().find(|c| c.case == selection.case) {
            Some(case) => case.methods.push(selection),
            None => found.push(CaseSelection { case: selection.case, methods: vec![selection] }),
        }
    }
    found
}

impl<'r> CaseSelection<'r> {
    /// All its cells.
    pub(super) fn cells(&self) -> impl Iterator<Item = &'r Cell> {
        self.methods.iter().flat_map(|s| s.cells.iter().copied())
    }

    /// The groups that any of its parameters belongs to.
    pub(super) fn groups(&self) -> Vec<Group> {
        groups(|g| self.methods.iter().any(|s| s.has(g)))
    }

    /// Numbers of samples, ascending.
    pub(super) fn samples(&self) -> Vec<usize> {
        let mut samples = distinct(self.cells().map(|c| c.samples));
        samples.sort_unstable();
        samples
    }

    /// `NAME.svg`, with the case behind the name where the table has several.
    pub(super) fn file(&self, what: &str, results: &Results) -> String {
        if has_several_cases(results) {
            format!("{what}-{}.svg", slug(self.case))
        } else {
            format!("{what}.svg")
        }
    }

    /// What the titles of its figures begin with: the study, and the case where there are several.
    pub(super) fn title(&self, results: &Results) -> String {
        let name = &results.name;
        if has_several_cases(results) { format!("{name}, {}", self.case) } else { name.clone() }
    }
}

fn has_several_cases(results: &Results) -> bool {
    results.cells.iter().any(|c| c.series.case != results.cells[0].series.case)
}

fn groups(holds: impl Fn(Group) -> bool) -> Vec<Group> {
    Group::ALL.into_iter().filter(|g| holds(*g)).collect()
}

impl<'r> Selection<'r> {
    /// Names of the borders, in the order of the table.
    pub(super) fn borders(&self) -> Vec<&'r str> {
        distinct(self.cells.iter().map(|c| c.series.border.as_str()))
    }

    /// Numbers of points, ascending.
    pub(super) fn points(&self) -> Vec<usize> {
        let mut points = distinct(self.cells.iter().map(|c| c.series.points));
        points.sort_unstable();
        points
    }

    /// Noise levels, ascending.
    pub(super) fn noises(&self) -> Vec<f64> {
        let mut noises = distinct(self.cells.iter().map(|c| c.series.noise));
        noises.sort_by(f64::total_cmp);
        noises
    }

    /// The groups that any of its parameters belongs to.
    pub(super) fn groups(&self) -> Vec<Group> {
        groups(|g| self.has(g))
    }

    fn has(&self, group: Group) -> bool {
        self.cells.iter().any(|c| c.parameters.iter().any(|p| p.group == group))
    }

    /// The cells of one curve, by increasing `N`.
    pub(super) fn curve(&self, border: &str, points: usize, noise: f64) -> Vec<&'r Cell> {
        let mut cells: Vec<&Cell> = self
            .cells
            .iter()
            .copied()
            .filter(|c| c.series.border == border && c.series.points == points && c.series.noise == noise)
            .collect();
        cells.sort_by_key(|c| c.samples);
        cells
    }

    /// `NAME-method.svg`, with the case in between where the table has several.
    pub(super) fn file(&self, what: &str, results: &Results) -> String {
        let case = if has_several_cases(results) { format!("{}-", slug(self.case)) } else { String::new() };
        format!("{what}-{case}{}.svg", self.method)
    }

    /// `method` or `method, case` where the table has several cases.
    pub(super) fn title(&self, results: &Results) -> String {
        if has_several_cases(results) {
            format!("{}, {}", self.method, self.case)
        } else {
            self.method.to_string()
        }
    }

    /// `500 replicates`, or the range where cells differ.
    pub(super) fn replicates(&self) -> String {
        replicates(self.cells.iter().copied())
    }
}

/// `500 replicates`, or the range where cells differ.
pub(super) fn replicates<'r>(cells: impl Iterator<Item = &'r Cell>) -> String {
    let (low, high) = cells
        .fold((usize::MAX, 0), |(low, high), cell| (low.min(cell.replicates), high.max(cell.replicates)));
    if low < high { format!("{low} to {high} replicates") } else { format!("{high} replicates") }
}

/// `m = 4`, `m = 4, 8 and 16`.
pub(super) fn listed(values: &[impl ToString]) -> String {
    let words: Vec<String> = values.iter().map(ToString::to_string).collect();
    match words.as_slice() {
        [] => String::new(),
        [one] => one.clone(),
        [first @ .., last] => format!("{} and {last}", first.join(", ")),
    }
}

/// At most `most` of the entries, evenly spread, the ends among them.
pub(super) fn thinned<T: Copy>(items: &[T], most: usize) -> Vec<T> {
    if items.len() <= most {
        return items.to_vec();
    }
    (0..most).map(|i| items[i * (items.len() - 1) / (most - 1)]).collect()
}

/// The entries in their order, each once.
pub(super) fn distinct<T: PartialEq>(items: impl Iterator<Item = T>) -> Vec<T> {
    let mut found = Vec::new();
    for item in items {
        if !found.contains(&item) {
            found.push(item);
        }
    }
    found
}

/// Lower-case letters, digits and single hyphens: fit for a file name anywhere.
pub(super) fn slug(text: &str) -> String {
    let kept: String =
        text.chars().map(|c| if c.is_alphanumeric() { c.to_ascii_lowercase() } else { ' ' }).collect();
    kept.split_whitespace().collect::<Vec<_>>().join("-")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thinning_keeps_both_ends() {
        assert_eq!(thinned(&[1, 2, 3, 4, 5, 6, 7], 3), [1, 4, 7]);
        assert_eq!(thinned(&[1, 2], 3), [1, 2]);
    }

    #[test]
    fn lists_end_in_and() {
        assert_eq!(listed(&[0; 0]), "");
        assert_eq!(listed(&[4]), "4");
        assert_eq!(listed(&[4, 8, 16]), "4, 8 and 16");
    }

    #[test]
    fn a_slug_is_fit_for_a_file_name() {
        assert_eq!(slug("Order too low: n = 1 (of 2)"), "order-too-low-n-1-of-2");
    }
}
