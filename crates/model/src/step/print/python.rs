//! Python: one file that needs NumPy and nothing else.

use super::expression::{Words, condition, value};
use super::{Heading, indented, numbers, wrapped};
use crate::step::program::{
    Array, Function, Lives, Operation, Procedure, ProcedureCard, Program, Statement, Variable,
};
use std::fmt::Write;

/// The program as a Python module: `simulate(v)` over an array, and a class `Model` with `start(v)` and `step(v)`.
pub fn python(program: &Program, heading: &Heading) -> String {
    let words = InPython { program };
    let mut text = introduction(heading);
    text += "import math\nfrom bisect import bisect_left\n\nimport numpy as np\n\n";
    let _ = writeln!(text, "INPUT = {}\nOUTPUT = {}", quoted(&heading.input), quoted(&heading.output));
    let _ = writeln!(text, "SAMPLE_TIME = {:?}  # s", heading.sample_time);
    let [low, high] = heading.interval;
    let _ = writeln!(text, "WORKING_INTERVAL = ({low:?}, {high:?})  # of the input\n");
    for array in &program.arrays {
        if let Some(constants) = &array.constants {
            let _ = writeln!(text, "# {}", array.says);
            let _ = writeln!(text, "{} = [\n{},\n]", array.name.to_uppercase(), numbers(constants, 4));
        }
    }
    text += HELPERS;
    text += "\n\nclass Model:\n    \"\"\"The model with its state: `step(v)` gives the output after one more sample of the input.\"\"\"\n";
    text += "\n    def __init__(self, v=0.0, border=0):\n";
    for card in program.variables.iter().filter(|card| card.lives == Lives::State) {
        let _ = writeln!(text, "        self.{} = 0.0  # {}", card.name, card.says);
    }
    for card in program.arrays.iter().filter(|card| card.constants.is_none()) {
        let _ = writeln!(text, "        self.{} = [0.0] * {}  # {}", card.name, card.length, card.says);
    }
    text += "        self.start(v, border)\n";
    for (place, card) in program.procedures.iter().enumerate() {
        text += &words.procedure(Procedure(place), card);
    }
    text + &simulate(program)
}

fn introduction(heading: &Heading) -> String {
    let mut says = heading.says.clone();
    says.push(format!(
        "Input: {}. Output: {}. Sample time: {:?} s.",
        heading.input, heading.output, heading.sample_time
    ));
    let lines: Vec<String> = says.iter().flat_map(|line| wrapped(line)).map(|line| tame(&line)).collect();
    format!("\"\"\"{}\"\"\"\n\n", lines.join("\n"))
}

/// Nothing that ends a string of three quotes.
fn tame(text: &str) -> String {
    let text: String = text.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
    text.replace('\\', "\\\\").replace('"', "'")
}

fn quoted(text: &str) -> String {
    let letter = |c: char| match c {
        '"' | '\\' => format!("\\{c}"),
        c if c.is_control() => format!("\\u{:04x}", u32::from(c)),
        c => c.to_string(),
    };
    format!("\"{}\"", text.chars().map(letter).collect::<String>())
}

const HELPERS: &str = "

def _curve(knots, values, x):
    # The curve through points, straight between them and constant beyond.
    right = bisect_left(knots, x)
    if right == 0:
        return values[0]
    if right == len(knots):
        return values[-1]
    w = (x - knots[right - 1]) / (knots[right] - knots[right - 1])
    return (1.0 - w) * values[right - 1] + w * values[right]


def _dot(x, y):
    return sum(x * y for x, y in zip(x, y))


def _push(line, x):
    line.pop()
    line.insert(0, x)


def _round(x):
    # To the nearest whole number, halves away from zero.
    whole = math.trunc(x)
    if abs(x - whole) >= 0.5:
        whole += 1 if x > 0 else -1
    return float(whole)


def _exp(x):
    try:
        return math.exp(x)
    except OverflowError:
        return math.inf


def _power(x, y):
    try:
        return x**y
    except OverflowError:
        return math.inf
";

/// The run over an array.
fn simulate(program: &Program) -> String {
    let again = match program.told {
        Some(told) => format!(
            "    if border == 0 and model.{told} < 0.0:\n        # The first move was a fall: it had begun on the descending border.\n        return simulate(v, -1)\n",
            told = program.variables[told.0].name
        ),
        None => String::new(),
    };
    format!(
        "\n\ndef simulate(v, border=0):
    \"\"\"The outputs for an array of inputs, a sample each, from rest at the first one.

    `border` is 1 or -1 where the run begins on the ascending or on the descending border, 0 where the model knows.
    \"\"\"
    v = np.asarray(v, dtype=float)
    if v.ndim != 1:
        raise ValueError(f\"the input must have one dimension, not {{v.ndim}}\")
    if not np.isfinite(v).all():
        raise ValueError(f\"the input is not finite at sample {{int(np.argmin(np.isfinite(v)))}}\")
    if v.size == 0:
        return v
    model = Model(float(v[0]), border)
    y = np.array([model.step(x) for x in v.tolist()])
{again}    return y
"
    )
}

struct InPython<'a> {
    program: &'a Program,
}

impl InPython<'_> {
    fn procedure(&self, place: Procedure, card: &ProcedureCard) -> String {
        let (start, step) = (self.program.start(), self.program.step());
        let mut parameters: Vec<String> = card.parameters.iter().map(|v| self.variable(*v)).collect();
        if place == start {
            parameters[1] += "=0";
        }
        let visible = if place == start || place == step { "" } else { "_" };
        let mut text = format!("\n    def {visible}{}(self, {}):\n", card.name, parameters.join(", "));
        let _ = writeln!(text, "        \"\"\"{}\"\"\"", card.says);
        let mut lines = Vec::new();
        self.body(&card.body, 0, &mut lines);
        text += &indented(&lines, 8);
        if place == step {
            text += &format!("        return {}\n", self.variable(self.program.output));
        }
        text
    }

    fn body(&self, body: &[Statement], depth: usize, lines: &mut Vec<String>) {
        let margin = " ".repeat(4 * depth);
        for statement in body {
            let line = match statement {
                Statement::Note(text) => format!("# {text}"),
                Statement::Set(variable, x) => format!("{} = {}", self.variable(*variable), value(self, x)),
                Statement::Put(array, index, x) => {
                    format!("{}[{}] = {}", self.array(*array), value(self, index), value(self, x))
                }
                Statement::Fill(array, x) => {
                    let name = self.array(*array);
                    format!("{name} = [{}] * len({name})", value(self, x))
                }
                Statement::Push(array, x) => format!("_push({}, {})", self.array(*array), value(self, x)),
                Statement::Copy(to, from) => format!("{} = {}[:]", self.array(*to), self.array(*from)),
                Statement::Leave => "break".to_owned(),
                Statement::Run(procedure, parameters) => {
                    let name = &self.program.procedures[procedure.0].name;
                    let given: Vec<String> = parameters.iter().map(|x| value(self, x)).collect();
                    format!("self._{name}({})", given.join(", "))
                }
                Statement::If(when, then, otherwise) => {
                    lines.push(format!("{margin}if {}:", condition(self, when)));
                    self.body_or_pass(then, depth + 1, lines);
                    if !otherwise.is_empty() {
                        lines.push(format!("{margin}else:"));
                        self.body_or_pass(otherwise, depth + 1, lines);
                    }
                    continue;
                }
                Statement::Repeat(index, count, body) => {
                    lines.push(format!("{margin}for {} in range({count}):", self.variable(*index)));
                    self.body_or_pass(body, depth + 1, lines);
                    continue;
                }
            };
            lines.push(margin.clone() + &line);
        }
    }

    fn body_or_pass(&self, body: &[Statement], depth: usize, lines: &mut Vec<String>) {
        match body {
            [] => lines.push(" ".repeat(4 * depth) + "pass"),
            body => self.body(body, depth, lines),
        }
    }
}

impl Words for InPython<'_> {
    fn variable(&self, variable: Variable) -> String {
        let card = &self.program.variables[variable.0];
        match card.lives {
            Lives::State => format!("self.{}", card.name),
            Lives::Local | Lives::Index => card.name.clone(),
        }
    }

    fn array(&self, array: Array) -> String {
        let card = &self.program.arrays[array.0];
        match card.constants {
            None => format!("self.{}", card.name),
            Some(_) => card.name.to_uppercase(),
        }
    }

    fn function(&self, function: Function) -> String {
        let name = match function {
            Function::Abs => "abs",
            Function::Exp => "_exp",
            Function::ExpM1 => "math.expm1",
            Function::Log1P => "math.log1p",
            Function::Erfc => "math.erfc",
            Function::Round => "_round",
        };
        name.to_owned()
    }

    fn of_two(&self, operation: Operation) -> String {
        let name = match operation {
            Operation::Least => "min",
            Operation::Greatest => "max",
            _ => "_power",
        };
        name.to_owned()
    }

    fn nothing(&self) -> &'static str {
        "math.nan"
    }

    fn dot(&self, x: Array, y: Array) -> String {
        format!("_dot({}, {})", self.array(x), self.array(y))
    }

    fn below(&self, array: Array, x: &str) -> String {
        format!("bisect_left({}, {x})", self.array(array))
    }

    fn curve(&self, knots: Array, values: Array, at: &str) -> String {
        format!("_curve({}, {}, {at})", self.array(knots), self.array(values))
    }

    fn both(&self) -> &'static str {
        "and"
    }

    fn either(&self) -> &'static str {
        "or"
    }
}
