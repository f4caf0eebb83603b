//! `modelDescription.xml`.

use crate::package::{Package, references};
use std::fmt::Write;

/// What the description says besides the package.
#[derive(Debug, Clone, PartialEq)]
pub struct Description {
    /// What the model is called, in any letters.
    pub title: String,
    /// The name of its library: a word of C.
    pub identifier: String,
    /// What it is, in sentences.
    pub says: String,
    /// Label and unit of the input; the unit may be empty.
    pub input: [String; 2],
    /// Label and unit of the output.
    pub output: [String; 2],
    /// The constants of the package, in its order.
    pub constants: Vec<Constant>,
}

/// A constant.
#[derive(Debug, Clone, PartialEq)]
pub struct Constant {
    /// A name with dots between its parts.
    pub name: String,
    /// Its unit, empty for a pure number.
    pub unit: String,
    /// What it is.
    pub says: String,
    /// The number.
    pub value: f64,
}

/// The description of a package as XML.
pub fn model_description(package: &Package, description: &Description) -> String {
    let Description { title, identifier, says, input, output, constants } = description;
    let x = escaped;
    let mut text = String::from("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n");
    let _ = writeln!(
        text,
        "<fmiModelDescription fmiVersion=\"2.0\" modelName=\"{}\" guid=\"{}\" description=\"{}\" \
         generationTool=\"Switchback {}\" variableNamingConvention=\"structured\">",
        x(title),
        x(&package.guid),
        x(says),
        x(&package.version)
    );
    let _ = writeln!(
        text,
        "  <CoSimulation modelIdentifier=\"{}\" canHandleVariableCommunicationStepSize=\"true\" \
         canGetAndSetFMUstate=\"true\"/>",
        x(identifier)
    );
    text += &units([&input[1], &output[1]].into_iter().chain(constants.iter().map(|c| &c.unit)));
    text += "  <LogCategories>\n    <Category name=\"logAll\"/>\n    <Category name=\"logStatusError\"/>\n  </LogCategories>\n";
    let _ = writeln!(
        text,
        "  <DefaultExperiment startTime=\"0\" stepSize=\"{:?}\"/>\n  <ModelVariables>",
        package.sample_time
    );
    let [low, high] = package.interval;
    let late = match package.output_delay() {
        0 => "at the end of the step",
        _ => "at the beginning of the step: it depends on the input of its own sample",
    };
    let mut variable = |head: String, kind: String| {
        let _ = writeln!(text, "    <ScalarVariable {head}>\n      {kind}\n    </ScalarVariable>");
    };
    let head = |name: &str, reference: u32, says: &str, rest: &str| {
        format!("name=\"{}\" valueReference=\"{reference}\" description=\"{}\" {rest}", x(name), x(says))
    };
    let unit = |unit: &str| if unit.is_empty() { String::new() } else { format!(" unit=\"{}\"", x(unit)) };
    let about = format!("{}: identified from {low:?} to {high:?}", input[0]);
    variable(
        head("v", references::V, &about, "causality=\"input\" variability=\"discrete\""),
        format!("<Real start=\"{:?}\"{}/>", package.start, unit(&input[1])),
    );
    let calculated = "causality=\"output\" variability=\"discrete\" initial=\"calculated\"";
    variable(
        head("y", references::Y, &format!("{}, {late}", output[0]), calculated),
        format!("<Real{}/>", unit(&output[1])),
    );
    let outside = "whether the input has left the working interval";
    variable(head("outside", references::OUTSIDE, outside, calculated), "<Boolean/>".to_owned());
    let border =
        "where a run begins: 1 on the ascending border, -1 on the descending one, 0 as the first move shows";
    variable(
        head(
            "border",
            references::BORDER,
            border,
            "causality=\"parameter\" variability=\"fixed\" initial=\"exact\"",
        ),
        "<Integer start=\"0\" min=\"-1\" max=\"1\"/>".to_owned(),
    );
    let constant = "causality=\"local\" variability=\"constant\" initial=\"exact\"";
    variable(
        head("output_delay", references::OUTPUT_DELAY, "samples by which y is late", constant),
        format!("<Integer start=\"{}\"/>", package.output_delay()),
    );
    for (reference, reported) in (references::CONSTANTS..).zip(constants) {
        variable(
            head(&reported.name, reference, &reported.says, constant),
            format!("<Real start=\"{:?}\"{}/>", reported.value, unit(&reported.unit)),
        );
    }
    text += "  </ModelVariables>\n  <ModelStructure>\n    <Outputs>\n";
    text += "      <Unknown index=\"2\" dependencies=\"\"/>\n      <Unknown index=\"3\" dependencies=\"\"/>\n    </Outputs>\n";
    text += "    <InitialUnknowns>\n      <Unknown index=\"2\" dependencies=\"1 4\"/>\n      <Unknown index=\"3\" dependencies=\"1\"/>\n    </InitialUnknowns>\n";
    text + "  </ModelStructure>\n</fmiModelDescription>\n"
}

fn units<'a>(all: impl Iterator<Item = &'a String>) -> String {
    let mut known: Vec<&String> = Vec::new();
    for unit in all.filter(|unit| !unit.is_empty()) {
        if !known.contains(&unit) {
            known.push(unit);
        }
    }
    if known.is_empty() {
        return String::new();
    }
    let rows: String = known.iter().map(|unit| format!("    <Unit name=\"{}\"/>\n", escaped(unit))).collect();
    format!("  <UnitDefinitions>\n{rows}  </UnitDefinitions>\n")
}

/// A text inside an attribute.
fn escaped(text: &str) -> String {
    let letter = |c: char| match c {
        '&' => "&amp;".to_owned(),
        '<' => "&lt;".to_owned(),
        '>' => "&gt;".to_owned(),
        '"' => "&quot;".to_owned(),
        '\'' => "&apos;".to_owned(),
        // Not even an escape of these is XML.
        c if c.is_control() || matches!(c, '\u{fffe}' | '\u{ffff}') => " ".to_owned(),
        c => c.to_string(),
    };
    text.chars().map(letter).collect()
}

#[cfg(test)]
mod tests {
    use super::escaped;

    #[test]
    fn letters_that_mean_something_to_xml_are_escaped() {
        assert_eq!(escaped("a<b> & \"c\" 'd'\n100 %"), "a&lt;b&gt; &amp; &quot;c&quot; &apos;d&apos; 100 %");
    }
}
