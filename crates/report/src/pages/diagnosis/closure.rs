//! How far the gap closes, record by record.

use crate::diagnosis::json::{GapFile, Interval};
use maud::{Markup, html};
use switchback_io::diagnosis::{closed_percent, digits, fit_percent};

/// The gap before and after, and the closure with its interval on every record.
pub(super) fn closure(gap: &GapFile) -> Markup {
    let figures = &gap.gap;
    html! {
        div class="scroll" tabindex="0" role="region" aria-label="The gap before and after" {
            table {
                caption { "The gap as a share of the variance of y beyond the noise, with 90 % intervals" }
                thead { tr {
                    th scope="col" { "record" } th scope="col" class="n" { "fit before" } th scope="col" class="n" { "fit after" }
                    th scope="col" class="n" { "gap before" } th scope="col" class="n" { "gap after" } th scope="col" class="n" { "closure" } th scope="col" { "0 to 100 %" }
                } }
                tbody {
                    @for record in &figures.per_record {
                        tr {
                            td { (record.record) }
                            td class="n" { (fit_percent(record.fit_before)) " %" } td class="n" { (fit_percent(record.fit_after)) " %" }
                            td class="n" { (percent(record.before)) } td class="n" { (percent(record.after)) }
                            (closed(record.closure.as_ref()))
                        }
                    }
                    tr {
                        th scope="row" { "all of them" } td class="n" {} td class="n" {}
                        td class="n" { (with_interval(&figures.before)) } td class="n" { (with_interval(&figures.after)) }
                        (closed(figures.closure.as_ref()))
                    }
                }
            }
        }
        p class="note" {
            "Noise floor: " (digits(figures.noise_floor, 3)) " (standard deviation, output units). "
            @if let Some(anew) = &figures.identified_anew { "A model identified anew from the fit records leaves " (with_interval(anew)) ". " }
            "Intervals are of a bootstrap over blocks of 60 samples. There is no closure where the interval of the gap includes zero."
        }
    }
}

fn percent(x: f64) -> String {
    format!("{} %", digits(100.0 * x, 3))
}

fn with_interval(figure: &Interval) -> String {
    let [low, high] = figure.ci90.map(|x| digits(100.0 * x, 2));
    format!("{} [{low}, {high}]", percent(figure.estimate))
}

/// The closure as a figure, and drawn from 0 to 100 %.
fn closed(closure: Option<&Interval>) -> Markup {
    let Some(closure) = closure else { return html! { td class="n" { "–" } td {} } };
    let [low, high] = closure.ci90.map(|x| closed_percent(100.0 * x));
    // 20 to 180 of a drawing 200 wide stand for 0 to 100 %.
    let place = |x: f64| (20.0 + 160.0 * x).clamp(2.0, 198.0).round();
    let [left, right] = closure.ci90.map(place);
    html! {
        td class="n" { (closed_percent(100.0 * closure.estimate)) " % [" (low) ", " (high) "]" }
        td {
            svg class="bar" width="200" height="16" viewBox="0 0 200 16" aria-hidden="true" {
                path d="M20 0V16M180 0V16" stroke="var(--grey)" {}
                path d={ "M" (left) " 8H" (right) } stroke="var(--c0)" stroke-width="3" {}
                circle cx=(place(closure.estimate)) cy="8" r="5" fill="var(--c0)" {}
            }
        }
    }
}
