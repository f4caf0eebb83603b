//! Rules that every figure keeps to, read from its SVG.

use super::style::{TextLook, minus};

/// Whether all marks and texts are on the page, all texts keep to the style, and every legend entry that hides a series has one.
///
/// # Errors
/// The first that does not.
pub(crate) fn check(svg: &str) -> Result<(), String> {
    let header = svg.split('>').next().ok_or("no SVG")?;
    let page = numbers(attribute(header, "viewBox").ok_or("no page")?);
    let inside = |x: f64, y: f64| (page[0]..=page[2]).contains(&x) && (page[1]..=page[3]).contains(&y);
    if !header.contains("role=\"img\" aria-label=\"") {
        return Err("a screen reader finds no name".to_owned());
    }
    for hidden in svg.split(" data-hides=\"").skip(1).filter_map(|rest| rest.split('"').next()) {
        if !svg.contains(&format!("<g data-series=\"{hidden}\"")) {
            return Err(format!("no series is called {hidden}"));
        }
    }
    let mut texts = 0;
    for (at, element) in svg.match_indices('<').map(|(at, _)| (at, &svg[at..])) {
        let tag = element.split('>').next().unwrap_or_default();
        let has = |name: &str| attribute(tag, name).and_then(|value| value.parse::<f64>().ok());
        if tag.contains("NaN") || tag.contains("inf") {
            return Err(format!("no number in {tag}"));
        }
        for pair in attribute(tag, "points").map(numbers).unwrap_or_default().chunks_exact(2) {
            if !inside(pair[0], pair[1]) {
                return Err(format!("outside the page: {pair:?} of {tag}"));
            }
        }
        if let (Some(x), Some(y), Some(r)) = (has("cx"), has("cy"), has("r"))
            && !(inside(x - r, y - r) && inside(x + r, y + r))
        {
            return Err(format!("outside the page: {tag}"));
        }
        if let (Some(x), Some(y), true) = (has("x"), has("y"), tag.starts_with("<text")) {
            texts += 1;
            let text = svg[at + tag.len() + 1..].split("</text>").next().unwrap_or_default().trim();
            let text = text
                .replace("&amp;", "&")
                .replace("&lt;", "<")
                .replace("&gt;", ">")
                .replace("&quot;", "\"")
                .replace("&apos;", "'");
            if text != minus(&text) {
                return Err(format!("a hyphen in place of a minus sign: {text}"));
            }
            // The backend writes letters smaller than their box.
            let size = 1.24 * has("font-size").unwrap_or(0.0);
            let look = TextLook { size, bold: tag.contains("bold"), ..TextLook::label() };
            let width = look.width(&text);
            let (before, after) = match attribute(tag, "text-anchor") {
                Some("middle") => (width / 2.0, width / 2.0),
                Some("end") => (width, 0.0),
                _ => (0.0, width),
            };
            let ends = match tag.contains("rotate(270") {
                true => [(x, y + before), (x, y - after)],
                false => [(x - before, y), (x + after, y)],
            };
            if let Some(end) = ends.into_iter().find(|(x, y)| !inside(*x, *y)) {
                return Err(format!("outside the page at {end:?}: {text}"));
            }
        }
    }
    if texts == 0 { Err("no text".to_owned()) } else { Ok(()) }
}

fn attribute<'t>(tag: &'t str, name: &str) -> Option<&'t str> {
    tag.split(&format!(" {name}=\"")).nth(1)?.split('"').next()
}

fn numbers(text: &str) -> Vec<f64> {
    text.split([' ', ',']).filter_map(|number| number.parse().ok()).collect()
}

#[test]
fn what_leaves_the_page_is_found() {
    use super::canvas::draw;
    use super::style::{INK, Pen};
    let page = |paint: fn(&super::canvas::Canvas)| draw((100.0, 50.0), "a page", paint);
    let word = |canvas: &super::canvas::Canvas| canvas.text("a word", (10.0, 20.0), TextLook::label());
    assert_eq!(check(&page(word)), Ok(()));
    assert!(check(&page(|c| c.text("a word too long for it", (10.0, 20.0), TextLook::label()))).is_err());
    assert!(check(&page(|c| c.text("upwards and away", (10.0, 20.0), TextLook::label().upwards()))).is_err());
    assert!(check(&page(|c| c.disc((99.0, 20.0), 4.0, Pen::data(INK), true))).is_err());
    assert!(check(&page(|c| c.line(&[(10.0, 10.0), (101.0, 10.0)], Pen::data(INK)))).is_err());
    assert!(check(&page(|_| ())).is_err());
}
