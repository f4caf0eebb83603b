//! What of a file is fitted and what is held out.

use std::ops::Range;
use switchback_model::rig::Usage;
use switchback_table::signals::InputForm;
use switchback_table::table::DataProblem;

/// Consecutive samples for one use.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Part {
    pub(super) range: Range<usize>,
    pub(super) usage: Usage,
}

/// Drops pieces of fewer than `needed` samples and, where a share is held out, cuts the rest in time.
///
/// A piece that the cut would leave with a stump goes whole to the side where most of it lies.
///
/// # Errors
/// Where too little is left.
pub(super) fn divide(
    pieces: &[Range<usize>],
    (usage, held_out): (Usage, Option<f64>),
    (needed, input_form): (usize, &InputForm),
) -> Result<Vec<Part>, DataProblem> {
    let rows: usize = pieces.iter().map(Range::len).sum();
    let long: Vec<Range<usize>> = pieces.iter().filter(|piece| piece.len() >= needed).cloned().collect();
    let left: usize = long.iter().map(Range::len).sum();
    if long.is_empty() && pieces.len() <= 1 {
        return Err(DataProblem::TooShort { found: rows, needed });
    }
    // Where most is lost, the sampling is uneven rather than interrupted.
    if 2 * left < rows {
        return Err(DataProblem::Shattered { rows, left, needed, remedy: input_form.shattered() });
    }
    let Some(share) = held_out else {
        return Ok(long.into_iter().map(|range| Part { range, usage }).collect());
    };
    let kept = ((1.0 - share) * left as f64).round() as usize;
    let mut parts = Vec::new();
    let mut before = 0;
    for piece in long {
        let own = kept.saturating_sub(before).min(piece.len());
        before += piece.len();
        let own = match (own >= needed, piece.len() - own >= needed) {
            (true, true) => own,
            _ if 2 * own >= piece.len() => piece.len(),
            _ => 0,
        };
        let cut = piece.start + own;
        parts.push(Part { range: piece.start..cut, usage: Usage::Fit });
        parts.push(Part { range: cut..piece.end, usage: Usage::Holdout });
    }
    parts.retain(|part| !part.range.is_empty());
    let has = |usage| parts.iter().any(|part| part.usage == usage);
    if has(Usage::Fit) && has(Usage::Holdout) {
        Ok(parts)
    } else {
        let remedy = input_form.cut_too_short();
        Err(DataProblem::CutTooShort { fitted: kept, held_out: left - kept, needed, remedy })
    }
}

/// Ending of the name of what is held out of a record.
const HELD_OUT_SIDE: &str = "-held-out";

/// Whether a name is that of the rest of a record, of which another part is fitted.
pub(crate) fn is_rest_of(name: &str, fitted: &str) -> bool {
    let of_record = |name: &str| name.split("-part-").next().unwrap_or(name).to_owned();
    of_record(name).strip_suffix(HELD_OUT_SIDE).is_some_and(|record| record == of_record(fitted))
}

/// The names of a record's parts: its own where it is whole.
pub(super) fn names(record: &str, parts: &[Part]) -> Vec<String> {
    let of = |usage: Usage| parts.iter().filter(|part| part.usage == usage).count();
    let is_cut = of(Usage::Fit) > 0 && of(Usage::Holdout) > 0;
    let mut counts = [0; 2];
    parts
        .iter()
        .map(|part| {
            let is_held_out = part.usage == Usage::Holdout;
            let count = &mut counts[usize::from(is_held_out)];
            *count += 1;
            let side = if is_cut && is_held_out { HELD_OUT_SIDE } else { "" };
            let piece = if of(part.usage) > 1 { format!("-part-{count}") } else { String::new() };
            format!("{record}{side}{piece}")
        })
        .collect()
}

#[cfg(test)]
#[allow(clippy::single_range_in_vec_init, reason = "a record of one piece is a list of one range")]
mod tests {
    use super::*;
    use Usage::{Fit, Holdout};

    fn divided(pieces: &[Range<usize>], held_out: Option<f64>) -> Vec<(Range<usize>, Usage)> {
        let parts = divide(pieces, (Fit, held_out), (10, &InputForm::Manifest)).unwrap();
        parts.into_iter().map(|part| (part.range, part.usage)).collect()
    }

    #[test]
    fn the_rest_of_a_record_is_known_by_its_name() {
        assert!(is_rest_of("a-held-out", "a") && is_rest_of("a-held-out-part-2", "a-part-1"));
        assert!(!is_rest_of("b-held-out", "a") && !is_rest_of("a", "a") && !is_rest_of("tuesday", "monday"));
    }

    #[test]
    fn the_last_share_is_held_out() {
        assert_eq!(divided(&[0..300], Some(1.0 / 3.0)), [(0..200, Fit), (200..300, Holdout)]);
        assert_eq!(divided(&[0..300], None), [(0..300, Fit)]);
    }

    #[test]
    fn pieces_are_cut_in_time_and_stumps_are_not_made() {
        let half = divided(&[0..100, 110..210], Some(0.5));
        assert_eq!(half, [(0..100, Fit), (110..210, Holdout)]);
        let stump = divided(&[0..100, 110..205], Some(0.5));
        assert_eq!(stump, [(0..100, Fit), (110..205, Holdout)]);
        let inside = divided(&[0..100, 100..105, 110..310], Some(0.5));
        assert_eq!(inside, [(0..100, Fit), (110..160, Fit), (160..310, Holdout)]);
    }

    #[test]
    fn too_little_is_refused() {
        let share = (Fit, Some(1.0 / 3.0));
        assert!(matches!(
            divide(&[0..12], share, (10, &InputForm::Manifest)),
            Err(DataProblem::CutTooShort { .. })
        ));
        assert!(matches!(
            divide(&[0..5], share, (10, &InputForm::Manifest)),
            Err(DataProblem::TooShort { .. })
        ));
        let shreds: Vec<Range<usize>> = (0..20).map(|k| 7 * k..7 * k + 6).collect();
        assert!(matches!(
            divide(&shreds, share, (10, &InputForm::Manifest)),
            Err(DataProblem::Shattered { .. })
        ));
    }

    #[test]
    fn parts_are_named_by_what_they_are() {
        let part = |usage| Part { range: 0..1, usage };
        assert_eq!(names("a", &[part(Fit)]), ["a"]);
        assert_eq!(names("a", &[part(Fit), part(Holdout)]), ["a", "a-held-out"]);
        assert_eq!(
            names("a", &[part(Fit), part(Fit), part(Holdout)]),
            ["a-part-1", "a-part-2", "a-held-out"]
        );
        assert_eq!(names("a", &[part(Holdout), part(Holdout)]), ["a-part-1", "a-part-2"]);
    }
}
