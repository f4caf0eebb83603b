//! Accuracy against effect, size and law.

use crate::blind::case::Case;
use crate::blind::design::Kind;
use crate::examination::Share;

/// The rigs of one effect, wanted size and kind of law.
#[derive(Debug, Clone, PartialEq)]
pub struct AccuracyRow {
    /// The effect put in.
    pub effect: &'static str,
    /// Size asked for.
    pub wanted: f64,
    /// Plain law, or another one.
    pub plain: bool,
    /// Mean size reached.
    pub reached: f64,
    /// Named exactly.
    pub exact: Share,
    /// Right class.
    pub class: Share,
    /// Answered `none`.
    pub none: Share,
    /// Answered `unexplained`.
    pub unexplained: Share,
}

/// The single effects of one wanted size.
#[derive(Debug, Clone, PartialEq)]
pub struct SizeRow {
    /// Size asked for.
    pub wanted: f64,
    /// Plain laws named exactly.
    pub exact: Share,
    /// Plain laws with the right class.
    pub class: Share,
    /// Other laws with the right class.
    pub mismatch_class: Share,
    /// Any law, but a wrong cause named.
    pub wrong: Share,
}

pub(super) fn rows(cases: &[Case]) -> Vec<AccuracyRow> {
    let mut cells: Vec<(&'static str, f64, bool)> =
        singles(cases).map(|c| (c.truth[0], c.wanted, c.plain)).collect();
    cells.sort_by(|a, b| (a.0, b.2).cmp(&(b.0, a.2)).then(a.1.total_cmp(&b.1)));
    cells.dedup();
    cells
        .into_iter()
        .map(|(effect, wanted, plain)| {
            let inside = || {
                singles(cases).filter(move |c| c.truth[0] == effect && c.wanted == wanted && c.plain == plain)
            };
            AccuracyRow {
                effect,
                wanted,
                plain,
                reached: inside().map(|c| c.size).sum::<f64>() / inside().count() as f64,
                exact: Share::over(inside(), Case::exact),
                class: Share::over(inside(), Case::class_right),
                none: Share::over(inside(), |c| c.reply.status == "none"),
                unexplained: Share::over(inside(), |c| c.reply.status == "unexplained"),
            }
        })
        .collect()
}

pub(super) fn by_size(cases: &[Case]) -> Vec<SizeRow> {
    let mut sizes: Vec<f64> = singles(cases).map(|c| c.wanted).collect();
    sizes.sort_by(f64::total_cmp);
    sizes.dedup();
    sizes
        .into_iter()
        .map(|wanted| {
            let inside = |plain: bool| singles(cases).filter(move |c| c.wanted == wanted && c.plain == plain);
            SizeRow {
                wanted,
                exact: Share::over(inside(true), Case::exact),
                class: Share::over(inside(true), Case::class_right),
                mismatch_class: Share::over(inside(false), Case::class_right),
                wrong: Share::over(inside(true).chain(inside(false)), |c| {
                    c.names_a_cause() && !c.class_right()
                }),
            }
        })
        .collect()
}

/// Rigs with one effect of the library.
pub(super) fn singles(cases: &[Case]) -> impl Iterator<Item = &Case> {
    cases.iter().filter(|c| c.kind == Kind::Single)
}
