//! The table of differences.

use super::reversals::{moves_reversals, profiled};
use super::selection::{Context, Difference, Selected, quantities, with};
use super::source::Identified;
use super::surrogate::own_values;
use crate::workers::Workers;
use nalgebra::{DMatrix, DVector};
use switchback_identify::record::Sensitivities;
use switchback_model::alignment::unit_factor;
use switchback_model::system::{Quantity, System, Unit, price};

/// What kind of thing a row is about.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RowKind {
    /// A value that both sides have.
    Parameter,
    /// An effect on either side.
    Effect,
}

/// One quantity on both sides.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// Its name.
    pub what: String,
    /// The effect whose parameter it is, where it is one.
    pub effect: Option<&'static str>,
    /// Parameter or effect.
    pub kind: RowKind,
    /// Its value in the source, a delay relative to the machine's; zero for the strength of an effect that this lacks.
    pub in_a: f64,
    /// Its value in the machine.
    pub in_b: f64,
    /// Standard error of the former, as if the misfit of the source's system were noise.
    pub se_a: f64,
    /// Standard error of the latter, that of the former included.
    pub se: f64,
    /// Unit of all three.
    pub unit: Unit,
    /// Probability that it differs, by the weights of the extended BIC.
    pub probability: f64,
    /// Whether it differs.
    pub differs: bool,
    /// Share of the gap that would stay without it, all other differences fitted again.
    pub closure: f64,
    /// Growth of the deviance without it, all other differences fitted again.
    pub gain: f64,
}

impl Row {
    /// A row of values that are the same, each with its standard error; its probability follows from the deviance gained by letting them differ.
    pub(super) fn of(
        quantity: Quantity,
        aligned: &System,
        [(in_a, se_a), (in_b, se)]: [(f64, f64); 2],
        (gain, samples): (f64, usize),
    ) -> Self {
        let (effect, kind) = match quantity {
            Quantity::Value(term, _) => (Some(aligned.terms[term].law.effect()), RowKind::Effect),
            _ => (None, RowKind::Parameter),
        };
        let odds = 0.5 * (gain - price(samples, 1));
        Self {
            what: quantity.name(aligned),
            effect,
            kind,
            in_a,
            in_b,
            se_a,
            se: se.hypot(se_a),
            unit: quantity.unit(aligned),
            probability: 1.0 / (1.0 + (-odds).exp()),
            differs: false,
            closure: 0.0,
            gain,
        }
    }

    /// The same of values that differ, without which a share of the gap would stay.
    pub(super) fn differing(self, share: f64) -> Self {
        Self { differs: true, closure: if share.is_finite() { share.max(0.0) } else { 0.0 }, ..self }
    }

    /// The same in units of which a factor makes those of the machine.
    fn times(self, factor: f64) -> Self {
        let Self { in_a, in_b, se_a, se, .. } = self;
        Self {
            in_a: factor * in_a,
            in_b: factor * in_b,
            se_a: factor.abs() * se_a,
            se: factor.abs() * se,
            ..self
        }
    }
}

/// All rows: those that differ first, by what the gap would grow by without them.
pub(super) fn rows<W: Workers>(
    context: &Context<'_, W>,
    selected: &Selected,
    source: &Identified,
) -> Vec<Row> {
    let (aligned, free) = with(context.base, &selected.differences);
    let open: Vec<Quantity> = quantities(context.base).filter(|q| !free.contains(q)).collect();
    let all = [&free[..], &open].concat();
    let local = Sensitivities::of(&aligned, &all, &context.stretches, (&context.criterion, context.scale));
    let errors = errors(&local, free.len());
    let before = Sensitivities::deviance(context.base, &context.stretches, &context.criterion);
    let gap = before - selected.deviance;
    let losses = context.losses(selected);
    let own: Vec<Quantity> = quantities(context.base).collect();
    let own_values = own_values(&source.system, &source.records, context.scale, &own);
    let in_source = |quantity: Quantity| {
        let at = own.iter().position(|q| *q == quantity);
        at.map_or((quantity.value_where_known(context.base), 0.0), |at| own_values[at])
    };
    let scale = unit_factor(aligned.sensor.gain).unwrap_or(1.0);
    let mut rows: Vec<Row> = Vec::new();
    for (k, quantity) in all.iter().enumerate() {
        let (in_a, se_a) = in_source(*quantity);
        let (in_b, se) = if moves_reversals(&aligned, *quantity) {
            profiled(&aligned, *quantity, &free, &context.stretches, (&context.criterion, context.scale))
        } else {
            (quantity.value(&aligned) + errors[k].0, errors[k].1)
        };
        // Only the difference of two delays means anything: the machine's is the origin.
        let (in_a, in_b) = match quantity {
            Quantity::Delay => (in_a - in_b, 0.0),
            _ => (in_a, in_b),
        };
        let gain = match place(context.base, selected, *quantity) {
            Some(at) => losses[at],
            None => ((in_b - in_a) / se).powi(2),
        };
        let row = Row::of(*quantity, &aligned, [(in_a, se_a), (in_b, se)], (gain, context.samples));
        let row =
            if row.unit.is_of_output() && *quantity != Quantity::Offset { row.times(scale) } else { row };
        rows.push(if k < free.len() { row.differing(gain / gap) } else { row });
    }
    // Those that are the same stay in the order of the quantities.
    rows.sort_by(|x, y| match (x.differs, y.differs) {
        (true, true) => y.gain.total_cmp(&x.gain),
        _ => y.differs.cmp(&x.differs),
    });
    rows
}

/// The difference that a quantity belongs to.
fn place(base: &System, selected: &Selected, quantity: Quantity) -> Option<usize> {
    let mut terms = base.terms.len();
    let belongs = |d: &Difference| match d {
        Difference::Quantity(own, _) => *own == quantity,
        Difference::Effect(_) => {
            terms += 1;
            matches!(quantity, Quantity::Value(term, _) if term + 1 == terms)
        }
    };
    selected.differences.iter().position(belongs)
}

/// For every quantity `(step, standard error)`: free ones jointly, at whose optimum no step is left; each other one as if it were let free beside them.
fn errors(local: &Sensitivities, free: usize) -> Vec<(f64, f64)> {
    let joint = |chosen: &[usize]| -> (DVector<f64>, DMatrix<f64>) {
        let n = chosen.len();
        let scale = |i: usize| local.information[(chosen[i], chosen[i])].sqrt().max(f64::MIN_POSITIVE);
        let h = DMatrix::from_fn(n, n, |i, j| {
            local.information[(chosen[i], chosen[j])] / (scale(i) * scale(j))
                + if i == j { 1e-10 } else { 0.0 }
        });
        let inverse = h.try_inverse().unwrap_or_else(|| DMatrix::from_element(n, n, f64::NAN));
        let covariance = DMatrix::from_fn(n, n, |i, j| inverse[(i, j)] / (scale(i) * scale(j)));
        let gradient = DVector::from_fn(n, |i, _| local.gradient[chosen[i]]);
        let step = &covariance * gradient;
        // The scatter of the gradient over blocks allows for errors that are not as the criterion has them.
        let mut scatter = DMatrix::zeros(n, n);
        for block in &local.blocks {
            let g = DVector::from_fn(n, |i, _| block[chosen[i]]);
            scatter.ger(1.0, &g, &g, 1.0);
        }
        let robust = &covariance * scatter * &covariance;
        let larger =
            DMatrix::from_fn(n, n, |i, j| if i == j { covariance[(i, i)].max(robust[(i, i)]) } else { 0.0 });
        (step, larger)
    };
    let taken: Vec<usize> = (0..free).collect();
    let (_, covariance) = joint(&taken);
    let own = (0..free).map(|k| (0.0, covariance[(k, k)].sqrt()));
    let others = (free..local.gradient.len()).map(|k| {
        let (step, covariance) = joint(&[&taken[..], &[k]].concat());
        (step[free], covariance[(free, free)].sqrt())
    });
    own.chain(others).collect()
}
