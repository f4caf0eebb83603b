//! Making the rigs and sealing their keys.

use super::design::Ticket;
use crate::examination;
use crate::generate::{Key, MadeRig, MakeError};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::collections::HashMap;
use switchback_model::rig::Rig;

/// A rig whose key is closed: whoever diagnoses it takes [`Sealed::rig`].
#[derive(Debug)]
pub struct Sealed {
    ticket: Ticket,
    key: Key,
}

impl Sealed {
    /// Which rig of the design.
    pub fn ticket(&self) -> &Ticket {
        &self.ticket
    }

    /// What a user's folder would hold, made again from the recipe.
    ///
    /// # Errors
    /// [`MakeError`] never in practice: the same recipe was made before.
    pub fn rig(&self) -> Result<Rig, MakeError> {
        Ok(self.ticket.recipe.again(&self.key)?.rig)
    }

    /// Opens the key: the rig with everything withheld.
    ///
    /// # Errors
    /// As [`Sealed::rig`].
    pub fn open(&self) -> Result<MadeRig, MakeError> {
        self.ticket.recipe.again(&self.key)
    }
}

/// Makes every rig once, in parallel, and keeps its key. What the same program found before is not searched for again. `done` hears
/// of each rig.
///
/// # Errors
/// [`MakeError`] of the first rig that could not be made.
pub fn seal(
    tickets: Vec<Ticket>,
    before: &WrittenKeys,
    done: &(dyn Fn() + Sync),
) -> Result<Vec<Sealed>, MakeError> {
    tickets
        .into_par_iter()
        .map(|ticket| {
            let sealed = match before.reopened(&ticket)? {
                Some(key) => Sealed { ticket, key },
                None => Sealed { key: ticket.recipe.make()?.key, ticket },
            };
            done();
            Ok(sealed)
        })
        .collect()
}

/// The keys in a key file, by the number of the rig.
#[derive(Debug, Default)]
pub struct WrittenKeys(HashMap<usize, (String, Found)>);

/// What a key says that was searched for.
#[derive(Debug, Deserialize)]
struct Found {
    id: usize,
    noise_sd: f64,
    effects: Vec<FoundEffect>,
}

#[derive(Debug, Deserialize)]
struct FoundEffect {
    magnitude: f64,
    size: f64,
}

impl WrittenKeys {
    /// Reads a key file; lines that are no keys are none.
    pub fn read(key_file: &str) -> Self {
        let key = |line: &str| {
            let found: Found = serde_json::from_str(line).ok()?;
            Some((found.id, (line.to_owned(), found)))
        };
        Self(key_file.lines().filter_map(key).collect())
    }

    /// The key of a rig, if making the rig again from what was found gives the line that was written.
    fn reopened(&self, ticket: &Ticket) -> Result<Option<Key>, MakeError> {
        let Some((line, Found { noise_sd, effects, .. })) = self.0.get(&ticket.id) else { return Ok(None) };
        let found: Vec<(f64, f64)> = effects.iter().map(|e| (e.magnitude, e.size)).collect();
        let made = ticket.recipe.made_with(*noise_sd, &found)?;
        Ok(made.map(|made| made.key).filter(|key| key_line(ticket, key) == *line))
    }
}

#[derive(Serialize)]
struct WrittenKey<'a> {
    id: usize,
    kind: &'a str,
    withheld: Option<&'a str>,
    seed: u64,
    order: usize,
    borders: &'a str,
    curved: bool,
    noise_sd: f64,
    size: f64,
    #[serde(skip_serializing_if = "<[_]>::is_empty")]
    base: &'a [&'a str],
    effects: Vec<WrittenEffect<'a>>,
}

#[derive(Serialize)]
struct WrittenEffect<'a> {
    effect: &'a str,
    law: &'a str,
    magnitude: f64,
    unit: &'a str,
    size: f64,
}

impl examination::Sealed for Sealed {
    fn id(&self) -> usize {
        self.ticket.id
    }

    fn key_line(&self) -> String {
        key_line(&self.ticket, &self.key)
    }
}

fn key_line(ticket: &Ticket, key: &Key) -> String {
    let written = WrittenKey {
        id: ticket.id,
        kind: ticket.kind.name(),
        withheld: ticket.withheld,
        seed: key.seed,
        order: key.order,
        borders: key.borders,
        curved: key.curved,
        noise_sd: key.noise_sd,
        size: key.size,
        base: &key.base,
        effects: key
            .effects
            .iter()
            .map(|e| WrittenEffect {
                effect: e.effect,
                law: e.law,
                magnitude: e.magnitude,
                unit: e.unit,
                size: e.size,
            })
            .collect(),
    };
    serde_json::to_string(&written).expect("numbers and strings are JSON")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::blind::Kind;
    use crate::examination::key_file;
    use crate::generate::{MakeRig, Plan, RequestedFault};

    #[test]
    fn a_key_is_taken_over_only_where_it_gives_the_same_rig() {
        let plan = Plan { step: 120, periods: 8, sweep: 400, drive: 200, repeat_periods: 3 };
        let backlash = RequestedFault::plain("backlash", 1.0).expect("an effect");
        let recipe = MakeRig::new(7).plan(plan).with(backlash);
        let ticket = Ticket { id: 3, kind: Kind::Single, system: 0, withheld: None, recipe };
        let sealed = seal(vec![ticket.clone()], &WrittenKeys::default(), &|| ()).expect("a rig");
        let file = key_file(&sealed);
        let reopened = |file: &str| WrittenKeys::read(file).reopened(&ticket).expect("a rig");
        assert_eq!(reopened(&file).map(|key| key_line(&ticket, &key) + "\n"), Some(file.clone()));
        // Of another rig, of another recipe, and no key at all.
        assert_eq!(reopened(&file.replace("\"id\":3", "\"id\":4")), None);
        assert_eq!(reopened(&file.replace("\"seed\":7", "\"seed\":8")), None);
        assert_eq!(reopened("{\"id\":3}"), None);
    }
}
