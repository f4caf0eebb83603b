//! `--map v=…,y=…`

use crate::description::{Description, Port};
use crate::error::FmuError;
use serde::{Deserialize, Serialize};
use std::path::Path;
use switchback_io::identification::unit;
use switchback_io::input::closest;
use switchback_io::model::same_unit;

/// Which variables of an FMU are the input and the output.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Map {
    v: Option<String>,
    y: Option<String>,
    /// Samples by which the output is late.
    delay: Option<usize>,
}

/// Parses which variables are meant.
///
/// ```
/// assert!(switchback_host::map("v=position,y=force").is_ok());
/// assert!(switchback_host::map("y=force,delay=1").is_ok());
/// assert!(switchback_host::map("x=position").is_err());
/// ```
///
/// # Errors
/// What to give instead.
pub fn map(text: &str) -> Result<Map, String> {
    let help = || {
        "give the variables' names, e.g. v=position,y=force, and delay=1 where the output is a sample late"
            .to_owned()
    };
    let mut map = Map::default();
    for part in text.split(',') {
        let (key, name) = part.split_once('=').ok_or_else(help)?;
        let name = name.trim();
        let slot = match key.trim() {
            "v" => &mut map.v,
            "y" => &mut map.y,
            "delay" if map.delay.is_none() => {
                map.delay = Some(name.parse().ok().filter(|delay| *delay <= 1000).ok_or_else(help)?);
                continue;
            }
            _ => return Err(help()),
        };
        if slot.is_some() || name.is_empty() {
            return Err(help());
        }
        *slot = Some(name.to_owned());
    }
    Ok(map)
}

/// The variables that are played and read.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Ports {
    pub(crate) input: Port,
    pub(crate) output: Port,
    pub(crate) delay: usize,
}

impl Map {
    /// Finds them in an FMU; where none was named, the only ones, or `v` and `y`.
    pub(crate) fn find(&self, fmu: &Path, description: &Description) -> Result<Ports, FmuError> {
        let input = find(fmu, ("v", "input", &self.v), &description.inputs)?;
        let output = find(fmu, ("y", "output", &self.y), &description.outputs)?;
        Ok(Ports { input, output, delay: self.delay.unwrap_or(description.delay) })
    }
}

fn find(
    fmu: &Path,
    (key, what, named): (&str, &str, &Option<String>),
    there: &[Port],
) -> Result<Port, FmuError> {
    let by_name = |name: &str| there.iter().find(|port| port.name == name).cloned();
    let names: Vec<&str> = there.iter().map(|port| port.name.as_str()).collect();
    let has = match names.is_empty() {
        true => format!("it has no real {what}"),
        false => format!("its {what}s are {}", names.join(", ")),
    };
    match (named, there) {
        (Some(name), _) => by_name(name).ok_or_else(|| {
            let remedy = match closest(name, names.iter().copied()) {
                Some(near) => format!("did you mean `--map {key}={near}`?"),
                None => format!("name a variable that it has: `--map {key}=NAME`"),
            };
            FmuError::new(fmu, format!("there is no real {what} `{name}`; {has}"), remedy)
        }),
        (None, [only]) => Ok(only.clone()),
        (None, _) => by_name(key).ok_or_else(|| {
            let remedy = format!("name it: `--map {key}=NAME`");
            FmuError::new(fmu, format!("which {what} is `{key}` is ambiguous: {has}"), remedy)
        }),
    }
}

impl Ports {
    /// Compares units with those of the records where both are known.
    pub(crate) fn check_units(&self, fmu: &Path, labels: &[String; 2]) -> Result<(), FmuError> {
        for (port, label) in [&self.input, &self.output].into_iter().zip(labels) {
            let (own, other) = (port.unit.as_str(), unit(label));
            if !own.is_empty() && !other.is_empty() && !same_unit(own, other) {
                return Err(FmuError::new(
                    fmu,
                    format!("its `{}` is in {own}, but the records have {other}", port.name),
                    format!("bring `{label}` to {own}, or correct the header if only that is wrong"),
                ));
            }
        }
        Ok(())
    }
}
