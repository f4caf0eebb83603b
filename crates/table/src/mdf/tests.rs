use super::is_mdf;
use crate::chosen::Chosen;
use crate::table::{Table, TableError};
use crate::tests::File;
use std::io::Cursor;
use std::path::Path;
use writer::{Field, Group, Packing, Writer};

mod broken;
mod hostile;
mod kinds;
mod writer;

const ROWS: usize = 2000;

/// Bytes of a record of the engine: nanoseconds, a command, its copy.
const ENGINE: usize = 8 + 2 + 4;

fn command(k: usize) -> f64 {
    let t = 0.005 * k as f64;
    12.0 * (5.1 * t).sin() * (0.9 * t).cos()
}

fn engine(rows: usize) -> Vec<u8> {
    let record = |k: usize| {
        let count = (command(k) / 0.001).round() as i16;
        [&(5_000_000 * k as u64).to_le_bytes()[..], &count.to_le_bytes(), &(command(k) as f32).to_be_bytes()]
            .concat()
    };
    (0..rows).flat_map(record).collect()
}

/// Half a sample later than each command.
fn chassis(rows: usize) -> Vec<u8> {
    let mut y = 0.0;
    let record = |k: usize| {
        let bytes = [(0.0025 + 0.005 * k as f64).to_le_bytes(), f64::to_le_bytes(y)].concat();
        y += 0.3 * (command(k) - y);
        bytes
    };
    (0..rows).flat_map(record).collect()
}

/// A clock in seconds, at the beginning of a record.
fn clock(conversion: u64, kind: u8) -> Field<'static> {
    Field { name: "t", conversion, kinds: [2, 1, kind], bits: 64, ..Field::default() }
}

/// Two groups, each with its own data.
fn log(packing: fn(usize) -> Packing) -> Vec<u8> {
    log_of(packing, ROWS)
}

fn log_of(packing: fn(usize) -> Packing, rows: usize) -> Vec<u8> {
    let mut writer = Writer::new("MDF", "4.10");
    let nanoseconds = writer.conversion(1, &[], &[0.0, 1e-9]);
    let thousandths = writer.conversion(1, &[], &[0.5, 0.001]);
    let percent = writer.text("%");
    let degrees = writer.block("MD", &[], "<CNunit xmlns=\"x\"><TX>deg &amp; so</TX></CNunit>\0".as_bytes());
    let fields = [
        clock(nanoseconds, 0),
        Field {
            name: "pedal_cmd",
            unit: percent,
            conversion: thousandths,
            kinds: [0, 0, 2],
            byte: 8,
            bits: 16,
            ..Field::default()
        },
        Field { name: "copy", kinds: [0, 0, 5], byte: 10, bits: 32, ..Field::default() },
        Field { name: "words", kinds: [0, 0, 6], byte: 8, bits: 16, ..Field::default() },
    ];
    let channels = writer.channels(&fields);
    let group = Group { name: "engine", count: rows as u64, bytes: [ENGINE as u32, 0], ..Group::default() };
    let engine_group = writer.group(0, channels, group);
    let fields = [
        clock(0, 4),
        Field { name: "pedal_pos", unit: degrees, kinds: [0, 0, 4], byte: 8, bits: 64, ..Field::default() },
    ];
    let channels = writer.channels(&fields);
    let chassis_group = writer.group(0, channels, Group { name: "chassis", bytes: [16, 0], ..group });
    let records = writer.records(&engine(rows), packing(ENGINE), 5000);
    let first = writer.data(0, engine_group, records, 0);
    let records = writer.packed(&chassis(rows), packing(16));
    let second = writer.data(first, chassis_group, records, 0);
    writer.finish(second)
}

const PLAIN: fn(usize) -> Packing = |_| Packing::None;

/// The table of a log from which nothing is chosen.
fn table(bytes: &[u8]) -> Result<Table, String> {
    super::chosen(Cursor::new(bytes), Path::new("a.mf4"), [1 << 24; 2], &mut |_| None)
        .map_err(|fault| fault.to_string())
}

fn values<'a>(table: &'a Table, name: &str) -> &'a [f64] {
    &table.columns.iter().find(|column| column.name == name).expect(name).values
}

fn has_note(table: &Table, part: &str) {
    assert!(table.notes.iter().any(|note| note.contains(part)), "{part}: {:?}", table.notes);
}

#[test]
fn groups_are_joined_on_their_clocks_however_they_are_packed() {
    let packings: [fn(usize) -> Packing; 3] = [PLAIN, |_| Packing::Deflated, Packing::Turned];
    for (k, packing) in packings.into_iter().enumerate() {
        let file = File::of(&format!("joined-{k}.mf4"), &log(packing));
        for names in [[Some("pedal_cmd"), Some("pedal_pos")], [None, None], [Some("5"), Some("2")]] {
            let measured = file.measured(names).expect("a good log");
            assert!((measured.sample_time - 0.005).abs() < 1e-9, "{}", measured.sample_time);
            let labels = [measured.input().label(), measured.output().unwrap().label()];
            has_note(&measured.table, "clock of its own");
            if names[0] == Some("5") {
                assert_eq!(labels, ["copy", "pedal_pos [deg & so]"]);
                continue;
            }
            assert_eq!(labels, ["pedal_cmd [%]", "pedal_pos [deg & so]"]);
            // In the middle between two commands, the last of which is half a thousandth off at most.
            let wanted = |k: usize| 0.5 + 0.5 * (command(k) + command(k + 1));
            let far = measured.v.iter().enumerate().find(|(k, v)| (**v - wanted(*k)).abs() > 6e-4);
            assert_eq!((far, measured.v.len() >= ROWS - 2), (None, true));
            has_note(&measured.table, "channels left out: 1 of words or bytes");
        }
    }
}

#[test]
fn of_a_long_log_only_what_is_chosen_is_read_whole() {
    let bytes = log(Packing::Turned);
    let read = |limits, mut choice: &mut dyn FnMut(&Table) -> Option<Chosen>| {
        super::chosen(Cursor::new(&bytes), Path::new("a.mf4"), limits, &mut choice)
            .map_err(|fault| fault.to_string())
    };
    let head = read([500, 500], &mut |_| None).expect("the first records");
    assert_eq!((head.columns.len(), head.places.len()), (5, 100));
    let mut choice = |head: &Table| {
        assert_eq!(head.places.len(), 100);
        Some(Chosen { signals: [3, 1], time: None, rivals: vec![4] })
    };
    let whole = read([500, 1 << 20], &mut choice).expect("all records");
    let names: Vec<&str> = whole.columns.iter().map(|column| column.name.as_str()).collect();
    assert_eq!(names, ["chassis time", "pedal_pos", "engine time", "pedal_cmd"]);
    assert_eq!(whole.places.len(), ROWS);
    has_note(&whole, "the log also holds `copy`");
    assert_eq!(read([500, 4000], &mut choice).expect_err("too many"), "it holds more than 4000 numbers");
}

#[test]
fn signals_of_one_group_keep_its_clock() {
    let measured =
        File::of("one.mf4", &log(PLAIN)).measured([Some("pedal_cmd"), Some("copy")]).expect("a good log");
    assert_eq!((measured.v.len(), measured.table.columns.len()), (ROWS, 3));
    assert_eq!(measured.table.columns[0].label(), "engine time [s]");
    let y = measured.y.expect("an output");
    assert!(y.iter().enumerate().all(|(k, y)| (y - command(k)).abs() < 1e-5));
}

#[test]
fn columns_are_listed_where_they_are_in_doubt() {
    let file = File::of("listed.mf4", &log(PLAIN));
    let errors = file.measured([Some("words"), None]).expect_err("there is no such column");
    let Some(TableError::Data(error)) = errors.first() else { panic!("{errors:?}") };
    let said = error.to_string();
    for column in ["`engine time [s]`", "`pedal_cmd [%]`", "`chassis time [s]`", "`pedal_pos [deg & so]`"] {
        assert!(said.contains(column), "{said}");
    }
}

#[test]
fn a_log_is_known_by_its_ending_or_its_first_bytes() {
    assert!(is_mdf(Path::new("a.MF4"), b"") && is_mdf(Path::new("a"), b"MDF     4.10"));
    assert!(is_mdf(Path::new("a.dat"), b"UnFinMF 4.10") && !is_mdf(Path::new("a.csv"), b"MDF,v\n1,2\n"));
    let refused = |bytes: &[u8]| table(bytes).expect_err("no such log");
    assert_eq!(refused(b"t,v\n1,2\n"), "it does not begin as MDF does");
    assert_eq!(refused(&Writer::new("MDF", "3.30").0), "it is MDF 3.30, not MDF 4");
    assert!(refused(&Writer::new("MDF", "4.10").0).contains("no channel of numbers"));
}
