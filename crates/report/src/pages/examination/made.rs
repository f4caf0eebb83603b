//! How an examination was made.

use maud::{Markup, html};
use serde_json::Value;
use std::collections::BTreeMap;

/// What both kinds report how they were made.
pub(super) struct Made<'a> {
    pub(super) study: &'a str,
    pub(super) version: &'a str,
    pub(super) seed: u64,
    pub(super) rigs: &'a BTreeMap<String, usize>,
    pub(super) key: &'a str,
    pub(super) design: &'a Value,
}

impl Made<'_> {
    pub(super) fn html(&self) -> Markup {
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
