//! From probabilities to what is reported, by losses.

/// What an outcome of a posterior is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Outcome {
    /// An effect that can be named.
    Effect,
    /// Nothing is wrong.
    Nothing,
    /// Something is wrong that is none of the effects.
    NoneOfThese,
}

/// What a report costs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Losses {
    /// A name, or a class, that is wrong.
    pub wrong: f64,
    /// Silence where there is a cause, a shortlist that holds it included.
    pub silence: f64,
    /// Each further member of a class that is right: what it leaves open.
    pub member: f64,
}

impl Default for Losses {
    /// A wrong name costs 20, silence 1, a class of `k` a quarter of `k − 1`: more than four members are worth no more than silence.
    fn default() -> Self {
        Self { wrong: 20.0, silence: 1.0, member: 0.25 }
    }
}

/// From which probabilities on something is reported.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Thresholds {
    /// An effect is named.
    pub named: f64,
    /// A class is reported.
    pub class: f64,
    /// An effect enters the shortlist.
    pub shortlist: f64,
    /// Most members of a class and of a shortlist.
    pub most: usize,
}

impl Default for Thresholds {
    /// What [`Losses::default`] gives where probabilities hold: a name from `1 − 1/20` on, a class of three from `19/19.5`; an effect of 2 % is
    /// worth a look.
    fn default() -> Self {
        Self { named: 0.95, class: 0.975, shortlist: 0.02, most: 3 }
    }
}

/// What is reported, by positions of outcomes, most probable first.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Decision {
    /// One effect.
    Named(usize),
    /// One of these, which nothing separates.
    Class(Vec<usize>),
    /// Nothing can be named; these come first, and together are likelier than that nothing is wrong, and than anything without a name.
    Shortlist(Vec<usize>),
    /// No effect: nothing is wrong, or what is wrong is none of the effects.
    None,
}

/// What is reported of probabilities. Rows outside the training population are never named.
///
/// Pure: it depends on its arguments alone. Ties go to the outcome that comes first.
pub fn decide(p: &[f64], outcomes: &[Outcome], thresholds: &Thresholds, is_outside: bool) -> Decision {
    let mut order: Vec<usize> = (0..p.len()).collect();
    order.sort_by(|i, j| p[*j].total_cmp(&p[*i]).then(i.cmp(j)));
    let (effects, others): (Vec<usize>, Vec<usize>) =
        order.into_iter().partition(|i| outcomes[*i] == Outcome::Effect);
    if effects.is_empty() {
        return Decision::None;
    }
    if !is_outside && p[effects[0]] >= thresholds.named {
        return Decision::Named(effects[0]);
    }
    if !is_outside && let Some(class) = class(p, &effects, thresholds) {
        return Decision::Class(class);
    }
    let likely = effects.iter().copied().filter(|i| p[*i] >= thresholds.shortlist);
    let shortlist: Vec<usize> = likely.take(thresholds.most).collect();
    let listed: f64 = shortlist.iter().map(|i| p[*i]).sum();
    let is_led = others.first().is_some_and(|other| p[*other] >= listed);
    if shortlist.is_empty() || is_led { Decision::None } else { Decision::Shortlist(shortlist) }
}

/// The fewest effects that together reach the threshold.
fn class(p: &[f64], effects: &[usize], thresholds: &Thresholds) -> Option<Vec<usize>> {
    let mut mass = 0.0;
    for (number, effect) in effects.iter().take(thresholds.most).enumerate() {
        mass += p[*effect];
        if number > 0 && mass >= thresholds.class {
            return Some(effects[..=number].to_vec());
        }
    }
    None
}

impl Losses {
    /// What a report costs where the outcome of a position is true.
    pub fn of(&self, decision: &Decision, truth: usize, outcomes: &[Outcome]) -> f64 {
        match decision {
            Decision::Named(effect) if *effect == truth => 0.0,
            Decision::Class(class) if class.contains(&truth) => self.member * (class.len() - 1) as f64,
            Decision::Named(_) | Decision::Class(_) => self.wrong,
            Decision::Shortlist(_) => self.silence,
            Decision::None if outcomes[truth] == Outcome::Effect => self.silence,
            Decision::None => 0.0,
        }
    }
}
