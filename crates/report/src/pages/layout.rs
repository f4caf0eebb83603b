//! How a page is put together: head, contents, sections, foot. A page only says its sections.

use maud::{DOCTYPE, Markup, PreEscaped, html};
use sha2::{Digest, Sha256};

/// A page: its kind and subject, the outcome in a sentence, and sections.
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

const STYLE: &str = include_str!("style.css");
const SCRIPT: &str = include_str!("script.js");

/// Nothing is fetched from anywhere, and nothing runs but the page's own script: a page is one file.
fn policy() -> String {
    let (style, script) = (digest(STYLE), digest(SCRIPT));
    format!("default-src 'none'; style-src '{style}'; script-src '{script}'; img-src data:")
}

/// The name of a text in a policy, `sha256-…`: its digest in base 64.
fn digest(text: &str) -> String {
    const LETTERS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let letters = Sha256::digest(text).chunks(3).fold(String::from("sha256-"), |mut letters, bytes| {
        let bits = (0..3).fold(0, |bits, k| bits << 8 | usize::from(bytes.get(k).copied().unwrap_or(0)));
        letters.extend((0..=bytes.len()).map(|k| char::from(LETTERS[bits >> (18 - 6 * k) & 63])));
        letters
    });
    // 32 bytes are ten threes and two.
    letters + "="
}

impl Page {
    /// A page without sections; `kind` names the work, `lead` its outcome.
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
                    meta http-equiv="Content-Security-Policy" content=(policy());
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_digest_is_that_of_the_specification() {
        // https://www.w3.org/TR/CSP2/#script-src-hash-usage
        assert_eq!(digest("alert('Hello, world.');"), "sha256-qznLcsROx4GACP2dm0UCKCzCG+HiZ1guq6ZZDob/Tng=");
    }

    #[test]
    fn a_page_lets_its_own_script_and_style_alone() {
        let page = Page::new("kind", "title", html! {}).html();
        assert!(
            !page.contains("unsafe-inline")
                && page.contains(&format!("script-src '{}'", html! { (digest(SCRIPT)) }.into_string()))
        );
        assert_eq!((page.matches(" style=").count(), page.matches("<script").count()), (0, 1));
        assert!(
            !SCRIPT.contains("</script")
                && !STYLE.contains("</style")
                && !(SCRIPT.to_owned() + STYLE).contains('\r')
        );
    }
}
