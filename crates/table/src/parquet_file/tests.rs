use crate::table::{Table, TableError};
use crate::tests::File;
use parquet::basic::{Compression, ZstdLevel};
use parquet::data_type::{ByteArray, ByteArrayType, DoubleType, FloatType, Int64Type};
use parquet::file::properties::WriterProperties;
use parquet::file::writer::{SerializedFileWriter, SerializedRowGroupWriter};
use parquet::schema::parser::parse_message_type;
use std::sync::Arc;

mod hostile;

const ROWS: usize = 1200;
const JOINTS: usize = 3;

fn command(k: usize) -> f64 {
    let t = 0.02 * (k % 600) as f64;
    12.0 * (5.1 * t).sin() * (0.9 * t).cos() + (k / 600) as f64
}

fn written(
    schema: &str,
    compression: Compression,
    fill: impl Fn(&mut SerializedRowGroupWriter<'_, &mut Vec<u8>>),
) -> Vec<u8> {
    let mut bytes = Vec::new();
    let schema = Arc::new(parse_message_type(schema).expect("a schema"));
    let properties = Arc::new(WriterProperties::builder().set_compression(compression).build());
    let mut writer = SerializedFileWriter::new(&mut bytes, schema, properties).expect("a file");
    let mut group = writer.next_row_group().expect("a group");
    fill(&mut group);
    group.close().expect("its end");
    writer.close().expect("the end");
    bytes
}

/// The values of one column, each of a row, or several of a list.
macro_rules! column {
    ($group:expr, $kind:ty, $values:expr, $levels:expr) => {{
        let mut column = $group.next_column().expect("a column").expect("a column");
        let levels: Option<(Vec<i16>, Vec<i16>)> = $levels;
        let (definition, repetition) = levels.unzip();
        column
            .typed::<$kind>()
            .write_batch($values, definition.as_deref(), repetition.as_deref())
            .expect("values");
        column.close().expect("its end");
    }};
}

/// Two episodes as LeRobot writes them: lists of floats, a clock that starts anew, a picture.
fn episodes() -> Vec<u8> {
    let schema = "message m {
        optional group action (LIST) { repeated group list { optional float element; } }
        optional group observation.state (LIST) { repeated group list { optional float element; } }
        required float timestamp; required int64 frame_index; required int64 episode_index;
        optional group image { optional binary bytes; optional binary path (UTF8); } }";
    written(schema, Compression::SNAPPY, |group| {
        let levels = || {
            let repetition = (0..ROWS * JOINTS).map(|k| i16::from(k % JOINTS != 0)).collect();
            Some((vec![3; ROWS * JOINTS], repetition))
        };
        let joints = |of: &dyn Fn(usize) -> f64| -> Vec<f32> {
            (0..ROWS).flat_map(|k| [0.5, of(k) as f32, -0.25]).collect()
        };
        column!(group, FloatType, &joints(&command), levels());
        column!(group, FloatType, &joints(&|k| command(k.saturating_sub(1)) * 0.9), levels());
        let clock: Vec<f32> = (0..ROWS).map(|k| 0.02 * (k % 600) as f32).collect();
        column!(group, FloatType, &clock, None);
        column!(group, Int64Type, &(0..ROWS as i64).map(|k| k % 600).collect::<Vec<_>>(), None);
        column!(group, Int64Type, &(0..ROWS as i64).map(|k| k / 600).collect::<Vec<_>>(), None);
        let pictures = vec![ByteArray::from("picture"); ROWS];
        column!(group, ByteArrayType, &pictures, Some((vec![2; ROWS], vec![0; ROWS])));
        column!(group, ByteArrayType, &pictures, Some((vec![2; ROWS], vec![0; ROWS])));
    })
}

/// A frame of pandas: nanoseconds since 1970, doubles, a value that is missing.
fn frame() -> Vec<u8> {
    let schema = "message schema { required int64 stamp (TIMESTAMP(NANOS,false)); required double travel; optional double force; }";
    written(schema, Compression::ZSTD(ZstdLevel::default()), |group| {
        let stamps: Vec<i64> = (0..ROWS as i64).map(|k| 1_766_147_454_233_218_075 + 20_000_000 * k).collect();
        column!(group, Int64Type, &stamps, None);
        column!(group, DoubleType, &(0..ROWS).map(command).collect::<Vec<_>>(), None);
        let there: Vec<i16> = (0..ROWS).map(|k| i16::from(k != 9)).collect();
        let values: Vec<f64> = (0..ROWS).filter(|k| *k != 9).map(|k| 0.5 * command(k)).collect();
        column!(group, DoubleType, &values, Some((there, vec![0; ROWS])));
    })
}

fn table(file: &File) -> Result<Table, TableError> {
    Table::read(&file.0, 2)
}

#[test]
fn episodes_are_columns_of_lists() {
    let file = File::of("episodes.parquet", &episodes());
    let table = table(&file).expect("a good file");
    let names: Vec<&str> = table.columns.iter().map(|column| column.name.as_str()).collect();
    let lists = [
        "action[0]",
        "action[1]",
        "action[2]",
        "observation.state[0]",
        "observation.state[1]",
        "observation.state[2]",
    ];
    assert_eq!(names, [&lists[..], &["timestamp", "frame_index", "episode_index"]].concat());
    assert!(table.columns[1].values.iter().enumerate().all(|(k, x)| (x - command(k)).abs() < 1e-5));
    assert_eq!(table.columns[6].values[3], 0.06, "the decimal that was meant");
    let measured = file.measured([Some("action[1]"), Some("observation.state[1]")]).expect("a good file");
    assert!((measured.sample_time - 0.02).abs() < 1e-6, "{}", measured.sample_time);
}

#[test]
fn frames_keep_their_stamps() {
    let file = File::of("frame.parquet", &frame());
    let table = table(&file).expect("a good file");
    assert_eq!(table.columns[0].stamps[1], "1766147454.253218075");
    assert!(table.columns[2].values[9].is_nan() && table.columns[2].values[10] == 0.5 * command(10));
    let measured = file.measured([None, None]).expect("a good file");
    assert_eq!([measured.input().label(), measured.output().unwrap().label()], ["travel", "force"]);
    assert!((measured.sample_time - 0.02).abs() < 1e-9);
}

#[test]
fn a_file_that_is_cut_off_or_changed_is_refused_or_read_up_to_there() {
    let bytes = episodes();
    let error = table(&File::of("cut.parquet", &bytes[..bytes.len() / 2])).expect_err("it is cut off");
    assert!(format!("{error:?}").contains("cut off"), "{error:?}");
    // A small generator: no bytes may end the program.
    let mut state = 7_u64;
    let mut next = |below: usize| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as usize % below
    };
    let mut read = 0;
    for whole in [bytes, frame()] {
        for _ in 0..1500 {
            let mut changed = whole.clone();
            // The list of parts stands at the end.
            let from = if next(2) == 0 { 0 } else { whole.len() - whole.len().min(900) };
            for _ in 0..=next(3) {
                let at = from + next(whole.len() - from);
                changed[at] ^= 1 << next(8);
            }
            read += usize::from(table(&File::of("changed.parquet", &changed)).is_ok());
        }
    }
    assert!(read > 100, "{read}");
}
