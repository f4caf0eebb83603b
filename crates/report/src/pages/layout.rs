//! How a page is put together: head, contents, sections, foot. A page only says its sections.

use maud::{DOCTYPE, Markup, PreEscaped, html};

/// A page: what it is of, what comes of it in a sentence, and sections.
pub(super) struct Page {
    kind: &'static str,
    title: String,
    lead: Markup,
    sections: Vec<Section>,
}

struct Section {
    id: &'static str,
    title: &'static str,
    body: Markup,
}

/// Nothing is fetched from anywhere: a page is one file.
const POLICY: &str =
    "default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'; img-src data:";

const STYLE: &str = include_str!("style.css");
const SCRIPT: &str = include_str!("script.js");

impl Page {
    /// A page without sections; `kind` says what was done, `lead` what came of it.
    pub(super) fn new(kind: &'static str, title: impl Into<String>, lead: Markup) -> Self {
        Self { kind, title: title.into(), lead, sections: Vec::new() }
    }

    /// The same with another section, if there is anything in it.
    pub(super) fn section(mut self, id: &'static str, title: &'static str, body: Markup) -> Self {
        if !body.0.is_empty() {
            self.sections.push(Section { id, title, body });
        }
        self
    }

    /// The file.
    pub(super) fn html(&self) -> String {
        let page = html! {
            (DOCTYPE)
            html lang="en" {
                head {
                    meta charset="utf-8";
                    meta name="viewport" content="width=device-width, initial-scale=1";
                    meta http-equiv="Content-Security-Policy" content=(POLICY);
                    meta name="color-scheme" content="light dark";
                    link rel="icon" href="data:,";
                    title { (self.title) " – " (self.kind) " – Switchback" }
                    style { (PreEscaped(STYLE)) }
                }
                body {
                    a class="skip" href="#content" { "Skip to the content" }
                    header {
                        p class="kind" { (self.kind) }
                        h1 { (self.title) }
                        (self.lead)
                    }
                    nav aria-label="Contents" {
                        ol { @for section in &self.sections { li { a href={ "#" (section.id) } { (section.title) } } } }
                    }
                    main id="content" {
                        @for section in &self.sections {
                            section id=(section.id) aria-labelledby={ (section.id) "-title" } {
                                h2 id={ (section.id) "-title" } { (section.title) }
                                (section.body)
                            }
                        }
                    }
                    footer { p { "Drawn by Switchback " (env!("CARGO_PKG_VERSION")) " from the files beside this page alone; " code { "switchback report FOLDER" } " draws it again." } }
                    script { (PreEscaped(SCRIPT)) }
                }
            }
        };
        page.into_string() + "\n"
    }
}
