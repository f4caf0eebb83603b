//! SVG files, read as XML against a list of the parts of a drawing, and written again from the parsed tree: nothing of the file's own bytes
//! comes onto a page.

use maud::Escaper;
use roxmltree::{Document, Node};
use std::fmt::Write;

/// Elements that draw.
const ELEMENTS: [&str; 10] =
    ["svg", "g", "title", "desc", "rect", "circle", "line", "polyline", "polygon", "text"];
/// Elements that hold text.
const TEXTS: [&str; 3] = ["title", "desc", "text"];
const NAMESPACE: &str = "http://www.w3.org/2000/svg";
/// Letters of a value that a message quotes.
const QUOTED: usize = 60;
/// Elements within each other at most.
const DEPTH: usize = 16;

/// The values that an attribute may have.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Values {
    /// Numbers with units.
    Numbers,
    /// Colours and words.
    Words,
    /// A rotation.
    Rotation,
    /// One word.
    Only(&'static str),
    /// Any text: nothing but the page's own script and screen readers read it.
    Text,
}

impl Values {
    /// The values of an attribute; `None` for one that no drawing has.
    fn of(attribute: &str) -> Option<Self> {
        Some(match attribute {
            "width" | "height" | "viewBox" | "x" | "y" | "dx" | "dy" | "x1" | "y1" | "x2" | "y2" | "cx"
            | "cy" | "r" | "points" | "opacity" | "fill-opacity" | "stroke-width" | "stroke-dasharray"
            | "font-size" | "data-in" | "data-ticks" | "data-frame" => Self::Numbers,
            "fill" | "stroke" | "text-anchor" | "font-family" | "font-weight" | "font-style" => Self::Words,
            "transform" => Self::Rotation,
            "role" => Self::Only("img"),
            "class" => Self::Only("hint"),
            "aria-label" | "data-series" | "data-of" | "data-hides" | "data-x" | "data-y" | "data-name"
            | "data-zooms" => Self::Text,
            _ => return None,
        })
    }

    fn holds(self, value: &str) -> bool {
        let is_number = |c: char| c.is_ascii_digit() || c.is_ascii_whitespace() || ".,+-%emx".contains(c);
        let is_word = |c: char| c.is_ascii_alphanumeric() || " #-,".contains(c);
        match self {
            Self::Numbers => value.chars().all(is_number),
            Self::Words => value.chars().all(is_word),
            Self::Rotation => {
                let inside = value.strip_prefix("rotate(").and_then(|rest| rest.strip_suffix(')'));
                inside.is_some_and(|inside| inside.chars().all(is_number))
            }
            Self::Only(word) => value == word,
            Self::Text => true,
        }
    }
}

/// The drawing of a file as HTML holds it; `name` is read to those who do not see it where the file has no name of its own.
///
/// # Errors
/// Why it is none: no XML, or something that no drawing holds.
pub(super) fn redrawn(svg: &str, name: &str) -> Result<String, String> {
    let document = Document::parse(svg).map_err(|error| format!("it is no XML: {error}"))?;
    let root = document.root_element();
    if root.tag_name().name() != "svg" {
        return Err(format!("it begins with `{}` in place of `svg`", root.tag_name().name()));
    }
    let mut html = String::with_capacity(svg.len());
    element(root, (!root.has_attribute("aria-label")).then_some(name), 0, &mut html)?;
    Ok(html)
}

fn element(node: Node<'_, '_>, name: Option<&str>, depth: usize, html: &mut String) -> Result<(), String> {
    let tag = node.tag_name();
    if tag.namespace() != Some(NAMESPACE) {
        return Err(format!("its element `{}` is none of SVG", tag.name()));
    }
    if !ELEMENTS.contains(&tag.name()) || (depth > 0) == (tag.name() == "svg") {
        return Err(format!("it holds an element `{}`", tag.name()));
    }
    if depth > DEPTH {
        return Err(format!("its elements lie in each other more than {DEPTH} deep"));
    }
    let _ = write!(html, "<{}", tag.name());
    if let Some(name) = name {
        attribute("role", "img", html);
        attribute("aria-label", name, html);
    }
    for found in node.attributes().filter(|found| name.is_none() || found.name() != "role") {
        let values = Values::of(found.name()).filter(|_| found.namespace().is_none());
        if !values.is_some_and(|values| values.holds(found.value())) {
            let (name, value) = (found.name(), quoted(found.value()));
            return Err(format!("its element `{}` has an attribute {name}=\"{value}\"", tag.name()));
        }
        attribute(found.name(), found.value(), html);
    }
    html.push('>');
    for child in node.children() {
        match child.text().filter(|_| child.is_text()) {
            Some(text) if TEXTS.contains(&tag.name()) || text.trim().is_empty() => escaped(text, html),
            Some(text) => {
                return Err(format!("its element `{}` holds the text `{}`", tag.name(), quoted(text.trim())));
            }
            None if child.is_element() => element(child, None, depth + 1, html)?,
            None => {}
        }
    }
    let _ = write!(html, "</{}>", tag.name());
    Ok(())
}

fn quoted(text: &str) -> String {
    text.chars().take(QUOTED).collect()
}

fn attribute(name: &str, value: &str, html: &mut String) {
    let _ = write!(html, " {name}=\"");
    escaped(value, html);
    html.push('"');
}

fn escaped(text: &str, html: &mut String) {
    let _ = Escaper::new(html).write_str(text);
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn svg(inside: &str) -> String {
        format!("<svg xmlns=\"{NAMESPACE}\" width=\"9\" height=\"9\">{inside}</svg>")
    }

    #[test]
    fn a_drawing_stays_as_it_is() {
        let file = svg(
            "<text x=\"1\" dy=\"0.5ex\">\na &lt; b &amp; \"c\", javascript: onload\n</text><g data-series=\"a\"/>",
        );
        let html = redrawn(&("<?xml version=\"1.0\"?><!-- a -->\n".to_owned() + &file), "a name")
            .expect("a drawing");
        assert_eq!(
            html,
            "<svg role=\"img\" aria-label=\"a name\" width=\"9\" height=\"9\"><text x=\"1\" dy=\"0.5ex\">\na &lt; b &amp; &quot;c&quot;, \
             javascript: onload\n</text><g data-series=\"a\"></g></svg>"
        );
    }

    #[test]
    fn whatever_does_more_than_draw_is_refused() {
        let drawn = |file: &str| redrawn(file, "a name");
        for (file, why) in [
            ("no svg at all", "it is no XML"),
            ("<svg/onload=\"document.title='PWNED'\" width=\"9\" height=\"9\"></svg>", "it is no XML"),
            (
                "<svg a=\">\" onload=\"document.title='PWNED'\" width=\"9\" height=\"9\"></svg>",
                "element `svg`",
            ),
            (
                "<svg a=\"'\" onload=document.title=`PWNED` b=\"'\" width=\"9\" height=\"9\"></svg>",
                "it is no XML",
            ),
            (
                "<!DOCTYPE svg [<!ENTITY a \"b\">]><svg xmlns=\"http://www.w3.org/2000/svg\">&a;</svg>",
                "it is no XML",
            ),
            ("<html xmlns=\"http://www.w3.org/1999/xhtml\"/>", "begins with `html`"),
            ("<svg width=\"9\"/>", "element `svg` is none of SVG"),
        ] {
            let refusal = drawn(file).expect_err(file);
            assert!(refusal.contains(why), "{file}: {refusal}");
        }
        for (inside, why) in [
            ("<script>alert(1)</script>", "element `script`"),
            ("<SCRIPT>alert(1)</SCRIPT>", "element `SCRIPT`"),
            ("<svg/>", "element `svg`"),
            ("<foreignObject/>", "element `foreignObject`"),
            ("<g><style>a{}</style></g>", "element `style`"),
            ("<p xmlns=\"http://www.w3.org/1999/xhtml\"/>", "element `p`"),
            ("<image href=\"http://somewhere\"/>", "element `image`"),
            ("<a href=\"javascript:alert(1)\"/>", "element `a`"),
            ("<text onclick=\"alert(1)\"/>", "attribute onclick"),
            ("<text style=\"fill:url(http://somewhere)\"/>", "attribute style"),
            ("<rect fill=\"url(http://somewhere)\"/>", "attribute fill"),
            ("<rect transform=\"url(#a)\"/>", "attribute transform"),
            ("<rect class=\"tip\"/>", "attribute class"),
            ("<rect data-frame=\"&quot;]\"/>", "attribute data-frame"),
            ("<rect xmlns:l=\"http://www.w3.org/1999/xlink\" l:x=\"1\"/>", "attribute x"),
            ("<g>text</g>", "holds the text `text`"),
        ] {
            let refusal = drawn(&svg(inside)).expect_err(inside);
            assert!(refusal.contains(why), "{inside}: {refusal}");
        }
        let deep = |depth: usize| svg(&("<g>".repeat(depth) + &"</g>".repeat(depth)));
        assert!(drawn(&deep(DEPTH)).is_ok() && drawn(&deep(DEPTH + 1)).is_err());
    }

    #[test]
    fn every_committed_figure_is_a_drawing() {
        let reports = concat!(env!("CARGO_MANIFEST_DIR"), "/../../reports");
        let folders =
            std::fs::read_dir(reports).expect("a folder").map(|entry| entry.expect("a name").path());
        let files =
            folders.filter(|path| path.is_dir()).flat_map(|path| std::fs::read_dir(path).expect("a folder"));
        let figures = files.map(|entry| entry.expect("a name").path());
        let mut count = 0;
        for path in figures.filter(|path| path.extension().is_some_and(|end| end == "svg")) {
            let svg = std::fs::read_to_string(&path).expect("a figure");
            assert_eq!(redrawn(&svg, "a name").map(drop), Ok(()), "{}", path.display());
            count += 1;
        }
        assert!(count >= 12, "a dozen figures stand in the documents: {count}");
    }

    fn pieces() -> impl Strategy<Value = String> {
        let names = prop::sample::select(vec![
            "g",
            "text",
            "title",
            "rect",
            "script",
            "a",
            "use",
            "image",
            "foreignObject",
            "style",
            "animate",
            "set",
            "x:g",
            "iframe",
        ]);
        let attributes = prop::sample::select(vec![
            "x",
            "fill",
            "transform",
            "points",
            "aria-label",
            "data-x",
            "onload",
            "onclick",
            "ONLOAD",
            "href",
            "xlink:href",
            "style",
            "class",
            "id",
            "xml:base",
            "xmlns",
        ]);
        let values = prop::sample::select(vec![
            "1",
            "none",
            "rotate(1)",
            "hint",
            "javascript:alert(1)",
            "url(javascript:alert(1))",
            "&gt;&lt;script&gt;",
            ">",
            "'",
            "&quot; onload=&quot;alert(1)",
            "http://www.w3.org/1999/xhtml",
        ]);
        let attribute = (attributes, values).prop_map(|(name, value)| format!(" {name}=\"{value}\""));
        let texts = prop::sample::select(vec![
            "",
            "a",
            "&lt;script&gt;",
            "<![CDATA[<script>alert(1)</script>]]>",
            "<!-- -->",
        ]);
        (names, prop::collection::vec(attribute, 0..3), texts)
            .prop_map(|(name, attributes, text)| format!("<{name}{}>{text}</{name}>", attributes.concat()))
    }

    proptest! {
        #[test]
        fn nothing_that_acts_survives(pieces in prop::collection::vec(pieces(), 0..4), cut in 0..200usize, junk in "[<>'\"/=a-z ]{0,3}") {
            let mut file = svg(&pieces.concat());
            let cut = cut.min(file.len());
            if file.is_char_boundary(cut) {
                file.insert_str(cut, &junk);
            }
            let Ok(html) = redrawn(&file, "a name") else { return Ok(()) };
            let document = Document::parse(&html).expect("it is well-formed");
            for node in document.descendants().filter(Node::is_element) {
                prop_assert!(ELEMENTS.contains(&node.tag_name().name()) && node.tag_name().namespace().is_none(), "{html}");
                for found in node.attributes() {
                    let name = found.name().to_ascii_lowercase();
                    prop_assert!(!name.starts_with("on") && !["href", "style", "id", "base"].contains(&&*name), "{html}");
                    let is_text = name.starts_with("data-") || name == "aria-label";
                    prop_assert!(is_text || !found.value().contains(':'), "{html}");
                }
            }
        }
    }
}
