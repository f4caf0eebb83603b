//! Models inside larger models: a fit of the smaller one is a start for the larger one.

use super::basis::Basis;
use super::problem::{Parameters, Structure};
use switchback_model::hysteresis::Branch;

impl Parameters {
    /// The same curves on the knots of another basis (exactly the same where its knots contain the old ones).
    pub(super) fn on_basis(&self, from: &Basis, to: &Basis) -> Self {
        let u = |branch, v| from.place(branch, v).value(&self.f);
        let mut values: Vec<f64> = to.descending().iter().map(|&v| u(Branch::Descending, v)).collect();
        if to.is_switched() {
            values.extend(to.ascending().iter().map(|&v| u(Branch::Ascending, v)));
        }
        let reference = values[0];
        let f = values[1..].iter().map(|x| x - reference).collect();
        let c = self.c + self.b.iter().sum::<f64>() * reference;
        Self { a: self.a.clone(), b: self.b.clone(), f, c }
    }

    /// The same system in a larger structure: coefficients the old one lacks are zero, those the new one lacks are lost.
    pub(super) fn in_structure(&self, from: Structure, to: Structure) -> Self {
        let mut a = self.a.clone();
        a.resize(to.order, 0.0);
        let lag = |i: usize| from.delay - to.delay + i as isize;
        let mut b = vec![0.0; to.numerator()];
        for (i, value) in self.b.iter().enumerate() {
            if let Some(place) = usize::try_from(lag(i)).ok().and_then(|j| b.get_mut(j)) {
                *place = *value;
            }
        }
        Self { a, b, f: self.f.clone(), c: self.c }
    }
}
