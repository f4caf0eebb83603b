//! One figure for a group of parameters.

use super::{Cell, Group, Measured, Parameter};

/// Root mean square of a measure over the parameters of a group that have it; `None` where none has.
///
/// ```text
/// r = √(Σ xₖ²/K),   error(r) ≤ Σ |xₖ|·error(xₖ)/(K·r)
/// ```
///
/// The estimates of one replicate are correlated, so the errors are added as if they always agreed (an upper bound).
/// Where `r` vanishes the bound is the root mean square of the errors, which is also what `r` shows of a
/// measure whose true value is zero.
pub fn root_mean_square(
    cell: &Cell,
    group: Group,
    measure: impl Fn(&Parameter) -> Option<Measured>,
) -> Option<Measured> {
    let figures: Vec<Measured> =
        cell.parameters.iter().filter(|p| p.group == group).filter_map(measure).collect();
    let count = figures.len() as f64;
    let mean_square = |f: fn(&Measured) -> f64| figures.iter().map(|x| f(x) * f(x)).sum::<f64>() / count;
    let value = mean_square(Measured::value).sqrt();
    if value == 0.0 {
        return Measured::new(0.0, mean_square(Measured::mcse).sqrt());
    }
    let error = figures.iter().map(|x| x.value().abs() * x.mcse()).sum::<f64>() / (count * value);
    Measured::new(value, error)
}

/// Root mean square of exactly known figures over a group; `None` where no parameter has one.
pub fn root_mean_square_exact(
    cell: &Cell,
    group: Group,
    measure: impl Fn(&Parameter) -> Option<f64>,
) -> Option<f64> {
    root_mean_square(cell, group, |p| measure(p).and_then(|x| Measured::new(x, 0.0))).map(|m| m.value())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::synthetic;

    #[test]
    fn equal_figures_pool_to_themselves() {
        let mut cell = synthetic::results().cells.swap_remove(0);
        for parameter in &mut cell.parameters {
            parameter.bias = Measured::new(-0.5, 0.01);
        }
        assert_eq!(root_mean_square(&cell, Group::A, |p| p.bias), Measured::new(0.5, 0.01));
        assert_eq!(root_mean_square(&cell, Group::A, |_| None), None);
        assert_eq!(root_mean_square_exact(&cell, Group::A, |_| Some(3.0)), Some(3.0));
    }
}
