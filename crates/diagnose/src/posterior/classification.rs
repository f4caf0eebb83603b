//! What a posterior says of a rig.

use super::decision::{Decision, Outcome, Thresholds, decide};
use super::error::PosteriorError;
use super::leading_fit::LeadingFit;
use super::likelihoods::{Fits, Likelihoods, Probabilities, Weights};
use super::prior::Prior;
use super::weights::Posterior;
use crate::comparison::Compared;
use crate::differences::Row;
use crate::effect::Effect;
use crate::evidence::Judged;
use crate::settings::Settings;
use crate::verdict::answer::{Status, Verdict, naming_nothing};

/// A name that a cause has in the posterior, with its probability.
#[derive(Debug, Clone, PartialEq)]
pub struct Cause {
    /// The name of the effect.
    pub name: String,
    /// The effect, where a diagnosis can name it.
    pub effect: Option<Effect>,
    /// Its probability.
    pub probability: f64,
    /// Log-likelihood that it gains with the nominal system, both fitted, nats a sample; none where it was not fitted.
    pub gain: Option<f64>,
}

/// Probabilities of the causes of a rig's gap, which sum to one with those that nothing is missing and that it is none of these.
#[derive(Debug, Clone, PartialEq)]
pub struct Classification {
    /// Rigs that the posterior was trained on; none where evidence was not asked, or the records show none, and the prior stands for it.
    pub rows: usize,
    /// How common causes were taken to be.
    pub prior: Prior,
    /// All causes, likeliest first.
    pub causes: Vec<Cause>,
    /// Probability that nothing is missing.
    pub none: f64,
    /// Probability of a cause that has no name.
    pub none_of_these: f64,
    /// Share of the rigs held out in training that lie nearer to the population than this one.
    pub novelty: f64,
    /// From which probabilities on a cause is reported.
    pub thresholds: Thresholds,
    /// The fit that joined the probabilities, where one leads.
    pub leading: Option<LeadingFit>,
    /// The fits whose likelihoods joined them, where the structure of the model is known.
    pub likelihoods: Option<Likelihoods>,
}

/// Share of the rigs held out in training beyond which a rig is not one of their kind.
const OUTSIDE: f64 = 0.99;

impl Classification {
    /// Of a rig's evidence. Effects that the settings leave out, and the colour of noise where it is not asked for, are no causes.
    ///
    /// # Errors
    /// [`PosteriorError`] where the posterior was trained with other columns.
    pub(crate) fn of(judged: &Judged, settings: &Settings) -> Result<Self, PosteriorError> {
        let posterior = settings.posterior();
        let named: Vec<(&str, f64)> =
            judged.evidence.columns.iter().map(|(name, value)| (name.as_str(), *value)).collect();
        let row = posterior.row(&named)?;
        let mut p = posterior.probabilities(&row, Posterior::ALL)?;
        let prior = settings.prior.unwrap_or(posterior.prior);
        for (p, name) in p.iter_mut().zip(&posterior.classes) {
            *p *= match (name.as_str(), Effect::from_name(name)) {
                (NOTHING, _) => prior.none / posterior.prior.none,
                (NONE_OF_THESE, _) => prior.none_of_these / posterior.prior.none_of_these,
                (_, Some(effect)) if settings.is_no_cause(effect) => 0.0,
                _ => prior.effect / posterior.prior.effect,
            };
        }
        let sum: f64 = p.iter().sum::<f64>().max(f64::MIN_POSITIVE);
        let of = |wanted: &str| -> f64 {
            posterior.classes.iter().zip(&p).filter(|(name, _)| *name == wanted).map(|(_, p)| p / sum).sum()
        };
        let gain = |name: &str| {
            let fitted = judged.evidence.fits.iter().find(|fit| fit.effect == name);
            fitted.map(|fit| fit.gain)
        };
        let cause = |(name, p): (&String, &f64)| Cause {
            effect: Effect::from_name(name),
            probability: p / sum,
            gain: gain(name),
            name: name.clone(),
        };
        let is_cause = |(name, _): &(&String, &f64)| ![NOTHING, NONE_OF_THESE].contains(&name.as_str());
        let mut causes: Vec<Cause> = posterior.classes.iter().zip(&p).filter(is_cause).map(cause).collect();
        causes.sort_by(|x, y| y.probability.total_cmp(&x.probability));
        Ok(Self {
            rows: posterior.rows,
            prior,
            causes,
            none: of(NOTHING),
            none_of_these: of(NONE_OF_THESE),
            novelty: posterior.novelty.quantile(&row),
            thresholds: posterior.thresholds,
            leading: None,
            likelihoods: None,
        })
    }

    /// Of a rig without evidence: the prior, by which all effects that are considered are as likely as each other.
    pub(crate) fn of_prior(settings: &Settings) -> Self {
        let posterior = settings.posterior();
        let prior = settings.prior.unwrap_or(posterior.prior);
        let considered = settings.effects.iter().filter(|effect| !settings.is_no_cause(**effect));
        let even = Probabilities::of_prior(prior, considered.map(|effect| (Some(*effect), true)));
        let cause = |(effect, probability): &(Option<Effect>, f64)| Cause {
            name: effect.map_or("", Effect::name).to_owned(),
            effect: *effect,
            probability: *probability,
            gain: None,
        };
        Self {
            rows: 0,
            prior,
            causes: even.causes.iter().map(cause).collect(),
            none: even.none,
            none_of_these: even.none_of_these,
            novelty: 0.0,
            thresholds: posterior.thresholds,
            leading: None,
            likelihoods: None,
        }
    }

    /// The fit that leads in a comparison, if one does.
    pub(crate) fn leading_fit(&self, compared: &Compared) -> Option<LeadingFit> {
        LeadingFit::of(compared, |effect| self.probability(effect))
    }

    /// The effect that leads among those missing in a source, if one does.
    pub(crate) fn leading_difference(&self, missing: &[(Effect, &Row)]) -> Option<LeadingFit> {
        LeadingFit::missing(missing, |effect| self.probability(effect))
    }

    /// The probabilities joined by a fit that leads.
    #[must_use]
    pub(crate) fn joined_by(mut self, leading: Option<LeadingFit>) -> Self {
        let Some(leading) = leading else { return self };
        let weight = leading.weight();
        let sum = 1.0 + leading.by_evidence * (weight - 1.0);
        for cause in &mut self.causes {
            let factor = if cause.effect == Some(leading.effect) { weight } else { 1.0 };
            cause.probability *= factor / sum;
        }
        self.causes.sort_by(|x, y| y.probability.total_cmp(&x.probability));
        let (none, none_of_these) = (self.none / sum, self.none_of_these / sum);
        Self { none, none_of_these, leading: Some(leading), ..self }
    }

    /// The probabilities joined by the likelihoods of fits. Evidence of a rig unlike those of the training says nothing: the prior stands for it.
    #[must_use]
    pub(crate) fn joined_by_likelihoods(mut self, fits: Fits) -> Self {
        let before = match self.is_outside() {
            true => Probabilities::of_prior(
                self.prior,
                self.causes.iter().map(|cause| (cause.effect, cause.probability > 0.0)),
            ),
            false => Probabilities {
                causes: self.causes.iter().map(|cause| (cause.effect, cause.probability)).collect(),
                none: self.none,
                none_of_these: self.none_of_these,
            },
        };
        let likelihoods = Likelihoods { fits, before };
        let Probabilities { causes, none, none_of_these } = likelihoods.joined(&Weights::FITTED);
        for (cause, (_, probability)) in self.causes.iter_mut().zip(causes) {
            cause.probability = probability;
        }
        self.causes.sort_by(|x, y| y.probability.total_cmp(&x.probability));
        Self { none, none_of_these, likelihoods: Some(likelihoods), ..self }
    }

    /// Whether no evidence counts, since there is none or the rig is unlike those that the posterior was trained on, and no likelihoods of a model of a known
    /// structure joined.
    pub fn is_outside(&self) -> bool {
        (self.rows == 0 || self.novelty >= OUTSIDE) && self.likelihoods.is_none()
    }

    /// The effect whose fit leads, or the likeliest by the likelihoods of all fits.
    pub(crate) fn confirmed(&self) -> Option<Effect> {
        let likeliest = || self.likelihoods.as_ref().and_then(|_| Some(self.effects().first()?.0));
        self.leading.map(|leading| leading.effect).or_else(likeliest)
    }

    /// Effects that a diagnosis can name, likeliest first.
    pub fn effects(&self) -> Vec<(Effect, f64)> {
        self.causes.iter().filter_map(|cause| Some((cause.effect?, cause.probability))).collect()
    }

    /// Probability of an effect.
    pub fn probability(&self, effect: Effect) -> f64 {
        self.causes.iter().find(|cause| cause.effect == Some(effect)).map_or(0.0, |cause| cause.probability)
    }

    /// Probability of a cause that no diagnosis can name.
    pub fn unexplained(&self) -> f64 {
        self.none_of_these
            + self
                .causes
                .iter()
                .filter(|cause| cause.effect.is_none())
                .map(|cause| cause.probability)
                .sum::<f64>()
    }

    /// The effects that are fitted: until they have the probability of the settings, and no more than so many; all of them without evidence.
    pub(crate) fn head(&self, settings: &Settings) -> Vec<Effect> {
        let mut mass = 0.0;
        let mut head = Vec::new();
        let most = if self.rows == 0 { usize::MAX } else { settings.most_fitted };
        for (effect, p) in self.effects().into_iter().take(most) {
            if self.rows > 0 && mass >= settings.head || p <= 0.0 {
                break;
            }
            mass += p;
            head.push(effect);
        }
        head
    }

    /// The verdict of least expected loss.
    pub fn verdict(&self) -> Verdict {
        let effects = self.effects();
        let p: Vec<f64> = effects.iter().map(|(_, p)| *p).chain([self.none, self.unexplained()]).collect();
        let mut outcomes = vec![Outcome::Effect; effects.len()];
        outcomes.extend([Outcome::Nothing, Outcome::NoneOfThese]);
        let stage = effects.first().map(|(effect, _)| effect.stage());
        let several = |positions: &[usize]| {
            let class: Vec<Effect> = positions.iter().map(|k| effects[*k].0).collect();
            let alike = |one: &Effect| class.iter().any(|o| o != one && o.confounded_effects().contains(one));
            let status = if class.iter().all(alike) { Status::Class } else { Status::Ambiguous };
            let sum = positions.iter().map(|k| p[*k]).sum();
            let first = class[..1].to_vec();
            let effects = if status == Status::Class { first } else { Vec::new() };
            Verdict { effects, class, ..naming_nothing(status, stage, sum) }
        };
        let verdict = match decide(&p, &outcomes, &self.thresholds, self.is_outside()) {
            Decision::Named(k) => {
                Verdict { effects: vec![effects[k].0], ..naming_nothing(Status::Named, stage, p[k]) }
            }
            Decision::Class(class) => several(&class),
            Decision::Shortlist(list) => {
                Verdict { status: Status::Shortlist, effects: Vec::new(), ..several(&list) }
            }
            Decision::None if self.none >= self.unexplained() => {
                naming_nothing(Status::None, None, self.none)
            }
            Decision::None => naming_nothing(Status::Unexplained, stage, self.unexplained()),
        };
        Verdict { calibrated: !self.is_outside(), ..verdict }
    }
}

const NOTHING: &str = Posterior::NOTHING;
const NONE_OF_THESE: &str = Posterior::NONE_OF_THESE;

#[cfg(test)]
mod tests {
    use super::*;

    fn of(p: &[(&str, f64)], [none, none_of_these]: [f64; 2], novelty: f64) -> Classification {
        let cause = |(name, probability): &(&str, f64)| Cause {
            name: (*name).to_owned(),
            effect: Effect::from_name(name),
            probability: *probability,
            gain: None,
        };
        Classification {
            rows: 1,
            prior: Prior { effect: 0.6, none: 0.2, none_of_these: 0.2 },
            causes: p.iter().map(cause).collect(),
            none,
            none_of_these,
            novelty,
            thresholds: Thresholds::default(),
            leading: None,
            likelihoods: None,
        }
    }

    #[test]
    fn a_sure_cause_is_named_unless_the_rig_is_of_another_kind() {
        let sure = [("creep", 0.97), ("backlash", 0.01)];
        let named = of(&sure, [0.01, 0.01], 0.5).verdict();
        assert_eq!((named.status, &named.effects[..]), (Status::Named, &[Effect::Creep][..]));
        let strange = of(&sure, [0.01, 0.01], 1.0).verdict();
        assert_eq!((strange.status, strange.calibrated), (Status::Shortlist, false));
        assert!(strange.effects.is_empty());
    }

    #[test]
    fn a_class_is_confounded_rivals_are_ambiguous_and_less_is_a_shortlist() {
        let class = of(&[("backlash", 0.5), ("gradual_transition", 0.48)], [0.01, 0.01], 0.5).verdict();
        assert_eq!((class.status, class.class.len()), (Status::Class, 2));
        let rivals = of(&[("backlash", 0.5), ("sensor_drift", 0.48)], [0.01, 0.01], 0.5).verdict();
        assert_eq!((rivals.status, rivals.class.len()), (Status::Ambiguous, 2));
        let list = of(&[("backlash", 0.5), ("creep", 0.2)], [0.2, 0.1], 0.5).verdict();
        assert_eq!((list.status, list.class.len()), (Status::Shortlist, 2));
        assert!((list.probability - 0.7).abs() < 1e-12);
    }

    #[test]
    fn probabilities_joined_by_a_fit_sum_to_one() {
        let before = of(&[("backlash", 0.3), ("creep", 0.4)], [0.1, 0.2], 0.5);
        let leading = LeadingFit {
            effect: Effect::Backlash,
            closes: 0.9,
            gains: [900.0, 90.0],
            by_evidence: 0.3,
            coefficients: LeadingFit::OF_FITS,
        };
        let after = before.clone().joined_by(Some(leading));
        let sum = after.causes.iter().map(|cause| cause.probability).sum::<f64>()
            + after.none
            + after.none_of_these;
        assert!((sum - 1.0).abs() < 1e-12 && after.leading == Some(leading));
        assert!(after.causes[0].name == "backlash" && after.causes[0].probability > 0.3);
        // All others keep their ratios.
        assert!((after.none / after.none_of_these - 0.5).abs() < 1e-12);
        assert_eq!(before.clone().joined_by(None), before);
    }

    #[test]
    fn a_cause_without_a_law_here_counts_as_none_of_these() {
        let strange = of(&[("inertia", 0.6), ("creep", 0.2)], [0.1, 0.1], 0.5);
        assert!((strange.unexplained() - 0.7).abs() < 1e-12);
        assert_eq!(strange.verdict().status, Status::Unexplained);
        assert_eq!(of(&[("creep", 0.2)], [0.5, 0.3], 0.5).verdict().status, Status::None);
    }

    #[test]
    fn effects_are_fitted_until_their_probability_is_nearly_all() {
        let settings = Settings::default();
        let few = of(&[("creep", 0.985), ("backlash", 0.01)], [0.0, 0.005], 0.5);
        assert_eq!(few.head(&settings), [Effect::Creep]);
        let many =
            ["creep", "backlash", "stribeck", "extra_pole", "resonance", "gain_drift"].map(|n| (n, 0.1));
        assert_eq!(of(&many, [0.2, 0.2], 0.5).head(&settings).len(), settings.most_fitted);
    }
}
