//! Values and conditions as C and Python write them: they differ in the names of things only.

use crate::step::program::{Array, Condition, Function, Operation, Value, Variable};

/// What a language calls things.
pub(super) trait Words {
    fn variable(&self, variable: Variable) -> String;
    fn array(&self, array: Array) -> String;
    fn function(&self, function: Function) -> String;
    /// `x` to a power, the smaller or the greater of two.
    fn of_two(&self, operation: Operation) -> String;
    fn nothing(&self) -> &'static str;
    fn dot(&self, x: Array, y: Array) -> String;
    fn below(&self, array: Array, x: &str) -> String;
    fn curve(&self, knots: Array, values: Array, at: &str) -> String;
    fn both(&self) -> &'static str;
    fn either(&self) -> &'static str;
}

/// How tightly a value is bound: sums, products, everything else.
fn strength(value: &Value) -> u8 {
    match value {
        Value::Join(Operation::Add | Operation::Subtract, ..) => 1,
        Value::Join(Operation::Multiply | Operation::Divide, ..) => 2,
        Value::Number(x) if *x < 0.0 => 2,
        _ => 3,
    }
}

pub(super) fn value(words: &impl Words, it: &Value) -> String {
    let bound = |it: &Value, least: u8| match strength(it) >= least {
        true => value(words, it),
        false => format!("({})", value(words, it)),
    };
    match it {
        Value::Number(x) => format!("{x:?}"),
        Value::Whole(k) => k.to_string(),
        Value::Nothing => words.nothing().to_owned(),
        Value::Of(variable) => words.variable(*variable),
        Value::At(array, index) => format!("{}[{}]", words.array(*array), value(words, index)),
        Value::Call(function, x) => format!("{}({})", words.function(*function), value(words, x)),
        Value::Dot(x, y) => words.dot(*x, *y),
        Value::Below(array, x) => words.below(*array, &value(words, x)),
        Value::Curve { knots, values, at } => words.curve(*knots, *values, &value(words, at)),
        Value::Join(operation, x, y) => match operation {
            Operation::Add => format!("{} + {}", bound(x, 1), bound(y, 2)),
            Operation::Subtract => format!("{} - {}", bound(x, 1), bound(y, 2)),
            Operation::Multiply if **x == Value::Number(-1.0) => format!("-{}", bound(y, 3)),
            Operation::Multiply => format!("{} * {}", bound(x, 2), bound(y, 3)),
            Operation::Divide => format!("{} / {}", bound(x, 2), bound(y, 3)),
            Operation::Power | Operation::Least | Operation::Greatest => {
                format!("{}({}, {})", words.of_two(*operation), value(words, x), value(words, y))
            }
        },
    }
}

pub(super) fn condition(words: &impl Words, it: &Condition) -> String {
    let compare =
        |x: &Value, sign: &str, y: &Value| format!("{} {sign} {}", value(words, x), value(words, y));
    match it {
        Condition::Less(x, y) => compare(x, "<", y),
        Condition::AtMost(x, y) => compare(x, "<=", y),
        Condition::Equal(x, y) => compare(x, "==", y),
        Condition::Differs(x, y) => compare(x, "!=", y),
        Condition::Both(x, y) => {
            format!("({}) {} ({})", condition(words, x), words.both(), condition(words, y))
        }
        Condition::Either(x, y) => {
            format!("({}) {} ({})", condition(words, x), words.either(), condition(words, y))
        }
    }
}
