//! Making a rig of the laboratory, and its key.

use crate::examination::design::Design;
use crate::examination::scenario::Study;
use crate::examination::ticket::Ticket;
use crate::generate::{Family, Key, MakeError, MakeRig};
use serde::{Deserialize, Serialize};

/// How to make the rig of a ticket.
pub(super) fn recipe(study: &Study, ticket: &Ticket) -> Result<MakeRig, MakeError> {
    let family = Family { order: Some(1 + ticket.base % 3), shape: None };
    let plain = MakeRig::new(ticket.seed).family(family).plan(study.plan);
    ticket.faults.iter().try_fold(plain, |recipe, fault| Ok(recipe.with(fault.requested_fault()?)))
}

/// Makes a rig once and keeps its key. What the same program found before and wrote is not searched for again.
pub(crate) fn sealed(study: &Study, ticket: &Ticket, written: Option<&str>) -> Result<Key, MakeError> {
    let recipe = recipe(study, ticket)?;
    match written.map(|line| reopened(&recipe, ticket, line)).transpose()?.flatten() {
        Some(key) => Ok(key),
        None => Ok(recipe.make()?.key),
    }
}

/// What a key says that was searched for.
#[derive(Debug, Deserialize)]
struct Found {
    noise_sd: f64,
    effects: Vec<FoundEffect>,
}

#[derive(Debug, Deserialize)]
struct FoundEffect {
    magnitude: f64,
    size: f64,
}

/// The key of a line, if making the rig again from what was found gives the line that was written.
fn reopened(recipe: &MakeRig, ticket: &Ticket, line: &str) -> Result<Option<Key>, MakeError> {
    let Ok(Found { noise_sd, effects }) = serde_json::from_str(line) else { return Ok(None) };
    let found: Vec<(f64, f64)> = effects.iter().map(|e| (e.magnitude, e.size)).collect();
    let made = recipe.made_with(noise_sd, &found)?;
    Ok(made.map(|made| made.key).filter(|key| key_line(ticket, key) == line))
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

/// The line of a key file.
pub(crate) fn key_line(ticket: &Ticket, key: &Key) -> String {
    let effects = key.effects.iter().map(|e| WrittenEffect {
        effect: e.effect,
        law: e.law,
        magnitude: e.magnitude,
        unit: e.unit,
        size: e.size,
    });
    let written = WrittenKey {
        id: ticket.id,
        kind: Design::Laboratory.name(ticket.kind),
        withheld: ticket.withheld,
        seed: key.seed,
        order: key.order,
        borders: key.borders,
        curved: key.curved,
        noise_sd: key.noise_sd,
        size: key.size,
        base: &key.base,
        effects: effects.collect(),
    };
    serde_json::to_string(&written).expect("numbers and strings are JSON")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::examination::design::Kind;
    use crate::examination::wanted::Wanted;
    use crate::generate::Plan;

    #[test]
    fn a_key_is_taken_over_only_where_it_gives_the_same_rig() {
        let plan = Plan { step: 120, periods: 8, sweep: 400, drive: 200, repeat_periods: 3 };
        let faults = vec![Wanted::plain("backlash", 1.0)];
        let ticket = Ticket { id: 3, kind: Kind::Injected, base: 0, faults, withheld: None, seed: 7 };
        let recipe = MakeRig::new(7).plan(plan).with(ticket.faults[0].requested_fault().expect("an effect"));
        let line = key_line(&ticket, &recipe.make().expect("a rig").key);
        let reopened = |line: &str| reopened(&recipe, &ticket, line).expect("a rig");
        assert_eq!(reopened(&line).map(|key| key_line(&ticket, &key)), Some(line.clone()));
        // Of another rig, of another recipe, and no key at all.
        assert_eq!(reopened(&line.replace("\"id\":3", "\"id\":4")), None);
        assert_eq!(reopened(&line.replace("\"seed\":7", "\"seed\":8")), None);
        assert_eq!(reopened("{\"id\":3}"), None);
    }
}
