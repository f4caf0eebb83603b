//! A word about what is missing of an examination.

use maud::{Markup, html};
use switchback_lab::examination::Partial;

pub(super) fn partial(partial: Option<Partial>) -> Markup {
    html! { @if let Some(partial) = partial { p class="bad" { strong { (partial) } } } }
}
