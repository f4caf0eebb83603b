use crate::table::TableError;
use crate::tests::File;
use mcap::records::MessageHeader;
use std::collections::BTreeMap;

mod hostile;

const JOINT_STATE: &str = "std_msgs/Header header\nstring[] name\nfloat64[] position\nfloat64[] velocity\nfloat64[] effort\n\
    ================================================================================\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n\
    ================================================================================\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n";

const ROWS: usize = 2000;

/// Little-endian CDR.
#[derive(Default)]
struct Cdr(Vec<u8>);

impl Cdr {
    fn align(&mut self, to: usize) {
        self.0.resize(self.0.len().next_multiple_of(to), 0);
    }

    fn u32(&mut self, x: u32) {
        self.align(4);
        self.0.extend(x.to_le_bytes());
    }

    fn text(&mut self, text: &str) {
        self.u32(text.len() as u32 + 1);
        self.0.extend(text.as_bytes());
        self.0.push(0);
    }

    fn list(&mut self, list: &[f64]) {
        self.u32(list.len() as u32);
        for x in list {
            self.align(8);
            self.0.extend(x.to_le_bytes());
        }
    }
}

fn joint_state(nanoseconds: u64, position: &[f64]) -> Vec<u8> {
    let mut cdr = Cdr::default();
    cdr.u32((nanoseconds / 1_000_000_000) as u32);
    cdr.u32((nanoseconds % 1_000_000_000) as u32);
    cdr.text("base");
    cdr.u32(position.len() as u32);
    (0..position.len()).for_each(|k| cdr.text(&format!("joint_{k}")));
    cdr.list(position);
    cdr.list(&[]);
    cdr.list(&[]);
    [vec![0, 1, 0, 0], cdr.0].concat()
}

fn command(k: usize) -> f64 {
    let t = 0.005 * k as f64;
    12.0 * (5.1 * t).sin() * (0.9 * t).cos()
}

/// A log of a command and, 1.5 ms later, its state, each joint but the third at rest; a topic in words beside them.
fn log() -> Vec<u8> {
    let mut bytes = std::io::Cursor::new(Vec::new());
    let options =
        mcap::WriteOptions::new().chunk_size(Some(1 << 14)).compression(Some(mcap::Compression::Zstd));
    let mut writer = options.create(&mut bytes).expect("a log");
    let schema =
        writer.add_schema("sensor_msgs/msg/JointState", "ros2msg", JOINT_STATE.as_bytes()).expect("a schema");
    let words = writer.add_schema("std_msgs/msg/String", "ros2msg", b"string data\n").expect("a schema");
    let mut channel =
        |schema, topic: &str| writer.add_channel(schema, topic, "cdr", &BTreeMap::new()).expect("a channel");
    let [cmd, state, text] = [channel(schema, "/cmd"), channel(schema, "/state"), channel(words, "/log")];
    let (mut y, first) = (0.0, 1_766_147_454_233_218_075_u64);
    for k in 0..ROWS {
        let at = first + 5_000_000 * k as u64;
        let late = |k: usize| 200_000 * (k % 7) as u64;
        let mut write = |channel_id, stamp: u64, data: Vec<u8>| {
            let log_time = stamp + late(k);
            let header = MessageHeader { channel_id, sequence: k as u32, log_time, publish_time: log_time };
            writer.write_to_known_channel(&header, &data).expect("a message");
        };
        write(cmd, at, joint_state(at, &[0.5, 0.25, command(k)]));
        write(state, at + 1_500_000, joint_state(at + 1_500_000, &[0.5, 0.25, y]));
        if k.is_multiple_of(100) {
            write(
                text,
                at,
                [vec![0, 1, 0, 0], {
                    let mut cdr = Cdr::default();
                    cdr.text("well");
                    cdr.0
                }]
                .concat(),
            );
        }
        y += 0.3 * (command(k) - y);
    }
    writer.finish().expect("the end");
    drop(writer);
    bytes.into_inner()
}

#[test]
fn topics_are_joined_on_the_stamps_of_their_headers() {
    let file = File::of("joined.mcap", &log());
    for names in [[Some("/cmd.position[2]"), Some("/state.position[2]")], [None, None]] {
        let measured = file.measured(names).expect("a good log");
        assert!((measured.sample_time - 0.005).abs() < 1e-7, "{}", measured.sample_time);
        assert_eq!(
            [measured.input().label(), measured.output().unwrap().label()],
            ["/cmd.position[2]", "/state.position[2]"]
        );
        // Between two commands the straight line, 1.5 ms behind the first.
        let wanted = |k: usize| command(k) + 0.3 * (command(k + 1) - command(k));
        assert!(measured.v.len() >= ROWS - 2);
        let far = measured.v.iter().enumerate().find(|(k, v)| (**v - wanted(*k)).abs() > 1e-6);
        assert_eq!(far, None, "{:?} {:?}", far.map(|(k, _)| [command(k), wanted(k)]), measured.table.notes);
        assert!(
            measured.table.notes.iter().any(|note| note.contains("clock of its own")),
            "{:?}",
            measured.table.notes
        );
    }
}

#[test]
fn a_log_that_breaks_off_is_used_up_to_there() {
    let bytes = log();
    let file = File::of("broken.mcap", &bytes[..bytes.len() / 2]);
    let measured = file.measured([Some("/cmd.position[2]"), Some("/state.position[2]")]).expect("half a log");
    assert!((ROWS / 4..ROWS).contains(&measured.v.len()), "{}", measured.v.len());
    assert!(
        measured.table.notes.iter().any(|note| note.contains("what precedes is used")),
        "{:?}",
        measured.table.notes
    );
    let file = File::of("torn.mcap", &bytes[..40]);
    assert!(file.measured([None, None]).is_err());
}

#[test]
fn columns_are_listed_where_they_are_in_doubt() {
    let file = File::of("listed.mcap", &log());
    let errors = file.measured([Some("/cmd.effort[0]"), None]).expect_err("there is no such column");
    let Some(TableError::Data(error)) = errors.first() else { panic!("{errors:?}") };
    let said = error.to_string();
    for column in ["`/cmd time`, times", "`/cmd.position[2]`", "`/state.position[0]`"] {
        assert!(said.contains(column), "{said}");
    }
}

#[test]
fn what_is_written_is_read_back() {
    use super::{LogField, LogTopic, log_bytes};
    let field = |name: &str, values: Vec<f64>| LogField {
        name: name.to_owned(),
        comment: "x [mm] # float64 y".to_owned(),
        values,
    };
    let topic = |name: &str, from: f64| LogTopic {
        name: name.to_owned(),
        instants: (0..ROWS as u64).map(|k| 5_000_000 * k).collect(),
        fields: vec![
            field("input", (0..ROWS).map(|k| from + command(k)).collect()),
            field(
                "nominal",
                (0..ROWS)
                    .map(|k| {
                        if k == 7 && from == 0.0 {
                            f64::NAN
                        } else {
                            from + command(k) + command(k.saturating_sub(3))
                        }
                    })
                    .collect(),
            ),
        ],
    };
    let [first, second] = [topic("/a", 0.0), topic("/b", 50.0)];
    let bytes = log_bytes(&[first.clone(), second]).expect("a log");
    assert_eq!(
        bytes,
        log_bytes(&[first.clone(), topic("/b", 50.0)]).expect("a log"),
        "the same bytes every time"
    );
    let file = File::of("written.mcap", &bytes);
    let table = crate::log::read(&file.0, &mut |_| None).expect("a log");
    let column = |name: &str| &table.columns.iter().find(|column| column.name == name).expect(name).values;
    for field in &first.fields {
        let same = |(read, written): (&f64, &f64)| {
            read.to_bits() == written.to_bits() || (read.is_nan() && written.is_nan())
        };
        assert!(column(&format!("/a.{}", field.name)).iter().zip(&field.values).all(same), "{}", field.name);
    }
    assert!(column("/a time").iter().enumerate().all(|(k, t)| (t - 0.005 * k as f64).abs() < 1e-12));
    let measured = file.measured([Some("/b.input"), Some("/b.nominal")]).expect("a good log");
    assert!((measured.sample_time - 0.005).abs() < 1e-9 && (measured.v[9] - 50.0 - command(9)).abs() < 1e-12);
}

#[test]
fn signals_of_one_topic_have_its_clock_wherever_it_stands() {
    use super::{LogField, LogTopic, log_bytes};
    let topic = |name: &str, step: u64| LogTopic {
        name: name.to_owned(),
        instants: (0..ROWS as u64).map(|k| step * k).collect(),
        fields: ["input", "nominal"]
            .map(|name| LogField {
                name: name.to_owned(),
                comment: String::new(),
                values: (0..ROWS).map(|k| command(k.saturating_sub(name.len()))).collect(),
            })
            .into(),
    };
    let file =
        File::of("rates.mcap", &log_bytes(&[topic("/a", 1_000_000), topic("/b", 5_000_000)]).expect("a log"));
    for (topic, wanted) in [("/a", 0.001), ("/b", 0.005)] {
        let [input, output] = ["input", "nominal"].map(|name| format!("{topic}.{name}"));
        let measured = file.measured([Some(&input), Some(&output)]).expect("a good log");
        assert!((measured.sample_time - wanted).abs() < 1e-9, "{topic} {}", measured.sample_time);
    }
}
