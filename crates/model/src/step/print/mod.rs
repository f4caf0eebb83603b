//! Programs in C.

mod c;
mod expression;

pub use c::c;

/// The heading of a written program.
#[derive(Debug, Clone, PartialEq)]
pub struct Heading {
    /// A word for the program: letters, digits and underscores.
    pub name: String,
    /// What it is, a sentence a line.
    pub says: Vec<String>,
    /// Label and unit of the input.
    pub input: String,
    /// Label and unit of the output.
    pub output: String,
    /// Seconds between samples.
    pub sample_time: f64,
    /// The inputs that the model was identified on.
    pub interval: [f64; 2],
}

/// Lines with a margin before each.
fn indented(lines: &[String], margin: usize) -> String {
    lines.iter().map(|line| format!("{:margin$}{line}\n", "")).collect()
}

/// Words in lines of at most a hundred letters.
fn wrapped(text: &str) -> Vec<String> {
    let mut lines = vec![String::new()];
    for word in text.split_whitespace() {
        let line = lines.last_mut().expect("there is a line");
        if line.len() + word.len() > 100 && !line.is_empty() {
            lines.push(word.to_owned());
        } else {
            line.push_str(if line.is_empty() { "" } else { " " });
            line.push_str(word);
        }
    }
    lines
}

/// Numbers as they are read back, so many a line.
fn numbers(values: &[f64], margin: usize) -> String {
    let rows = values.chunks(6).map(|row| {
        let row: Vec<String> = row.iter().map(|x| format!("{x:?}")).collect();
        format!("{:margin$}{}", "", row.join(", "))
    });
    rows.collect::<Vec<_>>().join(",\n")
}
