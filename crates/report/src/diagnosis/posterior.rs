//! What a posterior says of a rig, as JSON and in words.

use super::probability::probability;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use switchback_diagnose::Effect;
use switchback_diagnose::posterior::{Cause, Classification};
use switchback_io::diagnosis::{digits, whole_percent};
use switchback_io::output::{columns, wrapped};

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct Posterior {
    /// Rigs that it was trained on; 0 where fits decide without evidence, or there is none: then the prior stands for it.
    pub examples: usize,
    /// How common causes are taken to be.
    pub prior: Prior,
    /// Every cause that it knows, likeliest first.
    pub causes: Vec<KnownCause>,
    /// Probability that nothing is missing.
    #[serde(deserialize_with = "switchback_io::input::nullable::number")]
    #[schemars(range(min = 0, max = 1))]
    pub probability_none: f64,
    /// Probability that something is missing which is none of the causes.
    #[serde(deserialize_with = "switchback_io::input::nullable::number")]
    #[schemars(range(min = 0, max = 1))]
    pub probability_unexplained: f64,
    /// Share of the rigs held out in training that lie nearer to its population than this rig; 0 without evidence.
    #[serde(deserialize_with = "switchback_io::input::nullable::number")]
    #[schemars(range(min = 0, max = 1))]
    pub novelty: f64,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct KnownCause {
    /// Its name: an effect, or one that a diagnosis cannot add to a model.
    pub cause: String,
    /// Its probability.
    #[serde(deserialize_with = "switchback_io::input::nullable::number")]
    #[schemars(range(min = 0, max = 1))]
    pub probability: f64,
    /// Log-likelihood that it gains over the nominal system, nats a sample; null where it was not fitted.
    pub gain: Option<f64>,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct Prior {
    /// One of the effects.
    #[serde(deserialize_with = "switchback_io::input::nullable::number")]
    #[schemars(range(min = 0, max = 1))]
    pub effect: f64,
    /// Nothing is missing.
    #[serde(deserialize_with = "switchback_io::input::nullable::number")]
    #[schemars(range(min = 0, max = 1))]
    pub none: f64,
    /// A cause that is no candidate.
    #[serde(deserialize_with = "switchback_io::input::nullable::number")]
    #[schemars(range(min = 0, max = 1))]
    pub unexplained: f64,
}

impl Posterior {
    /// Of a classification.
    pub(crate) fn of(classification: &Classification) -> Self {
        let cause = |cause: &Cause| KnownCause {
            cause: cause.name.clone(),
            probability: cause.probability,
            gain: cause.gain,
        };
        let prior = classification.prior;
        Self {
            examples: classification.rows,
            prior: Prior { effect: prior.effect, none: prior.none, unexplained: prior.none_of_these },
            causes: classification.causes.iter().map(cause).collect(),
            probability_none: classification.none,
            probability_unexplained: classification.none_of_these,
            novelty: classification.novelty,
        }
    }
}

/// Causes listed; all of them are in gap.json.
const LISTED: usize = 6;

/// The likeliest causes, each with its probability and the likelihood that speaks for it.
pub(super) fn words(classification: &Classification) -> String {
    let head = format!(
        "{}: nothing is missing with probability {}, it is none of these causes with {}. {}The likeliest causes, with what evidence shows that each gains as \
         maximum likelihood",
        basis(classification),
        probability(classification.none),
        probability(classification.none_of_these),
        distance(classification),
    );
    let mut rows = vec![["cause".to_owned(), "probability".to_owned(), "nats a sample".to_owned()]];
    for cause in classification.causes.iter().take(LISTED) {
        let gain = cause.gain.map_or("–".to_owned(), |gain| digits(gain, 3));
        rows.push([cause.name.replace('_', " "), probability(cause.probability), gain]);
    }
    format!("\n{}{}", wrapped(&head, ""), columns(&rows))
}

/// What the probabilities rest on.
fn basis(classification: &Classification) -> String {
    let prior = classification.prior;
    let shares = format!(
        "{} % have one of the effects, {} % nothing, {} % another cause",
        whole_percent(100.0 * prior.effect),
        whole_percent(100.0 * prior.none),
        whole_percent(100.0 * prior.none_of_these)
    );
    let before = match classification.rows {
        0 => format!("a prior by which {shares}"),
        rows => format!("a posterior trained on {rows} rigs whose cause is known ({shares})"),
    };
    match classification.likelihoods {
        Some(_) => format!("the verdict is that of the likelihoods of all fits, joined with {before}"),
        None => format!("the verdict is that of {before}"),
    }
}

/// How far the rig lies from the training population.
fn distance(classification: &Classification) -> String {
    if classification.rows == 0 {
        return String::new();
    }
    let nearer = whole_percent(100.0 * classification.novelty);
    format!("Of rigs held out in training {nearer} % lie nearer to the others than this one does. ")
}

impl KnownCause {
    /// Its name in words, with a note where a diagnosis cannot add it to a model.
    pub(crate) fn words(&self) -> String {
        let name = self.cause.replace('_', " ");
        if Effect::from_name(&self.cause).is_some() {
            name
        } else {
            format!("{name} (no law to repair it with)")
        }
    }
}
