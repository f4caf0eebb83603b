//! Files that state sizes which are not true, written byte by byte.

use crate::table::{Table, TableError};
use crate::tests::File;

/// Kinds of values in Thrift's compact protocol.
const INT: u8 = 5;
const LONG: u8 = 6;
const BYTES: u8 = 8;
const LIST: u8 = 9;
const STRUCT: u8 = 12;

/// The first bytes of a file, before its first page.
const BEGIN: &[u8] = b"PAR1";

fn unsigned(mut number: u64) -> Vec<u8> {
    let mut bytes = Vec::new();
    while number > 0x7f {
        bytes.push(number as u8 | 0x80);
        number >>= 7;
    }
    bytes.push(number as u8);
    bytes
}

fn whole(number: i64) -> Vec<u8> {
    unsigned(((number << 1) ^ (number >> 63)).cast_unsigned())
}

fn text(text: &str) -> Vec<u8> {
    [unsigned(text.len() as u64), text.as_bytes().to_vec()].concat()
}

fn list(kind: u8, items: &[Vec<u8>]) -> Vec<u8> {
    [vec![0xf0 | kind], unsigned(items.len() as u64), items.concat()].concat()
}

fn record(fields: &[(u8, u8, Vec<u8>)]) -> Vec<u8> {
    let field = |(number, kind, value): &(u8, u8, Vec<u8>)| {
        [vec![*kind], whole(i64::from(*number)), value.clone()].concat()
    };
    [fields.iter().map(field).collect::<Vec<_>>().concat(), vec![0]].concat()
}

/// A file of one column `x`, and what it states.
struct Stated {
    /// Columns within the root, then within each column but the last.
    within: Vec<i64>,
    rows: i64,
    /// Bytes and values of the page, and its kind: data or values to refer to.
    unpacked: i64,
    values: i64,
    is_dictionary: bool,
    /// A field that no reader knows.
    unknown: (u8, Vec<u8>),
}

const NONE: Stated = Stated {
    within: Vec::new(),
    rows: 3,
    unpacked: 24,
    values: 3,
    is_dictionary: false,
    unknown: (INT, Vec::new()),
};

impl Stated {
    fn read(&self, name: &str) -> Result<Table, String> {
        let read = Table::read(&File::of(name, &self.bytes()).0, 1);
        read.map_err(|error| match error {
            TableError::Data(error) => error.to_string(),
            TableError::File(error) => error.to_string(),
        })
    }

    fn page(&self) -> Vec<u8> {
        let plain = || (2, INT, whole(0));
        let levels = [(3, INT, whole(3)), (4, INT, whole(3))];
        let fields = [vec![(1, INT, whole(self.values)), plain()], levels.to_vec()].concat();
        let (kind, head) = if self.is_dictionary {
            (2, (7, STRUCT, record(&fields[..2])))
        } else {
            (0, (5, STRUCT, record(&fields)))
        };
        record(&[(1, INT, whole(kind)), (2, INT, whole(self.unpacked)), (3, INT, whole(24)), head])
    }

    fn bytes(&self) -> Vec<u8> {
        let numbers = [0.5_f64, 1.5, 2.5].map(f64::to_le_bytes).concat();
        let page = [self.page(), numbers].concat();
        let (required, double) = (|| (3, INT, whole(0)), || (1, INT, whole(5)));
        let group = |within: &i64| record(&[required(), (4, BYTES, text("x")), (5, INT, whole(*within))]);
        let within: &[i64] = if self.within.is_empty() { &[1] } else { &self.within };
        let leaf = record(&[double(), required(), (4, BYTES, text("x"))]);
        let schema: Vec<Vec<u8>> = within.iter().map(group).chain([leaf]).collect();
        let column = record(&[
            double(),
            (2, LIST, list(INT, &[whole(0)])),
            (3, LIST, list(BYTES, &vec![text("x"); within.len()])),
            (4, INT, whole(i64::from(self.unpacked != 24))),
            (5, LONG, whole(self.rows)),
            (6, LONG, whole(page.len() as i64)),
            (7, LONG, whole(page.len() as i64)),
            (9, LONG, whole(BEGIN.len() as i64)),
        ]);
        let column = record(&[(2, LONG, whole(BEGIN.len() as i64)), (3, STRUCT, column)]);
        let rows = || whole(self.rows);
        let group = record(&[(1, LIST, list(STRUCT, &[column])), (2, LONG, whole(24)), (3, LONG, rows())]);
        let (kind, unknown) = self.unknown.clone();
        let mut fields = vec![
            (1, INT, whole(1)),
            (2, LIST, list(STRUCT, &schema)),
            (3, LONG, rows()),
            (4, LIST, list(STRUCT, &[group])),
        ];
        if !unknown.is_empty() {
            fields.push((99, kind, unknown));
        }
        let parts = record(&fields);
        let length = (parts.len() as u32).to_le_bytes();
        [BEGIN, &page, &parts, &length, BEGIN].concat()
    }
}

#[test]
fn a_file_that_states_the_truth_is_read() {
    let read = NONE.read("true.parquet").expect("a file");
    assert_eq!(read.columns[0].values, [0.5, 1.5, 2.5]);
    let read = Stated { within: vec![1; 40], ..NONE }.read("within.parquet").expect("a file");
    assert_eq!(read.columns[0].values, [0.5, 1.5, 2.5]);
    let read = Stated { unknown: (LIST, list(1, &[])), ..NONE }.read("unknown.parquet");
    assert_eq!(read.expect("a file").columns[0].values, [0.5, 1.5, 2.5]);
}

#[test]
fn sizes_that_are_not_true_are_refused_before_memory_is_taken() {
    let most = i64::from(i32::MAX);
    let truths = [vec![0xf1], unsigned(most as u64)].concat();
    for (k, (stated, reason)) in [
        (Stated { within: vec![most], ..NONE }, "the list of its parts"),
        (Stated { within: vec![1, 1, most], ..NONE }, "the list of its parts"),
        (Stated { within: vec![1; 100_000], ..NONE }, "the list of its parts"),
        (Stated { unknown: (LIST, truths), ..NONE }, "the list of its parts"),
        (Stated { unpacked: most, ..NONE }, "states a length of 2147483647 bytes"),
        (Stated { is_dictionary: true, values: most, ..NONE }, "2147483647 values in 24 bytes"),
        (Stated { values: most, ..NONE }, "more values than stated"),
        (Stated { rows: 1 << 40, ..NONE }, "it holds more than"),
        (Stated { rows: 1 << 27, ..NONE }, "more than its bytes can hold"),
        (Stated { rows: -1, ..NONE }, "more"),
    ]
    .into_iter()
    .enumerate()
    {
        let error = stated.read(&format!("stated-{k}.parquet")).expect_err(reason);
        assert!(error.contains(reason), "{reason}: {error}");
    }
}
