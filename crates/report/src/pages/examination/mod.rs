//! The page of a blind or a field examination.

mod blind;
mod field;
mod measures;

use super::error::PageError;
use super::files::Files;
use crate::pages::table::Cell;
use maud::{Markup, html};
use serde_json::Value;
use std::collections::BTreeMap;
use switchback_lab::blind::json as blind_json;
use switchback_lab::examination::{Partial, ShareFile};
use switchback_lab::field::json as field_json;

/// The page of the files of an examination.
///
/// # Errors
/// [`PageError`] if results.json is of another format.
pub(super) fn examination(files: &Files) -> Result<String, PageError> {
    match files.needed("results.json")?.contains("\"switchback/field/") {
        true => field::field(files, &files.object("results.json", field_json::SCHEMA)?),
        false => blind::blind(files, &files.object("results.json", blind_json::SCHEMA)?),
    }
}

/// What both kinds tell of how they were made.
struct Made<'a> {
    study: &'a str,
    version: &'a str,
    seed: u64,
    rigs: &'a BTreeMap<String, usize>,
    key: &'a str,
    design: &'a Value,
}

impl Made<'_> {
    fn html(&self) -> Markup {
        let rigs: Vec<String> = self.rigs.iter().map(|(kind, count)| format!("{kind} {count}")).collect();
        html! {
            dl {
                dt { "kind" } dd { (self.study) }
                dt { "version" } dd { "Switchback " (self.version) }
                dt { "seed" } dd { (self.seed) }
                dt { "rigs" } dd { (rigs.join(", ")) }
                dt { "SHA-256 of the keys" } dd { code { (self.key) } }
            }
            p class="note" { "Keys, which say what was put into each rig, were written and hashed before the first diagnosis; key.jsonl holds them." }
            h3 { "The design" }
            pre tabindex="0" role="region" aria-label="The design" { code { (format!("{:#}", self.design)) } }
        }
    }
}

fn partial(partial: Option<Partial>) -> Markup {
    html! { @if let Some(partial) = partial { p class="bad" { strong { (partial) } } } }
}

/// `96.0 % (145 of 151)`.
fn share(share: ShareFile) -> Cell {
    match share.share {
        Some(value) => {
            Cell::number(format!("{:.1} % ({} of {})", 100.0 * value, share.count, share.of), Some(value))
        }
        None => Cell::number("–", None),
    }
}
