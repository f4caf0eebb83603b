//! `A` and `B` by least squares, the borders as they are.

use crate::least_squares::normal::Normal;
use crate::likelihood::design::{Design, Linear, Whitener};

/// The parameters with `A` and `B` solved for: behind a filter the nominal `A` may hold a pole that the filter ought to have
/// (and B a delay), and no small step gets out of that.
pub(crate) fn dynamics_refitted(design: &Design, whitener: &Whitener, p: &Linear) -> Option<Linear> {
    design.pass_begins();
    let (na, nb) = (p.a.len(), p.b.len());
    let mut normal = Normal::new(na + nb);
    let mut row = vec![0.0; na + nb];
    for scaled in &design.scaled_records {
        let u = design.input(scaled, &p.f);
        let x = whitener.apply(scaled.x.to_vec());
        let ahead = |t: usize| design.taps.iter().enumerate().map(|(k, c)| c * u[t.saturating_sub(k)]).sum();
        let u = whitener.apply((0..u.len()).map(ahead).collect());
        for t in scaled.from..x.len() {
            (0..na).for_each(|i| row[i] = -x[t - i - 1]);
            (0..nb).for_each(|j| row[na + j] = u[t - j - 1]);
            normal.add(&row, x[t]);
        }
    }
    let solved = normal.factor(1e-10)?.solve(&normal.gradient);
    let mut p = p.clone();
    p.a.copy_from_slice(&solved[..na]);
    p.b.copy_from_slice(&solved[na..]);
    Some(p)
}
