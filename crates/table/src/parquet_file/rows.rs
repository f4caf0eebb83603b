//! Numbers, row by row.

use super::stated;
use crate::door::Opened;
use crate::table::{Column, Kind, Place, Table, empty_column};
use parquet::basic::{LogicalType, TimeUnit, Type as Physical};
use parquet::errors::ParquetError;
use parquet::file::reader::FileReader;
use parquet::file::serialized_reader::SerializedFileReader;
use parquet::record::{Field, Row};
use parquet::schema::types::{Type, TypePtr};
use std::collections::BTreeSet;
use std::fmt::Write;
use std::path::Path;

/// Most numbers of a list that are columns: more are pictures.
const MOST_OF_A_LIST: usize = 64;

/// Most numbers of a table, which is kept whole: 2 GiB.
const MOST: usize = 1 << 28;

const NANOSECONDS: i128 = 1_000_000_000;

/// The numbers of one column, so far.
#[derive(Default)]
struct Numbers {
    name: String,
    /// NaN where a row has none.
    values: Vec<f64>,
    /// Nanoseconds since 1970, where that is what it holds.
    instants: Vec<i128>,
}

/// What was read of a file.
#[derive(Default)]
pub(super) struct Rows {
    columns: Vec<Numbers>,
    count: usize,
    /// Why no more rows came, where that is not the end of the file.
    broken: Option<String>,
    /// Columns that count nanoseconds since 1970.
    nanoseconds: BTreeSet<String>,
}

/// Reads all rows.
///
/// # Errors
/// Where it is no such file, has no numbers, or is broken before its first row.
pub(super) fn collect(file: Opened) -> Result<Rows, String> {
    let worded = |error: ParquetError| worded(&error);
    stated::check_schema(&file)?;
    let pages = file.try_clone().map_err(|error| error.to_string())?;
    let reader = SerializedFileReader::new(file).map_err(worded)?;
    let schema = reader.metadata().file_metadata().schema();
    let numeric: Vec<TypePtr> =
        schema.get_fields().iter().filter(|field| has_number(field)).cloned().collect();
    if numeric.is_empty() {
        return Err("it holds no column of numbers".to_owned());
    }
    stated::check_pages(&pages, reader.metadata(), &numeric, MOST as u64)?;
    let is_count = |field: &&TypePtr| {
        let stamp = field.get_basic_info().logical_type_ref();
        matches!(stamp, Some(LogicalType::Timestamp(stamp)) if matches!(stamp.unit, TimeUnit::NANOS))
    };
    let nanoseconds = numeric.iter().filter(is_count).map(|field| field.name().to_owned()).collect();
    let mut rows = Rows { nanoseconds, ..Rows::default() };
    let wanted = Type::group_type_builder(schema.name()).with_fields(numeric).build().map_err(worded)?;
    for row in reader.get_row_iter(Some(wanted)).map_err(worded)? {
        match row {
            Ok(row) => rows.push(&row),
            Err(error) => {
                rows.broken = Some(worded(error));
                break;
            }
        }
        if rows.count * rows.columns.len() > MOST {
            return Err(format!("it holds more than {MOST} numbers"));
        }
    }
    match rows.broken {
        Some(reason) if rows.count == 0 => Err(reason),
        _ => Ok(rows),
    }
}

/// What is wrong, in words of one line.
fn worded(error: &ParquetError) -> String {
    let said = error.to_string().replace(['\n', '\r'], " ");
    let cut_off = ["Corrupt footer", "EOF", "Invalid Parquet file"].iter().any(|part| said.contains(part));
    if cut_off {
        format!("{said}; a file that was cut off has lost the list of its parts, which stands at its end")
    } else {
        said
    }
}

/// Whether a field holds a number, however deep.
fn has_number(field: &Type) -> bool {
    if field.is_group() {
        return field.get_fields().iter().any(|field| has_number(field));
    }
    matches!(
        field.get_physical_type(),
        Physical::INT32 | Physical::INT64 | Physical::FLOAT | Physical::DOUBLE | Physical::BOOLEAN
    )
}

impl Rows {
    fn push(&mut self, row: &Row) {
        let (mut path, mut at) = (String::new(), 0);
        for (name, field) in row.get_column_iter() {
            path.clear();
            path.push_str(name);
            self.visit(field, &mut path, &mut at);
        }
        self.count += 1;
    }

    /// Takes the numbers of a field; they come in the same order row by row, so that `at` is mostly the column of the next.
    fn visit(&mut self, field: &Field, path: &mut String, at: &mut usize) {
        let length = path.len();
        match field {
            Field::Group(row) => {
                for (name, field) in row.get_column_iter() {
                    let _ = write!(path, ".{name}");
                    self.visit(field, path, at);
                    path.truncate(length);
                }
            }
            Field::ListInternal(list) if list.elements().len() <= MOST_OF_A_LIST => {
                for (k, field) in list.elements().iter().enumerate() {
                    let _ = write!(path, "[{k}]");
                    self.visit(field, path, at);
                    path.truncate(length);
                }
            }
            field => match instant(field, self.nanoseconds.contains(path.as_str())) {
                Some(instant) => self.column(path, at).push_instant(instant),
                None => {
                    if let Some(number) = number(field) {
                        let count = self.count;
                        self.column(path, at).push(count, number);
                    }
                }
            },
        }
    }

    fn column(&mut self, path: &str, at: &mut usize) -> &mut Numbers {
        if self.columns.get(*at).is_none_or(|column| column.name != path) {
            *at = self.columns.iter().position(|column| column.name == path).unwrap_or(self.columns.len());
        }
        if *at == self.columns.len() {
            let (values, instants) = (vec![f64::NAN; self.count], Vec::new());
            self.columns.push(Numbers { name: path.to_owned(), values, instants });
        }
        *at += 1;
        &mut self.columns[*at - 1]
    }

    /// The table of them.
    ///
    /// # Errors
    /// Where there are none.
    pub(super) fn table(self, path: &Path) -> Result<Table, String> {
        if self.columns.is_empty() || self.count == 0 {
            return Err("it holds no numbers".to_owned());
        }
        let mut notes = vec!["Parquet file".to_owned()];
        if let Some(reason) = &self.broken {
            notes.push(format!("broken after row {} ({reason}): what precedes is used", self.count));
        }
        let count = self.count;
        Ok(Table {
            path: path.display().to_string(),
            columns: self.columns.into_iter().map(|column| column.finished(count)).collect(),
            places: (1..=count as u64).map(Place::Row).collect(),
            has_header: true,
            notes,
            ..Table::default()
        })
    }
}

impl Numbers {
    fn push(&mut self, row: usize, number: f64) {
        self.values.resize(row, f64::NAN);
        self.values.push(if number.is_finite() { number } else { f64::NAN });
    }

    /// Of instants every row has one, or the column is one of numbers.
    fn push_instant(&mut self, instant: i128) {
        self.values.push(instant as f64 / NANOSECONDS as f64);
        self.instants.push(instant);
    }

    fn finished(mut self, rows: usize) -> Column {
        self.values.resize(rows, f64::NAN);
        if self.instants.len() < rows {
            let (name, unit) =
                match self.name.ends_with(']') && self.name.contains(|c: char| c.is_ascii_digit()) {
                    true => (self.name, None),
                    false => crate::table::unit::split(&self.name),
                };
            return Column { kind: Kind::Number, values: self.values, ..empty_column(name, unit) };
        }
        let origin = self.instants[0];
        let written = |instant: &i128| {
            let (seconds, rest) = (instant.div_euclid(NANOSECONDS), instant.rem_euclid(NANOSECONDS));
            format!("{seconds}.{rest:09}")
        };
        Column {
            kind: Kind::Stamp,
            origin,
            values: self.instants.iter().map(|at| (at - origin) as f64 / NANOSECONDS as f64).collect(),
            stamps: self.instants.iter().map(written).collect(),
            ..empty_column(self.name, None)
        }
    }
}

/// Nanoseconds since 1970, where a field is an instant.
fn instant(field: &Field, counts_nanoseconds: bool) -> Option<i128> {
    match field {
        Field::TimestampMillis(at) => Some(i128::from(*at) * 1_000_000),
        Field::TimestampMicros(at) => Some(i128::from(*at) * 1_000),
        Field::Long(at) if counts_nanoseconds => Some(i128::from(*at)),
        _ => None,
    }
}

fn number(field: &Field) -> Option<f64> {
    Some(match field {
        Field::Null => f64::NAN,
        Field::Bool(x) => f64::from(u8::from(*x)),
        Field::Byte(x) => f64::from(*x),
        Field::Short(x) => f64::from(*x),
        Field::Int(x) => f64::from(*x),
        Field::Long(x) => *x as f64,
        Field::UByte(x) => f64::from(*x),
        Field::UShort(x) => f64::from(*x),
        Field::UInt(x) => f64::from(*x),
        Field::ULong(x) => *x as f64,
        Field::Float(x) => widened(*x),
        Field::Double(x) => *x,
        _ => return None,
    })
}

/// The number that was meant by one of seven digits: the shortest decimal that is read as it.
fn widened(x: f32) -> f64 {
    x.to_string().parse().unwrap_or(f64::from(x))
}
