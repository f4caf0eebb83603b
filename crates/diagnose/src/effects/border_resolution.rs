//! The borders have more detail than the grid they are tabulated on.
//!
//! The nominal model already places its knots from the data ([`crate::nominal::knots`]); what remains for this effect is refinement finer than
//! that placement resolves. A jump is finer than a table only where designed experiments tabulate the borders at levels; without them
//! it is the border's own. Law: three times the knots. Stage: operator. Confused with: outliers, sensor effects.

use super::{Card, Scene, Variant};
use crate::effect::{Effect, Stage};
use crate::model::borders::Grid;

pub(super) const CARD: Card =
    Card { catch_all: true, lies_in_the_grid: true, ..Card::of(Stage::Operator, variants) };

fn variants(scene: &Scene<'_>) -> Vec<Variant> {
    let knots = scene.fit.grid.knots.clone().map(|knots| {
        let mut fine = Vec::with_capacity(3 * knots.len());
        for w in knots.windows(2) {
            fine.push(w[0]);
            if w[1] - w[0] > 0.015 {
                fine.extend([1.0, 2.0].map(|k| w[0] + (w[1] - w[0]) * k / 3.0));
            }
        }
        fine.extend(knots.last());
        fine
    });
    let mut variant = Variant::new(vec![Vec::new()], |_, _| {});
    variant.grid = Some(Grid { knots });
    vec![variant]
}

/// Details of the borders that the knots of a fit follow already: nothing is left to apply.
pub(crate) fn refinement() -> (Effect, Variant) {
    (Effect::BorderResolution, Variant::new(vec![Vec::new()], |_, _| {}))
}
