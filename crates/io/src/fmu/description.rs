//! What an FMU says of itself.

use super::error::FmuError;
use crate::export;
use roxmltree::{Document, Node};
use std::env::consts::DLL_SUFFIX;
use std::fs;
use std::path::{Path, PathBuf};

/// A real variable that can be played or read.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Port {
    pub(super) name: String,
    pub(super) reference: u32,
    /// Its unit; empty where it has none.
    pub(super) unit: String,
}

/// An unpacked FMU.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Description {
    pub(super) library: PathBuf,
    pub(super) guid: String,
    pub(super) inputs: Vec<Port>,
    pub(super) outputs: Vec<Port>,
    /// Samples by which the output is late, where it says so.
    pub(super) delay: usize,
}

impl Description {
    /// Reads `modelDescription.xml` in the folder of an FMU.
    pub(super) fn read(fmu: &Path, folder: &Path) -> Result<Self, FmuError> {
        let fail = |what: String, remedy: &str| FmuError::new(fmu, what, remedy);
        let other = "export it as an FMU 2.0 for co-simulation";
        let text = fs::read_to_string(folder.join("modelDescription.xml"))
            .map_err(|error| fail(format!("modelDescription.xml: {error}"), other))?;
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
    let there = fs::read_dir(binaries).into_iter().flatten().filter_map(Result::ok);
    let mut there: Vec<String> =
        there.map(|entry| entry.file_name().to_string_lossy().into_owned()).collect();
    there.sort();
    let has = if there.is_empty() { "none".to_owned() } else { there.join(", ") };
    Err(FmuError::new(
        fmu,
        format!(
            "it has no library for this platform, binaries/{platform}/{identifier}{DLL_SUFFIX}; it has: {has}"
        ),
        "export it on a machine like this one",
    ))
}
