//! What an FMU says of itself.

use crate::error::FmuError;
use roxmltree::{Document, Node};
use std::env::consts::DLL_SUFFIX;
use std::path::{Path, PathBuf};
use switchback_io::export;
use switchback_io::input::{TextKind, names, read_text};

/// A real variable that can be played or read.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Port {
    pub(crate) name: String,
    pub(crate) reference: u32,
    /// Its unit; empty where it has none.
    pub(crate) unit: String,
}

/// An unpacked FMU.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Description {
    pub(crate) library: PathBuf,
    pub(crate) guid: String,
    pub(crate) inputs: Vec<Port>,
    pub(crate) outputs: Vec<Port>,
    /// Samples by which the output is late, where it says so.
    pub(crate) delay: usize,
}

impl Description {
    /// Reads `modelDescription.xml` in the folder of an FMU.
    pub(crate) fn read(fmu: &Path, folder: &Path) -> Result<Self, FmuError> {
        let fail = |what: String, remedy: &str| FmuError::new(fmu, what, remedy);
        let other = "export it as an FMU 2.0 for co-simulation";
        let text = read_text(&folder.join("modelDescription.xml"), TextKind::Model)
            .map_err(|error| fail(error.to_string(), other))?;
        let document =
            Document::parse(&text).map_err(|error| fail(format!("modelDescription.xml: {error}"), other))?;
        let root = document.root_element();
        let version = root.attribute("fmiVersion").unwrap_or("none");
        if version != "2.0" {
            return Err(fail(format!("it is an FMU of FMI {version}, but 2.0 is wanted"), other));
        }
        let Some(kind) = child(root, "CoSimulation") else {
            return Err(fail("it is not for co-simulation".to_owned(), other));
        };
        let identifier = kind.attribute("modelIdentifier").unwrap_or_default();
        let ports = |causality: &str| -> Vec<Port> {
            let variables = child(root, "ModelVariables").into_iter().flat_map(|all| all.children());
            variables.filter(|one| one.attribute("causality") == Some(causality)).filter_map(port).collect()
        };
        Ok(Self {
            library: library(fmu, folder, identifier)?,
            guid: root.attribute("guid").unwrap_or_default().to_owned(),
            inputs: ports("input"),
            outputs: ports("output"),
            delay: delay(root),
        })
    }
}

fn child<'a, 'input>(node: Node<'a, 'input>, name: &str) -> Option<Node<'a, 'input>> {
    node.children().find(|child| child.has_tag_name(name))
}

fn port(variable: Node<'_, '_>) -> Option<Port> {
    let real = child(variable, "Real")?;
    Some(Port {
        name: variable.attribute("name")?.to_owned(),
        reference: variable.attribute("valueReference")?.parse().ok()?,
        unit: real.attribute("unit").unwrap_or_default().to_owned(),
    })
}

/// The constant `output_delay` of an FMU that this program exported.
fn delay(root: Node<'_, '_>) -> usize {
    let is_own = root.attribute("generationTool").is_some_and(|tool| tool.starts_with("Switchback"));
    let variables = child(root, "ModelVariables").into_iter().flat_map(|all| all.children());
    let reported = variables.filter(|one| is_own && one.attribute("name") == Some("output_delay"));
    let start = |one: Node<'_, '_>| child(one, "Integer")?.attribute("start")?.parse().ok();
    reported.filter_map(start).next().unwrap_or(0)
}

/// The library for this platform.
fn library(fmu: &Path, folder: &Path, identifier: &str) -> Result<PathBuf, FmuError> {
    let platform = export::platform();
    let binaries = folder.join("binaries");
    let library = binaries.join(&platform).join(format!("{identifier}{DLL_SUFFIX}"));
    if !identifier.is_empty() && !identifier.contains(['/', '\\']) && library.is_file() {
        return Ok(library);
    }
    let there = names(&binaries).unwrap_or_default();
    let has = if there.is_empty() { "none".to_owned() } else { there.join(", ") };
    Err(FmuError::new(
        fmu,
        format!(
            "it has no library for this platform, binaries/{platform}/{identifier}{DLL_SUFFIX}; it has: {has}"
        ),
        "export it on a machine like this one",
    ))
}
