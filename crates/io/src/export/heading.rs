//! What an exported model says of itself.

use crate::diagnosis::digits;
use crate::identification::unit;
use crate::model::{Added, Header, ModelFile};
use switchback_model::step::Heading;

/// What the reader of an exported model is reported; `name` is what it is called there.
pub(super) fn heading(file: &ModelFile, name: &str) -> Heading {
    let Header { part, rig, input, output, sample_time, identified_on, .. } = &file.header;
    let version = env!("CARGO_PKG_VERSION");
    let mut says = vec![format!("The {part} model of {rig}, exported by Switchback {version}.")];
    says.extend(file.header.effects.iter().map(effect));
    says.push(identified(&file.header));
    says.push("A run begins at rest at its first input.".to_owned());
    says.extend(file.elsewhere().into_iter().map(|reported| sentence(&reported)));
    Heading {
        name: name.to_owned(),
        says,
        input: input.clone(),
        output: output.clone(),
        sample_time: *sample_time,
        interval: identified_on.interval,
    }
}

/// An effect with its parameters.
pub(super) fn effect(added: &Added) -> String {
    let parameters = added.parameters.iter().filter_map(|parameter| {
        let value = parameter.value?;
        let value = digits(value, 4);
        Some(format!("{} {value} {}", parameter.name, parameter.unit).trim_end().to_owned())
    });
    format!("It has the effect {}: {}.", added.effect, parameters.collect::<Vec<_>>().join(", "))
}

/// What the model was identified on.
fn identified(header: &Header) -> String {
    let on = &header.identified_on;
    let unit = unit(&header.input);
    let [low, high] = on.interval;
    format!(
        "It was identified on inputs from {low} to {high} {unit} that changed by at most {} {unit} a sample.",
        on.largest_step
    )
    .replace("  ", " ")
}

fn sentence(text: &str) -> String {
    let mut letters = text.chars();
    let first = letters.next().map(|c| c.to_uppercase().to_string()).unwrap_or_default();
    format!("{first}{}.", letters.as_str())
}

/// A word of letters, digits and underscores for a name in C: `leaf spring, 2` becomes `leaf_spring_2`.
pub(super) fn name_from(text: &str) -> String {
    let letter = |c: char| if c.is_ascii_alphanumeric() { c.to_ascii_lowercase() } else { '_' };
    let word: String = text.chars().map(letter).collect();
    let words: Vec<&str> = word.split('_').filter(|word| !word.is_empty()).collect();
    let joined = words.join("_");
    match joined.chars().next() {
        Some(first) if first.is_ascii_alphabetic() => joined,
        _ => format!("model_{joined}").trim_end_matches('_').to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_words_of_c() {
        for (text, name) in [
            ("leaf spring, 2", "leaf_spring_2"),
            ("Bench", "bench"),
            ("2 mm", "model_2_mm"),
            ("Düse", "d_se"),
            ("", "model"),
            ("___", "model"),
        ] {
            assert_eq!(name_from(text), name);
        }
    }
}
