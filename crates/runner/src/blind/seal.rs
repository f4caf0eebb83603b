//! Making the rigs and sealing their keys.

use super::design::Ticket;
use rayon::prelude::*;
use serde::Serialize;
use sha2::{Digest, Sha256};
use std::fmt::Write;
use switchback_estimator::rig::Rig;
use switchback_maker::{Key, MadeRig, MakeError};

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

/// Makes every rig once, in parallel, and keeps its key. `done` hears of each rig.
///
/// # Errors
/// [`MakeError`] of the first rig that could not be made.
pub fn seal(tickets: Vec<Ticket>, done: &(dyn Fn() + Sync)) -> Result<Vec<Sealed>, MakeError> {
    tickets
        .into_par_iter()
        .map(|ticket| {
            let key = ticket.recipe.make()?.key;
            done();
            Ok(Sealed { ticket, key })
        })
        .collect()
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

impl Sealed {
    /// The rig's line in the key file: whatever makes one rig another.
    pub fn key_line(&self) -> String {
        let Self { ticket, key } = self;
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
}

/// The key file: one JSON object a line and a rig, in the order of the design.
pub fn key_file(sealed: &[Sealed]) -> String {
    let mut all: Vec<&Sealed> = sealed.iter().collect();
    all.sort_by_key(|one| one.ticket.id);
    all.into_iter().fold(String::new(), |text, one| text + &one.key_line() + "\n")
}

/// SHA-256 of a text or of bytes, in hexadecimal as `sha256sum` prints it.
pub fn sha256(bytes: impl AsRef<[u8]>) -> String {
    let digest = Sha256::digest(bytes);
    digest.iter().fold(String::new(), |mut hex, byte| {
        let _ = write!(hex, "{byte:02x}");
        hex
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_hash_is_the_standards() {
        // FIPS 180-4, example "abc".
        assert_eq!(sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
    }
}
