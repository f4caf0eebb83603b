//! The model that a diagnosis is given: a model file, or the output of `switchback identify --json`.

use crate::input::json_file::{self, JsonError};
use crate::model::{self, ModelError, ModelFile};
use serde::Deserialize;
use std::path::Path;
use switchback_identify::{BorderPoint, Estimate};
use switchback_model::linear::is_stable;

/// What a file holds.
#[derive(Debug)]
pub(super) enum Given {
    /// A model file.
    File(Box<ModelFile>),
    /// The page that `identify --json` prints.
    Page(Estimate),
}

/// The model of a text: a file with a `schema`, else a page of `identify --json`. `path` is what messages call it.
///
/// # Errors
/// [`ModelError`] if the text is neither.
pub(super) fn parse(path: &Path, text: &str) -> Result<Given, ModelError> {
    #[derive(Deserialize)]
    struct Peek {
        #[serde(default)]
        kind: Option<serde::de::IgnoredAny>,
        #[serde(default)]
        schema: Option<serde::de::IgnoredAny>,
    }
    let peek: Option<Peek> = serde_json::from_str(text).ok();
    // Pages of commands carry a schema, too, but no kind.
    match peek.is_some_and(|peek| peek.schema.is_some() && peek.kind.is_some()) {
        true => Ok(Given::File(Box::new(model::of_text(path, text)?))),
        false => page(path, text).map(Given::Page),
    }
}

/// How to get a file that is one.
const MAKE_ONE: &str = "make one with `switchback identify RIG.toml --json > MODEL.json`";

/// What of an identification makes the model. Standard errors, fits and warnings say nothing about it and may be missing.
#[derive(Debug, Deserialize)]
struct WireModel {
    order: usize,
    #[serde(default)]
    delay: isize,
    a: Vec<f64>,
    b: Vec<f64>,
    gain: f64,
    descendant: Vec<WirePoint>,
    ascendant: Vec<WirePoint>,
}

#[derive(Debug, Deserialize)]
struct WirePoint {
    v: f64,
    f: f64,
}

/// Reads a page: order, `a`, `b`, `gain`, `delay` (0 where it is missing) and both borders.
///
/// # Errors
/// [`ModelError`] if the file is no JSON, lacks a field, or its numbers contradict each other.
fn page(path: &Path, text: &str) -> Result<Estimate, ModelError> {
    let other = json_file::kind(text).filter(|kind| *kind != "an identification");
    if let Some(kind) = other {
        return Err(ModelError::Content {
            place: path.display().to_string(),
            message: format!("this is {kind}, but a model is wanted"),
            remedy: MAKE_ONE.to_owned(),
        });
    }
    let wire: WireModel = json_file::parse(path, text).map_err(refused)?;
    check(&wire).map_err(|(message, remedy)| ModelError::Content {
        place: path.display().to_string(),
        message,
        remedy: remedy.to_owned(),
    })?;
    Ok(estimate(wire))
}

fn refused(error: JsonError) -> ModelError {
    let JsonError { place, message, is_json } = error;
    let fields = "a model has order, a, b, gain, descendant and ascendant; ";
    let remedy = format!("{}{MAKE_ONE}", if is_json { fields } else { "" });
    ModelError::Content { place, message, remedy }
}

fn check(wire: &WireModel) -> Result<(), (String, &'static str)> {
    let n = wire.order;
    let as_identified = "give the fields as `switchback identify --json` wrote them, all from one run";
    if n == 0 {
        return Err(("`order` is 0: a model needs a pole at least".to_owned(), MAKE_ONE));
    }
    if wire.a.len() != n {
        return Err((format!("`a` has {} numbers, but `order` is {n}", wire.a.len()), as_identified));
    }
    // A direct term, or a look ahead, comes on top of b₁…bₙ.
    let expected = n + wire.delay.min(0).unsigned_abs();
    if wire.b.len() != expected {
        let message = format!(
            "`b` has {} numbers, but order {n} and delay {} make {expected}",
            wire.b.len(),
            wire.delay
        );
        return Err((message, as_identified));
    }
    for (name, border) in [("descendant", &wire.descendant), ("ascendant", &wire.ascendant)] {
        if border.len() < 2 {
            let remedy = "identify with both experiments, or with `--method free`, which sees both borders";
            return Err((format!("`{name}` has {} points, but a border needs two", border.len()), remedy));
        }
        if let Some(k) = border.windows(2).position(|pair| pair[1].v < pair[0].v) {
            let message =
                format!("`{name}`: the point at v = {} comes after {}", border[k + 1].v, border[k].v);
            return Err((message, "list the points of a border by increasing v"));
        }
    }
    if !is_stable(&wire.a) {
        return Err((
            "`a` is unstable, so the model cannot be simulated".to_owned(),
            "identify again from longer records, or with another order or method",
        ));
    }
    let dc = wire.b.iter().sum::<f64>() / (1.0 + wire.a.iter().sum::<f64>());
    if (dc - wire.gain).abs() > 1e-6 * wire.gain.abs().max(1e-300) {
        let message = format!("B(1)/A(1) is {dc}, but `gain` is {}", wire.gain);
        return Err((message, as_identified));
    }
    Ok(())
}

fn estimate(wire: WireModel) -> Estimate {
    let points = |border: Vec<WirePoint>| -> Vec<BorderPoint> {
        border.into_iter().map(|p| BorderPoint { v: p.v, f: p.f, se: f64::NAN }).collect()
    };
    let (descending, ascending) = (points(wire.descendant), points(wire.ascendant));
    Estimate {
        a_se: vec![f64::NAN; wire.a.len()],
        b_se: vec![f64::NAN; wire.b.len()],
        y_high: wire.gain * ascending[ascending.len() - 1].f,
        y_low: wire.gain * descending[0].f,
        a: wire.a,
        b: wire.b,
        delay: wire.delay,
        noise_sd: f64::NAN,
        gain: wire.gain,
        descending,
        ascending,
        excitation: f64::NAN,
        samples: 0,
    }
}
