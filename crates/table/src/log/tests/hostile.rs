//! Logs that state what is not true, or hold more than memory does.

use super::log;
use crate::log::messages::{Limits, collect};
use crate::table::{Table, TableError};
use crate::tests::File;
use mcap::records::MessageHeader;
use std::collections::BTreeMap;
use std::time::Instant;

/// How a message begins: in little-endian CDR.
const LITTLE: [u8; 4] = [0, 1, 0, 0];

/// A log of one topic, whose messages come every hundredth of a second.
fn of(definition: &str, message: &[u8], count: u64) -> Vec<u8> {
    let mut bytes = std::io::Cursor::new(Vec::new());
    let mut writer = mcap::WriteOptions::new().create(&mut bytes).expect("a log");
    let schema = writer.add_schema("a/msg/A", "ros2msg", definition.as_bytes()).expect("a schema");
    let channel_id = writer.add_channel(schema, "/a", "cdr", &BTreeMap::new()).expect("a channel");
    for k in 0..count {
        let log_time = 10_000_000 * (k + 1);
        let header = MessageHeader { channel_id, sequence: 0, log_time, publish_time: log_time };
        writer.write_to_known_channel(&header, &[&LITTLE, message].concat()).expect("a message");
    }
    writer.finish().expect("the end");
    drop(writer);
    bytes.into_inner()
}

fn table(name: &str, bytes: &[u8]) -> Result<Table, TableError> {
    crate::log::read(&File::of(name, bytes).0, &mut |_| None)
}

#[test]
fn a_stated_length_takes_no_memory() {
    let whole = log();
    // The length of the first record, of a chunk, and of what the chunk was before it was compressed.
    let chunk = 8 + 9 + u64::from_le_bytes(whole[9..17].try_into().expect("eight bytes")) as usize;
    assert_eq!(whole[chunk], 6, "a chunk");
    for place in [9, chunk + 1, chunk + 9 + 16, chunk + 9 + 28, chunk + 9 + 36] {
        for length in [0, 1, 1 << 24, 1 << 31, 1 << 40, u64::MAX / 2, u64::MAX - 8, u64::MAX] {
            let mut bytes = whole.clone();
            bytes[place..place + 8].copy_from_slice(&length.to_le_bytes());
            let _ = table("lengths.mcap", &bytes);
        }
    }
}

#[test]
fn a_chunk_that_is_shorter_than_its_records_ends_the_log() {
    let mut bytes = std::io::Cursor::new(Vec::new());
    let mut writer = mcap::WriteOptions::new().compression(None).create(&mut bytes).expect("a log");
    let schema = writer.add_schema("a/msg/A", "ros2msg", b"float64 x\n").expect("a schema");
    let channel_id = writer.add_channel(schema, "/a", "cdr", &BTreeMap::new()).expect("a channel");
    let header = MessageHeader { channel_id, sequence: 0, log_time: 1, publish_time: 1 };
    writer.write_to_known_channel(&header, &[LITTLE, LITTLE, LITTLE].concat()).expect("a message");
    writer.finish().expect("the end");
    drop(writer);
    let mut bytes = bytes.into_inner();
    let chunk = 8 + 9 + u64::from_le_bytes(bytes[9..17].try_into().expect("eight bytes")) as usize;
    // Ten bytes of records, where the first has more.
    bytes[chunk + 9 + 32..chunk + 9 + 40].copy_from_slice(&10_u64.to_le_bytes());
    let read = table("short.mcap", &bytes);
    assert!(read.is_err() || read.is_ok_and(|read| read.notes.iter().any(|note| note.contains("broken"))));
}

#[test]
fn messages_within_messages_end() {
    let begun = Instant::now();
    let part = |name: char, of: char| format!("====\nMSG: a/{name}\na/{of}[100] x\n");
    let nested: String = ('B'..'M').zip('C'..'N').map(|(name, of)| part(name, of)).collect();
    let definition = format!("float64 y\na/B[100] x\n{nested}====\nMSG: a/M\nuint8 NONE=1\n");
    // Messages without fields take no bytes.
    let read = table("nested.mcap", &of(&definition, &[0; 200], 3));
    assert!(read.is_err() && begun.elapsed().as_secs() < 10, "{:?}", begun.elapsed());
}

#[test]
fn stamps_of_any_number_are_instants() {
    let definition = "std_msgs/Header header\nfloat64 x\n====\nMSG: std_msgs/Header\nT stamp\n====\nMSG: T\n\
        float64 sec\nfloat64 nanosec\n";
    for second in [1e300, -1e300, f64::NAN, f64::INFINITY, -0.5] {
        let message: Vec<u8> = [second, second, 1.0].iter().flat_map(|x| x.to_le_bytes()).collect();
        let read = table("stamps.mcap", &of(definition, &message, 3)).expect("a log");
        assert!(
            read.columns[0].values.iter().all(|t| *t == 0.0 || second != second.trunc() || second.is_nan())
        );
    }
}

#[test]
fn numbers_are_read_as_far_as_memory_goes() {
    // Lists of lists of lists: more numbers than a log may have columns.
    let part = |name: char, of: &str| format!("====\nMSG: a/{name}\n{of}[64] x\n");
    let definition = format!("a/B[64] x\n{}{}", part('B', "a/C"), part('C', "uint8"));
    let read = table("wide.mcap", &of(&definition, &[7; 1 << 18], 2));
    assert!(read.is_err(), "too many to be columns");
    let few = File::of("few.mcap", &of("uint8[54] x\n", &[7; 54], 200));
    let limits = Limits { messages: 1000, numbers: 6400 };
    let read = collect(&few.0, None, limits).expect("the first messages");
    assert!(read.is_cut && read.table(&few.0).places.len() == 100);
    let names = ["/a.x[3]", "/a.x[4]"].map(str::to_owned);
    assert!(!collect(&few.0, Some(&names), limits).expect("all messages").is_cut);
    // A name that is no name.
    let named = format!("uint8 {}\n", "x".repeat(300));
    assert!(table("name.mcap", &of(&named, &[7], 20)).is_err());
}
