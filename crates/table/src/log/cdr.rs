//! Messages in the Common Data Representation, as ROS 2 serialises them.

use super::definition::{Definition, Element, Field, Number, Repeat};

/// Elements of a list that become columns: joints are few, pixels many.
const MOST: usize = 64;
/// Bytes before the data: how it is encoded.
const HEADER: usize = 4;
/// Messages within messages.
const DEEPEST: usize = 16;

/// A message being read.
struct Reader<'m> {
    definition: &'m Definition,
    data: &'m [u8],
    at: usize,
    is_little: bool,
    path: String,
    /// Numbers, texts and messages that may still come. Each has a byte of its own, but for messages that hold others, or nothing.
    left: usize,
}

/// Gives every number of a message with its path, as `position[2]`; none where the message ends before its definition does,
/// or holds more elements than it has bytes for.
pub(super) fn visit(definition: &Definition, data: &[u8], take: &mut dyn FnMut(&str, f64)) -> Option<()> {
    let is_little = data.get(1)? & 1 == 1;
    let data = data.get(HEADER..)?;
    let left = (DEEPEST + 1) * (data.len() + 1);
    let mut reader = Reader { definition, data, at: 0, is_little, path: String::new(), left };
    reader.message(&definition.fields, take, 0)
}

impl<'m> Reader<'m> {
    fn message(&mut self, fields: &'m [Field], take: &mut dyn FnMut(&str, f64), depth: usize) -> Option<()> {
        if depth > DEEPEST {
            return None;
        }
        for field in fields {
            let base = self.path.len();
            if base > 0 {
                self.path.push('.');
            }
            self.path.push_str(&field.name);
            self.field(field, take, depth)?;
            self.path.truncate(base);
        }
        Some(())
    }

    fn field(&mut self, field: &'m Field, take: &mut dyn FnMut(&str, f64), depth: usize) -> Option<()> {
        let count = match field.repeat {
            Repeat::Once => return self.element(&field.element, take, depth),
            Repeat::Times(count) => count,
            Repeat::Counted => self.number(Number::U32)? as usize,
        };
        // No list is longer than its bytes.
        if count > self.data.len() {
            return None;
        }
        let base = self.path.len();
        for k in 0..count {
            if k < MOST && count <= MOST {
                self.path.push_str(&format!("[{k}]"));
                self.element(&field.element, take, depth)?;
                self.path.truncate(base);
            } else {
                self.element(&field.element, &mut |_, _| {}, depth)?;
            }
        }
        Some(())
    }

    fn element(&mut self, element: &'m Element, take: &mut dyn FnMut(&str, f64), depth: usize) -> Option<()> {
        self.left = self.left.checked_sub(1)?;
        match element {
            Element::Number(number) => {
                let value = self.number(*number)?;
                take(&self.path, value);
            }
            Element::Text => {
                let length = self.number(Number::U32)? as usize;
                self.at = self.at.checked_add(length).filter(|end| *end <= self.data.len())?;
            }
            Element::Message(name) => {
                let definition = self.definition;
                self.message(definition.part(name), take, depth + 1)?;
            }
        }
        Some(())
    }

    fn bytes<const N: usize>(&mut self) -> Option<[u8; N]> {
        let start = self.at.next_multiple_of(N);
        let mut bytes: [u8; N] = self.data.get(start..start + N)?.try_into().ok()?;
        self.at = start + N;
        if !self.is_little {
            bytes.reverse();
        }
        Some(bytes)
    }

    fn number(&mut self, number: Number) -> Option<f64> {
        Some(match number {
            Number::U8 => f64::from(u8::from_le_bytes(self.bytes()?)),
            Number::I8 => f64::from(i8::from_le_bytes(self.bytes()?)),
            Number::U16 => f64::from(u16::from_le_bytes(self.bytes()?)),
            Number::I16 => f64::from(i16::from_le_bytes(self.bytes()?)),
            Number::U32 => f64::from(u32::from_le_bytes(self.bytes()?)),
            Number::I32 => f64::from(i32::from_le_bytes(self.bytes()?)),
            Number::U64 => u64::from_le_bytes(self.bytes()?) as f64,
            Number::I64 => i64::from_le_bytes(self.bytes()?) as f64,
            Number::F32 => f64::from(f32::from_le_bytes(self.bytes()?)),
            Number::F64 => f64::from_le_bytes(self.bytes()?),
        })
    }
}
