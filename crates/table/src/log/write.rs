//! A log, written.

use super::topic::LogTopic;
use mcap::records::MessageHeader;
use mcap::{McapResult, WriteOptions};
use std::collections::BTreeMap;
use std::io::Cursor;

/// Nanoseconds of a second.
const SECOND: u64 = 1_000_000_000;

/// What messages within messages are, as ROS 2 defines them.
const HEADER: &str = "\
================================================================================
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
================================================================================
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
";

/// The bytes of a log; messages in the order of their instants.
pub(super) fn bytes(topics: &[LogTopic]) -> McapResult<Vec<u8>> {
    let mut bytes = Cursor::new(Vec::new());
    let mut writer = WriteOptions::new().profile("ros2").library("switchback").create(&mut bytes)?;
    let mut order: Vec<(u64, usize, usize)> = Vec::new();
    let mut channels = Vec::with_capacity(topics.len());
    for (number, topic) in topics.iter().enumerate() {
        let schema = writer.add_schema(&topic.kind(), "ros2msg", definition(topic).as_bytes())?;
        channels.push(writer.add_channel(schema, &topic.name, "cdr", &BTreeMap::new())?);
        order.extend(topic.instants.iter().enumerate().map(|(row, instant)| (*instant, number, row)));
    }
    order.sort_unstable();
    for (log_time, number, row) in order {
        let sequence = u32::try_from(row).unwrap_or(u32::MAX);
        let header =
            MessageHeader { channel_id: channels[number], sequence, log_time, publish_time: log_time };
        writer.write_to_known_channel(&header, &message(&topics[number], row))?;
    }
    writer.finish()?;
    drop(writer);
    Ok(bytes.into_inner())
}

fn definition(topic: &LogTopic) -> String {
    let field = |field: &super::topic::LogField| format!("float64 {} # {}\n", field.name, field.comment);
    let fields: String = topic.fields.iter().map(field).collect();
    format!("std_msgs/Header header\n{fields}{HEADER}")
}

/// Little-endian CDR: the stamp, an empty name of a frame, and numbers at multiples of eight bytes.
fn message(topic: &LogTopic, row: usize) -> Vec<u8> {
    let (seconds, nanoseconds) = (topic.instants[row] / SECOND, topic.instants[row] % SECOND);
    let mut message = vec![0, 1, 0, 0];
    for whole in [seconds, nanoseconds, 1] {
        message.extend((whole as u32).to_le_bytes());
    }
    // The end of the empty text, and what is left to the next multiple of eight.
    message.extend([0; 4]);
    for field in &topic.fields {
        message.extend(field.values[row].to_le_bytes());
    }
    message
}
