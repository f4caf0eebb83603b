//! Variance and squared error on the same noise, as ratios, against N.

use super::against::{Against, Pairs};
use super::axis::Axis;
use super::canvas::Dash;
use super::legend::{Entry, Sample};
use super::panel::{Mark, Panel};
use super::selection::{CaseSelection, replicates};
use super::sheet::{Grid, Sheet};
use super::spread::{ERRORS, Spread, samples_axis};
use super::style::{GREY, OKABE_ITO, Pen, SMALL_RADIUS};
use switchback_study::results::{Group, Paired, PairedGroup, Results};

/// What a row draws of a group.
type Ratio = fn(&PairedGroup) -> Paired;

/// The rows: what is compared, and how.
const ROWS: [(&str, Ratio); 2] = [("variance", |g| g.variance_ratio), ("squared error", |g| g.mse_ratio)];
/// Pixels between marks at the same `N`.
const APART: f64 = 5.0;

/// Draws one figure: columns are parameter groups, the upper row ratios of variances, the lower one ratios of mean squared
/// errors; colours are methods or borders.
pub(super) fn figure(pairs: &Pairs<'_>, case: &CaseSelection<'_>, results: &Results) -> String {
    let has = |group: &Group| pairs.comparisons.iter().any(|c| c.groups.iter().any(|g| g.group == *group));
    let groups: Vec<Group> = Group::ALL.into_iter().filter(has).collect();
    let mut sheet = Sheet::new(
        format!("{}: {} against each other on the same noise", case.title(results), pairs.against.name()),
        notes(pairs, case),
        Grid { apart: 20.0, ..Grid::shared(ROWS.len(), groups.len(), 230.0) },
    );
    sheet.legend = legend(pairs);
    sheet.render(|canvas, frames| {
        for (r, (what, ratio)) in ROWS.into_iter().enumerate() {
            let axes = axes(pairs, ratio);
            for (column, &group) in groups.iter().enumerate() {
                let panel = frames.inner_panel(canvas, (r, column), axes);
                if r == 0 {
                    panel.title(group.label());
                } else {
                    panel.x_name("samples N");
                }
                if column == 0 {
                    panel.y_name(&format!("ratio of {what}"), 62.0);
                }
                contents(&panel, pairs, group, ratio);
            }
        }
    })
}

fn notes(pairs: &Pairs<'_>, case: &CaseSelection<'_>) -> Vec<String> {
    let mut notes = vec![format!(
        "Over {}, the first of the sweep that has the parameter; geometric mean over a group. Median over {}; bars: from the \
         least to the greatest, with {ERRORS} jackknifed standard errors of the pair; {}.",
        pairs.reference(),
        pairs.against.others(),
        replicates(case.cells())
    )];
    notes.extend(pairs.left_out());
    if pairs.against == Against::Methods {
        notes.push(
            "A method with a small variance and a large squared error is biased: it scatters little about a wrong value. The lower \
             row decides."
                .to_owned(),
        );
    }
    notes
}

fn legend(pairs: &Pairs<'_>) -> Vec<Entry> {
    let mut entries: Vec<Entry> =
        pairs.sides.iter().zip(OKABE_ITO).map(|(name, colour)| Entry::disc(colour, name.as_str())).collect();
    entries.push(Entry::new(Sample::Dashes(Pen::data(GREY), Dash::Dashes), "equal"));
    entries
}

/// One side's ratios in one diagram.
fn curve(pairs: &Pairs<'_>, side: &str, group: Group, ratio: Ratio) -> Vec<(f64, Spread)> {
    let mut samples: Vec<usize> = Vec::new();
    for entry in pairs.of_side(side).flat_map(|c| &c.groups).filter(|g| g.group == group) {
        if !samples.contains(&entry.samples) {
            samples.push(entry.samples);
        }
    }
    samples.sort_unstable();
    let at = |n: usize| {
        let entries = pairs.of_side(side).flat_map(|c| &c.groups);
        let here = entries.filter(move |g| g.group == group && g.samples == n);
        Some((n as f64, Spread::of_ratios(here.map(ratio))?))
    };
    samples.into_iter().filter_map(at).collect()
}

/// Axes that a row shares.
fn axes(pairs: &Pairs<'_>, ratio: Ratio) -> (Axis, Axis) {
    let groups = || pairs.comparisons.iter().flat_map(|c| &c.groups);
    let ends = groups().flat_map(|g| <[f64; 2]>::from(ratio(g).interval(ERRORS)));
    (samples_axis(groups().map(|g| g.samples), pairs.sides.len()), Axis::logarithmic(ends.chain([1.0])))
}

fn contents(panel: &Panel<'_>, pairs: &Pairs<'_>, group: Group, ratio: Ratio) {
    panel.level(1.0, Some(Dash::Dashes), Pen::data(GREY));
    let middle = (pairs.sides.len() - 1) as f64 / 2.0;
    let mut is_empty = true;
    for (k, (side, colour)) in pairs.sides.iter().zip(OKABE_ITO).enumerate() {
        let mark = Mark { aside: APART * (k as f64 - middle), ..Mark::disc(Pen::data(colour), SMALL_RADIUS) };
        for (n, spread) in curve(pairs, side, group, ratio) {
            is_empty = false;
            panel.mark(n, spread.middle, spread.positive_ends(), mark);
        }
    }
    if is_empty {
        panel.remark("nothing to compare");
    }
}
