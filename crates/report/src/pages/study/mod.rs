//! The page of a consistency study.

mod answer;
mod cells;
mod made;
mod unresolved;
mod verdicts;

use super::error::PageError;
use super::layout::Page;
use super::sheet::sheets;
use crate::plots::Figure;
use maud::{Markup, html};
use switchback_study::results::Results;

/// The page of some results; `figures` are those that [`plots::consistency`](crate::plots::consistency) draws of them.
///
/// # Errors
/// [`PageError::NoDrawing`] if a figure is none.
pub(crate) fn study(results: &Results, figures: &[Figure]) -> Result<String, PageError> {
    let drawn = |starts: &[&str]| drawn(figures, starts);
    let lead = html! {
        p class="lead" { (results.question) }
        div class="box" {
            @if let Some(partial) = results.partial { p class="bad" { strong { (partial) } } }
            @if let Some(rounding) = results.rounding() { p class="bad" { strong { (rounding) } } }
            (answer::answer(results))
        }
    };
    Ok(Page::new("Consistency study", &results.name, lead)
        .section("verdicts", "Verdicts", verdicts::verdicts(results))
        .section(
            "curves",
            "Bias and standard deviation against N",
            html! { (drawn(&["ratios"])?) (drawn(&["bias", "sd"])?) },
        )
        .section("borders", "Borders", drawn(&["borders"])?)
        .section("efficiency", "Variance over the Cramér–Rao bound", drawn(&["efficiency"])?)
        .section("coverage", "Do intervals hold the truth", drawn(&["zip"])?)
        .section(
            "paired",
            "On the same noise",
            html! { (verdicts::paired(results)) (drawn(&["paired", "forest"])?) },
        )
        .section("figures", "Other figures", others(figures)?)
        .section("cells", "Cells of the design", cells::cells(results))
        .section("unresolved", "What was not resolved", unresolved::unresolved(results))
        .section("made", "How it was made", made::made(results))
        .html())
}

/// Names, by their beginning, of figures with a section of their own.
const PLACED: [&str; 8] = ["bias", "sd", "borders", "paired", "forest", "ratios", "efficiency", "zip"];

fn drawn(figures: &[Figure], starts: &[&str]) -> Result<Markup, PageError> {
    chosen(figures, |name| starts.iter().any(|start| name.starts_with(start)))
}

fn others(figures: &[Figure]) -> Result<Markup, PageError> {
    chosen(figures, |name| !PLACED.iter().any(|start| name.starts_with(start)))
}

fn chosen(figures: &[Figure], is_chosen: impl Fn(&str) -> bool) -> Result<Markup, PageError> {
    let chosen = figures.iter().filter(|figure| is_chosen(&figure.name));
    sheets(chosen.map(|figure| (&*figure.name, &*figure.svg)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plots;
    use switchback_study::results::synthetic;

    #[test]
    fn a_page_has_the_question_every_figure_and_no_address() {
        let results = synthetic::results();
        let figures = plots::consistency(&results);
        let page = study(&results, &figures).expect("a page");
        assert!(page.contains(&results.question) && page.contains("23 of 24 verdicts"));
        assert_eq!(page.matches("<figure class=\"sheet\">").count(), figures.len());
        let names = page.matches("\"http://www.w3.org/").count();
        assert_eq!(page.matches("://").count(), names, "a page fetches nothing");
        assert_eq!(page, study(&results, &figures).expect("a page"), "two drawings agree");
    }

    #[test]
    fn names_that_are_markup_are_shown_as_they_are() {
        let mut results = synthetic::results();
        results.name = "<script>alert(1)</script>".to_owned();
        results.question = "is a < b & \"c\"?".to_owned();
        let page = study(&results, &[]).expect("a page");
        assert_eq!(page.matches("<script>").count(), 1, "only the page's own script");
        assert!(page.contains("is a &lt; b &amp; &quot;c&quot;?"));
    }
}
