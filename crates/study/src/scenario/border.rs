//! `[[border]]`: a name, a kind, and the kind's own parameters.

use super::border_kind::{self, Shape};
use super::error::Fault;
use super::take::take;
use serde::Deserialize;
use std::ops::Range;
use switchback_io::input::closest;
use switchback_model::hysteresis::{BorderError, BorderPair, Interval, SwitchedHysteresis};
use toml::Spanned;
use toml::de::{DeTable, DeValue, ValueDeserializer};

/// One `[[border]]` of the file; its parameters are valid, but it knows no interval yet.
pub(super) struct WireBorder {
    pub(super) name: Spanned<String>,
    span: Range<usize>,
    shape: Shape,
}

/// Reads one `[[border]]`.
pub(super) fn read(value: Spanned<DeValue<'_>>) -> Result<WireBorder, Fault> {
    let span = value.span();
    let DeValue::Table(mut table) = value.into_inner() else {
        return Err(Fault::new(span, "a border must be a table", "write it as [[border]]"));
    };
    let name = text(&mut table, "name", &span)?;
    let kind = text(&mut table, "kind", &span)?;
    let places: Vec<(String, Range<usize>)> =
        table.iter().map(|(key, value)| (key.get_ref().to_string(), value.span())).collect();
    let parameters = ValueDeserializer::from(Spanned::new(span.clone(), DeValue::Table(table)));
    let read = border_kind::reader(kind.get_ref()).ok_or_else(|| unknown_kind(&kind))?;
    let shape = read(parameters)?.map_err(|error| refused(&error, &places, &span))?;
    Ok(WireBorder { name, span, shape })
}

impl WireBorder {
    /// The operator on an interval, where Assumption 1 holds.
    pub(super) fn on(&self, interval: Interval) -> Result<SwitchedHysteresis, Fault> {
        let pair: Box<dyn BorderPair> = (self.shape)();
        SwitchedHysteresis::new(interval, pair).map_err(|error| {
            let remedy =
                "raise the ascending border at h_M, lower the descending one at h_m, or change the interval";
            Fault::new(self.span.clone(), error.to_string(), remedy)
        })
    }
}

fn text(table: &mut DeTable<'_>, key: &str, border: &Range<usize>) -> Result<Spanned<String>, Fault> {
    let value = take(table, key).ok_or_else(|| {
        Fault::new(border.clone(), format!("this border has no `{key}`"), format!("add {key} = \"…\""))
    })?;
    Ok(Spanned::<String>::deserialize(ValueDeserializer::from(value))?)
}

fn unknown_kind(kind: &Spanned<String>) -> Fault {
    let names = border_kind::NAMES;
    let guess = closest(kind.get_ref(), names).map_or(String::new(), |k| format!("did you mean \"{k}\"? "));
    Fault::new(kind.span(), "no such kind of border", format!("{guess}valid: {}", names.join(", ")))
}

/// A parameter the border itself refuses; its message begins with the parameter's name, and ends with the remedy.
fn refused(error: &BorderError, places: &[(String, Range<usize>)], border: &Range<usize>) -> Fault {
    let message = error.to_string();
    let key = message.split([' ', '.', '[']).next().unwrap_or_default();
    let place = places.iter().find(|(name, _)| name == key);
    let span = place.map_or_else(|| border.clone(), |(_, span)| span.clone());
    Fault::new(span, message, "change this parameter; the kind's page in the documentation states its range")
}
