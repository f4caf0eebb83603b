//! Values and conditions in C.

use super::c::InC;
use crate::step::program::{Condition, Operation, Value};

/// How tightly a value is bound: sums, products, everything else.
fn strength(value: &Value) -> u8 {
    match value {
        Value::Join(Operation::Add | Operation::Subtract, ..) => 1,
        Value::Join(Operation::Multiply | Operation::Divide, ..) => 2,
        Value::Number(x) if *x < 0.0 => 2,
        _ => 3,
    }
}

impl InC<'_> {
    pub(super) fn value(&self, it: &Value) -> String {
        let bound = |it: &Value, least: u8| match strength(it) >= least {
            true => self.value(it),
            false => format!("({})", self.value(it)),
        };
        match it {
            Value::Number(x) => format!("{x:?}"),
            Value::Whole(k) => k.to_string(),
            Value::Nothing => "NAN".to_owned(),
            Value::Of(variable) => self.variable(*variable),
            Value::At(array, index) => format!("{}[{}]", self.array(*array), self.value(index)),
            Value::Call(function, x) => format!("{}({})", self.function(*function), self.value(x)),
            Value::Dot(x, y) => self.dot(*x, *y),
            Value::Below(array, x) => self.below(*array, &self.value(x)),
            Value::Curve { knots, values, at } => self.curve(*knots, *values, &self.value(at)),
            Value::Join(operation, x, y) => match operation {
                Operation::Add => format!("{} + {}", bound(x, 1), bound(y, 2)),
                Operation::Subtract => format!("{} - {}", bound(x, 1), bound(y, 2)),
                Operation::Multiply if **x == Value::Number(-1.0) => format!("-{}", bound(y, 3)),
                Operation::Multiply => format!("{} * {}", bound(x, 2), bound(y, 3)),
                Operation::Divide => format!("{} / {}", bound(x, 2), bound(y, 3)),
                Operation::Power | Operation::Least | Operation::Greatest => {
                    format!("{}({}, {})", self.of_two(*operation), self.value(x), self.value(y))
                }
            },
        }
    }

    pub(super) fn condition(&self, it: &Condition) -> String {
        let compare =
            |x: &Value, sign: &str, y: &Value| format!("{} {sign} {}", self.value(x), self.value(y));
        match it {
            Condition::Less(x, y) => compare(x, "<", y),
            Condition::AtMost(x, y) => compare(x, "<=", y),
            Condition::Equal(x, y) => compare(x, "==", y),
            Condition::Differs(x, y) => compare(x, "!=", y),
            Condition::Both(x, y) => {
                format!("({}) && ({})", self.condition(x), self.condition(y))
            }
            Condition::Either(x, y) => {
                format!("({}) || ({})", self.condition(x), self.condition(y))
            }
        }
    }
}
