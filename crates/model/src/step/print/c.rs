//! C99: one header, no allocation, a fixed state.

use super::{Heading, indented, numbers, wrapped};
use crate::step::program::{
    Array, Function, Lives, Operation, Procedure, ProcedureCard, Program, Statement, Value, Variable,
};
use std::fmt::Write;

/// The program as a C99 header: `NAME_state`, `NAME_start(&state, v, border)` and `NAME_step(&state, v)`.
pub fn c(program: &Program, heading: &Heading) -> String {
    let words = InC { program, prefix: &heading.name };
    let name = &heading.name;
    let guard = format!("{}_H", name.to_uppercase());
    let mut text = comment(&introduction(heading));
    let _ = writeln!(text, "#ifndef {guard}\n#define {guard}\n\n#include <math.h>\n");
    let define = |key: &str, what: String| format!("#define {name}_{key} {what}\n");
    text += &define("INPUT", quoted(&heading.input));
    text += &define("OUTPUT", quoted(&heading.output));
    text += &define("SAMPLE_TIME", format!("{:?} /* s */", heading.sample_time));
    text += &define("LOWEST_INPUT", format!("({:?})", heading.interval[0]));
    text += &define("HIGHEST_INPUT", format!("({:?})", heading.interval[1]));
    text.push('\n');
    for array in &program.arrays {
        if let Some(constants) = &array.constants {
            let _ = writeln!(text, "/* {} */", tame(&array.says));
            let _ = writeln!(text, "static const double {name}_{}[{}] = {{", array.name, array.length);
            let _ = writeln!(text, "{}\n}};\n", numbers(constants, 4));
        }
    }
    text += &state(program, name);
    text += &helpers(name);
    for (place, card) in program.procedures.iter().enumerate() {
        text += &words.procedure(Procedure(place), card);
    }
    let _ = writeln!(text, "#endif");
    text
}

fn introduction(heading: &Heading) -> Vec<String> {
    let name = &heading.name;
    let mut says = heading.says.clone();
    says.extend([
        String::new(),
        "Use:".to_owned(),
        format!("    {name}_state s;"),
        format!("    {name}_start(&s, v, 0); /* once, at the first input; 1 or -1 to begin on the ascending or descending border */"),
        format!("    y = {name}_step(&s, v); /* once a sample, the first one included */"),
        String::new(),
        format!(
            "Input: {}. Output: {}. Sample time: {:?} s.",
            heading.input, heading.output, heading.sample_time
        ),
        "C99. It allocates nothing; its state is the structure. An input that is not finite counts as the one before.".to_owned(),
    ]);
    says
}

fn comment(lines: &[String]) -> String {
    let lines: Vec<String> = lines
        .iter()
        .flat_map(|line| if line.starts_with(' ') { vec![line.clone()] } else { wrapped(line) })
        .map(|line| {
            format!(" * {}", tame(&line).replace("/ *", "//").replace("* /", "")).trim_end().to_owned()
        })
        .collect();
    format!("/*\n{}\n */\n", lines.join("\n"))
}

/// Nothing that ends or begins a comment, nor a control character.
fn tame(text: &str) -> String {
    let text: String = text.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
    text.replace("*/", "* /").replace("/*", "/ *").replace("??", "? ?")
}

/// A string; what is not plain is written by its bytes, with three digits each so that none can follow.
fn quoted(text: &str) -> String {
    let bytes = text.bytes().map(|byte| match byte {
        b'"' | b'\\' | b'?' => format!("\\{}", char::from(byte)),
        b' '..=b'~' => char::from(byte).to_string(),
        _ => format!("\\{byte:03o}"),
    });
    format!("\"{}\"", bytes.collect::<String>())
}

fn state(program: &Program, name: &str) -> String {
    let mut text = "/* All that is kept from sample to sample. */\ntypedef struct {\n".to_owned();
    for card in program.variables.iter().filter(|card| card.lives == Lives::State) {
        let _ = writeln!(text, "    double {}; /* {} */", card.name, tame(&card.says));
    }
    for card in program.arrays.iter().filter(|card| card.constants.is_none()) {
        let _ = writeln!(text, "    double {}[{}]; /* {} */", card.name, card.length, tame(&card.says));
    }
    let _ = writeln!(text, "}} {name}_state;\n");
    text
}

fn helpers(name: &str) -> String {
    format!(
        "\
static inline double {name}_least(double x, double y) {{
    return y < x ? y : x;
}}

static inline double {name}_greatest(double x, double y) {{
    return x < y ? y : x;
}}

/* Elements of an increasing array that are smaller than x. */
static inline int {name}_below(const double *knots, int count, double x) {{
    int low = 0, high = count;
    while (low < high) {{
        const int middle = low + (high - low) / 2;
        if (knots[middle] < x) {{
            low = middle + 1;
        }} else {{
            high = middle;
        }}
    }}
    return low;
}}

/* The curve through points, straight between them and constant beyond. */
static inline double {name}_curve(const double *knots, const double *values, int count, double x) {{
    const int right = {name}_below(knots, count, x);
    double w;
    if (right == 0) {{
        return values[0];
    }}
    if (right == count) {{
        return values[count - 1];
    }}
    w = (x - knots[right - 1]) / (knots[right] - knots[right - 1]);
    return (1.0 - w) * values[right - 1] + w * values[right];
}}

static inline double {name}_dot(const double *x, const double *y, int count) {{
    double sum = 0.0;
    int i;
    for (i = 0; i < count; ++i) {{
        sum += x[i] * y[i];
    }}
    return sum;
}}

/* Puts x in front of a line, whose last element is lost. */
static inline void {name}_push(double *line, int count, double x) {{
    int i;
    for (i = count - 1; i > 0; --i) {{
        line[i] = line[i - 1];
    }}
    line[0] = x;
}}

static inline void {name}_fill(double *line, int count, double x) {{
    int i;
    for (i = 0; i < count; ++i) {{
        line[i] = x;
    }}
}}

static inline void {name}_copy(double *to, const double *from, int count) {{
    int i;
    for (i = 0; i < count; ++i) {{
        to[i] = from[i];
    }}
}}

"
    )
}

/// What the parts of a program are called.
pub(super) struct InC<'a> {
    program: &'a Program,
    prefix: &'a str,
}

impl InC<'_> {
    fn length(&self, array: Array) -> usize {
        self.program.arrays[array.0].length
    }

    fn procedure(&self, place: Procedure, card: &ProcedureCard) -> String {
        let prefix = self.prefix;
        let (start, step) = (self.program.start(), self.program.step());
        let parameters: Vec<String> = card
            .parameters
            .iter()
            .enumerate()
            .map(|(k, variable)| {
                let kind = if place == start && k == 1 { "int" } else { "double" };
                format!("{kind} {}", self.variable(*variable))
            })
            .collect();
        let gives = if place == step { "double" } else { "void" };
        let mut text = format!("/* {} */\n", tame(&card.says));
        let _ = writeln!(
            text,
            "static inline {gives} {prefix}_{}({prefix}_state *s, {}) {{",
            card.name,
            parameters.join(", ")
        );
        let used = Used::of(&card.body);
        for variable in used.variables.iter().filter(|variable| !card.parameters.contains(variable)) {
            let name = self.variable(*variable);
            match self.program.variables[variable.0].lives {
                Lives::State => {}
                Lives::Local => text += &format!("    double {name} = 0.0;\n"),
                Lives::Index => text += &format!("    int {name} = 0;\n"),
            }
        }
        for variable in card.parameters.iter().filter(|variable| !used.variables.contains(variable)) {
            text += &format!("    (void){};\n", self.variable(*variable));
        }
        let mut lines = Vec::new();
        self.body(&card.body, 0, &mut lines);
        text += &indented(&lines, 4);
        if place == step {
            text += &format!("    return {};\n", self.variable(self.program.output));
        }
        text + "}\n\n"
    }

    fn body(&self, body: &[Statement], depth: usize, lines: &mut Vec<String>) {
        let margin = " ".repeat(4 * depth);
        let prefix = self.prefix;
        for statement in body {
            let line = match statement {
                Statement::Note(text) => format!("/* {} */", tame(text)),
                Statement::Set(variable, x) => format!("{} = {};", self.variable(*variable), self.value(x)),
                Statement::Put(array, index, x) => {
                    format!("{}[{}] = {};", self.array(*array), self.value(index), self.value(x))
                }
                Statement::Fill(array, x) => self.on("fill", *array, self.value(x)),
                Statement::Push(array, x) => self.on("push", *array, self.value(x)),
                Statement::Copy(to, from) => {
                    let (count, to, from) = (self.length(*to), self.array(*to), self.array(*from));
                    format!("{prefix}_copy({to}, {from}, {count});")
                }
                Statement::Leave => "break;".to_owned(),
                Statement::Run(procedure, parameters) => {
                    let name = &self.program.procedures[procedure.0].name;
                    let given: Vec<String> = parameters.iter().map(|x| self.value(x)).collect();
                    format!("{prefix}_{name}(s, {});", given.join(", "))
                }
                Statement::If(when, then, otherwise) => {
                    lines.push(format!("{margin}if ({}) {{", self.condition(when)));
                    self.body(then, depth + 1, lines);
                    if !otherwise.is_empty() {
                        lines.push(format!("{margin}}} else {{"));
                        self.body(otherwise, depth + 1, lines);
                    }
                    "}".to_owned()
                }
                Statement::Repeat(index, count, body) => {
                    let i = self.variable(*index);
                    lines.push(format!("{margin}for ({i} = 0; {i} < {count}; ++{i}) {{"));
                    self.body(body, depth + 1, lines);
                    "}".to_owned()
                }
            };
            lines.push(margin.clone() + &line);
        }
    }

    fn on(&self, what: &str, array: Array, x: String) -> String {
        format!("{}_{what}({}, {}, {x});", self.prefix, self.array(array), self.length(array))
    }

    pub(super) fn variable(&self, variable: Variable) -> String {
        let card = &self.program.variables[variable.0];
        match card.lives {
            Lives::State => format!("s->{}", card.name),
            Lives::Local | Lives::Index => card.name.clone(),
        }
    }

    pub(super) fn array(&self, array: Array) -> String {
        let card = &self.program.arrays[array.0];
        match card.constants {
            None => format!("s->{}", card.name),
            Some(_) => format!("{}_{}", self.prefix, card.name),
        }
    }

    pub(super) fn function(&self, function: Function) -> String {
        let name = match function {
            Function::Abs => "fabs",
            Function::Exp => "exp",
            Function::ExpM1 => "expm1",
            Function::Log1P => "log1p",
            Function::Erfc => "erfc",
            Function::Round => "round",
        };
        name.to_owned()
    }

    /// `x` to a power, the smaller or the greater of two.
    pub(super) fn of_two(&self, operation: Operation) -> String {
        match operation {
            Operation::Least => format!("{}_least", self.prefix),
            Operation::Greatest => format!("{}_greatest", self.prefix),
            _ => "pow".to_owned(),
        }
    }

    pub(super) fn dot(&self, x: Array, y: Array) -> String {
        let count = self.length(x).min(self.length(y));
        format!("{}_dot({}, {}, {count})", self.prefix, self.array(x), self.array(y))
    }

    pub(super) fn below(&self, array: Array, x: &str) -> String {
        format!("{}_below({}, {}, {x})", self.prefix, self.array(array), self.length(array))
    }

    pub(super) fn curve(&self, knots: Array, values: Array, at: &str) -> String {
        let count = self.length(knots);
        format!("{}_curve({}, {}, {count}, {at})", self.prefix, self.array(knots), self.array(values))
    }
}

/// The variables that a body mentions, in the order of their first mention.
#[derive(Default)]
struct Used {
    variables: Vec<Variable>,
}

impl Used {
    fn of(body: &[Statement]) -> Self {
        let mut used = Self::default();
        used.body(body);
        used
    }

    fn add(&mut self, variable: Variable) {
        if !self.variables.contains(&variable) {
            self.variables.push(variable);
        }
    }

    fn body(&mut self, body: &[Statement]) {
        for statement in body {
            match statement {
                Statement::Note(_) | Statement::Leave | Statement::Copy(..) => {}
                Statement::Set(variable, x) => {
                    self.add(*variable);
                    self.value(x);
                }
                Statement::Put(_, index, x) => {
                    self.value(index);
                    self.value(x);
                }
                Statement::Fill(_, x) | Statement::Push(_, x) => self.value(x),
                Statement::Run(_, parameters) => parameters.iter().for_each(|x| self.value(x)),
                Statement::If(when, then, otherwise) => {
                    self.condition(when);
                    self.body(then);
                    self.body(otherwise);
                }
                Statement::Repeat(index, _, body) => {
                    self.add(*index);
                    self.body(body);
                }
            }
        }
    }

    fn condition(&mut self, condition: &crate::step::program::Condition) {
        use crate::step::program::Condition::{AtMost, Both, Differs, Either, Equal, Less};
        match condition {
            Less(x, y) | AtMost(x, y) | Equal(x, y) | Differs(x, y) => {
                self.value(x);
                self.value(y);
            }
            Both(x, y) | Either(x, y) => {
                self.condition(x);
                self.condition(y);
            }
        }
    }

    fn value(&mut self, value: &Value) {
        match value {
            Value::Number(_) | Value::Whole(_) | Value::Nothing | Value::Dot(..) => {}
            Value::Of(variable) => self.add(*variable),
            Value::At(_, x) | Value::Below(_, x) | Value::Call(_, x) => self.value(x),
            Value::Curve { at, .. } => self.value(at),
            Value::Join(_, x, y) => {
                self.value(x);
                self.value(y);
            }
        }
    }
}
