//! Effects as an explanation: the best of their variants, fitted together with the nominal model.

use std::fmt;

use crate::assembly::Assembly;
use crate::campaign::Campaign;
use crate::design::Linear;
use crate::effect::Effect;
use crate::effects::{Apply, Scene, Search, Variant, variants};
use crate::engine::{Build, Fit, Ground, Own, fit};

/// One effect of an explanation: which, and how its own parameters change the assembly.
#[derive(Clone)]
pub(crate) struct Part {
    pub(crate) effect: Effect,
    apply: Apply,
    /// Number of own parameters.
    pub(crate) count: usize,
    search: Search,
}

impl fmt::Debug for Part {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}({})", self.effect, self.count)
    }
}

/// A nominal model with any number of effects, fitted together.
#[derive(Debug, Clone)]
pub(crate) struct Explanation {
    pub(crate) parts: Vec<Part>,
    pub(crate) fit: Fit,
    /// Handicaps of the variants chosen, added to the deviance.
    pub(crate) handicap: f64,
}

impl Explanation {
    /// The nominal model alone.
    pub(crate) fn nominal(fit: Fit) -> Self {
        Self { parts: Vec::new(), fit, handicap: 0.0 }
    }

    /// Penalised deviance: Bayesian information criterion plus the handicap.
    pub(crate) fn bic(&self) -> f64 {
        self.fit.deviance + self.handicap + self.fit.parameters * (self.fit.samples as f64).ln()
    }

    /// The effects, in the order they were added.
    pub(crate) fn effects(&self) -> Vec<Effect> {
        self.parts.iter().map(|p| p.effect).collect()
    }

    /// The same explanation with border knots placed anew.
    pub(crate) fn with_knots_refined(mut self, campaign: &Campaign) -> Self {
        let before = self.clone();
        let parts = self.parts.clone();
        // Parameters with corners stay where their profile put them.
        let held = parts.iter().any(|p| p.search == Search::Profile);
        let own = self.fit.own.clone();
        let own_se = self.fit.own_se.clone();
        if held {
            let values: Vec<f64> = own.iter().map(|o| o.value).collect();
            let mut free = self.fit.clone();
            free.own.clear();
            free.own_se.clear();
            free.parameters -= own.len() as f64;
            let assembly = assembled(&parts, &values);
            let mut refined = crate::knots::replace(campaign, &free, &|_| assembly.clone());
            refined.own = own;
            refined.own_se = own_se;
            refined.parameters += refined.own.len() as f64;
            self.fit = refined;
        } else {
            self.fit = crate::knots::replace(campaign, &self.fit, &|values| assembled(&parts, values));
        }
        if self.bic() > before.bic() { before } else { self }
    }
}

/// The assembly of several parts, their own parameters one after the other.
fn assembled(parts: &[Part], values: &[f64]) -> Assembly {
    let mut assembly = Assembly::default();
    let mut rest = values;
    for part in parts {
        let (own, later) = rest.split_at(part.count);
        (part.apply)(own, &mut assembly);
        rest = later;
    }
    assembly
}

/// Gauss–Newton rounds from each start, and from the best.
const SCREENING: usize = 3;
const FINAL: usize = 14;

/// Fits one more effect on top of what is known; `None` where the records rule it out.
pub(crate) fn explain(scene: &Scene<'_>, known: &Explanation, effect: Effect) -> Option<Explanation> {
    variants(effect, scene)
        .iter()
        .filter_map(|variant| fit_variant(scene, known, effect, variant))
        .min_by(|x, y| x.bic().total_cmp(&y.bic()))
}

fn fit_variant(
    scene: &Scene<'_>,
    known: &Explanation,
    effect: Effect,
    variant: &Variant,
) -> Option<Explanation> {
    let grid = variant.grid.as_ref().unwrap_or(&known.fit.grid);
    let ground = Ground { campaign: scene.campaign, grid };
    let mut parts = known.parts.clone();
    parts.push(Part {
        effect,
        apply: variant.apply.clone(),
        count: variant.starts[0].len(),
        search: variant.search,
    });
    let build = |values: &[f64]| assembled(&parts, values);
    let base = match &variant.grid {
        Some(grid) => crate::knots::carried_over(&known.fit, grid),
        None => known.fit.linear.clone(),
    };
    let task = Task { ground, build: &build, known: &known.fit, base };
    let fit = match variant.search {
        Search::Smooth => task.smooth(&variant.starts),
        Search::Conditional => task.conditional(&variant.starts),
        Search::Profile => task.profile(&variant.starts),
    }?;
    Some(Explanation { parts, fit, handicap: known.handicap + variant.handicap })
}

/// One variant's search.
struct Task<'a> {
    ground: Ground<'a>,
    build: &'a Build<'a>,
    known: &'a Fit,
    /// Linear parameters of what is known, on the variant's grid.
    base: Linear,
}

impl Task<'_> {
    /// The own parameters of what is known, then those of the variant.
    fn joined(&self, own: &[Own]) -> Vec<Own> {
        self.known.own.iter().chain(own).copied().collect()
    }

    fn assembly(&self, own: &[Own]) -> Assembly {
        (self.build)(&own.iter().map(|o| o.value).collect::<Vec<_>>())
    }

    /// Everything fitted together.
    fn run(&self, own: &[Own], start: &Linear, rounds: usize) -> Option<Fit> {
        let start = self.padded(start, &self.assembly(own));
        fit(self.ground, self.build, own, &start, rounds)
    }

    /// The fit with the own parameters held.
    fn held(&self, own: &[Own], start: &Linear, rounds: usize) -> Option<Fit> {
        let assembly = self.assembly(own);
        let start = self.padded(start, &assembly);
        let mut fitted = fit(self.ground, &|_| assembly.clone(), &[], &start, rounds)?;
        fitted.own = own.to_vec();
        fitted.own_se = vec![f64::NAN; own.len()];
        fitted.parameters += own.len() as f64;
        Some(fitted)
    }

    fn smooth(&self, starts: &[Vec<Own>]) -> Option<Fit> {
        if let [only] = starts {
            return self.run(&self.joined(only), &self.base, FINAL);
        }
        let screened =
            best(starts.iter().filter_map(|own| self.run(&self.joined(own), &self.base, SCREENING)))?;
        self.settled(self.run(&screened.own, &screened.linear, FINAL)?)
    }

    fn conditional(&self, starts: &[Vec<Own>]) -> Option<Fit> {
        let held = best(
            starts
                .iter()
                .flat_map(|own| {
                    let own = self.joined(own);
                    [self.held(&own, &self.base, 4), self.afresh(&own)]
                })
                .flatten(),
        )?;
        self.settled(self.run(&held.own, &held.linear, FINAL)?)
    }

    /// The fit with the own parameters held, from scratch: behind a filter the nominal `A` may hold a pole that the filter
    /// ought to have, and no small step gets out of that.
    fn afresh(&self, own: &[Own]) -> Option<Fit> {
        let assembly = self.assembly(own);
        if assembly.denominator.len() < 2 || !assembly.border_columns.is_empty() {
            return None;
        }
        let order = self.known.linear.a.len();
        let start =
            crate::nominal::first_guess(self.ground.campaign, self.ground.grid, order, &assembly).ok()?;
        self.held(own, &start, 3)
    }

    /// Alternates between everything together and the own parameters held, until neither moves: where own parameters
    /// and dynamics trade against each other, a joint step may stall far from the best point.
    fn settled(&self, mut top: Fit) -> Option<Fit> {
        for _ in 0..3 {
            let held = self.held(&top.own, &top.linear, 4)?;
            let next = self.run(&held.own, &held.linear, FINAL)?;
            let gained = top.deviance - next.deviance;
            if gained > 0.0 {
                top = next;
            }
            if gained < 1.0 {
                break;
            }
        }
        Some(top)
    }

    /// A profile over the starts, then a pattern search whose steps start at each parameter's `step`.
    fn profile(&self, starts: &[Vec<Own>]) -> Option<Fit> {
        let mut top = best(starts.iter().filter_map(|own| self.held(&self.joined(own), &self.base, 3)))?;
        let first = self.known.own.len();
        let mut share = 1.0;
        let mut left = PATTERN_TRIALS;
        while share > 0.02 && left > 0 {
            let mut improved = false;
            for j in first..top.own.len() {
                for direction in [-1.0, 1.0] {
                    let mut own = top.own.clone();
                    let o = &mut own[j];
                    o.value = (o.value + direction * share * o.step).clamp(o.low, o.high);
                    left -= 1;
                    if let Some(f) = self.held(&own, &top.linear, 2)
                        && f.deviance < top.deviance
                    {
                        top = f;
                        improved = true;
                        break;
                    }
                }
            }
            if !improved {
                share *= 0.4;
            }
            left = left.max(0);
        }
        self.held(&top.own, &top.linear, FINAL).filter(|f| f.deviance <= top.deviance).or(Some(top))
    }

    /// The linear parameters with zeros for what the assembly adds.
    fn padded(&self, start: &Linear, assembly: &Assembly) -> Linear {
        let mut p = start.clone();
        p.b.resize(self.known.linear.a.len() + assembly.extra_b, 0.0);
        p.f.resize(self.ground.grid.len() + assembly.border_columns.len(), 0.0);
        p.d.resize(assembly.equation_columns.len(), 0.0);
        p
    }
}

/// Points of one pattern search at most.
const PATTERN_TRIALS: i32 = 30;

fn best(fits: impl Iterator<Item = Fit>) -> Option<Fit> {
    fits.min_by(|x, y| x.deviance.total_cmp(&y.deviance))
}
