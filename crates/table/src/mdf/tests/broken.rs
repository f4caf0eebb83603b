use super::writer::{Field, Group, Packing, Writer};
use super::{ENGINE, ROWS, clock, command, engine, has_note, table, values};
use crate::tests::File;

/// A log whose records stand last: a row of blocks, or one.
fn log(id: &str, packing: Packing, blocks: usize, stated: u64) -> Vec<u8> {
    let mut writer = Writer::new(id, "4.10");
    let nanoseconds = writer.conversion(1, &[], &[0.0, 1e-9]);
    let command = Field { name: "cmd", kinds: [0, 0, 5], byte: 10, bits: 32, ..Field::default() };
    let state = Field { name: "state", kinds: [0, 0, 2], byte: 8, bits: 16, ..Field::default() };
    let channels = writer.channels(&[clock(nanoseconds, 0), command, state]);
    let group = Group { name: "engine", count: stated, bytes: [ENGINE as u32, 0], ..Group::default() };
    let group = writer.group(0, channels, group);
    let data = writer.data(0, group, 0, 0);
    let list = if blocks == 1 { 0 } else { writer.block("DL", &vec![0; 1 + blocks], &[0; 8]) };
    let records = engine(ROWS);
    for (k, part) in records.chunks(records.len().div_ceil(blocks)).enumerate() {
        let block = writer.packed(part, packing);
        if list == 0 { writer.link(data, 2, block) } else { writer.link(list, 1 + k, block) }
    }
    if list != 0 {
        writer.link(data, 2, list);
    }
    writer.finish(data)
}

#[test]
fn a_log_that_breaks_off_is_used_up_to_there() {
    for (packing, blocks, least) in [
        (Packing::None, 1, ROWS * 6 / 10),
        (Packing::None, 7, ROWS * 6 / 10),
        (Packing::Deflated, 1, ROWS / 4),
        (Packing::Deflated, 7, ROWS * 4 / 10),
        (Packing::Turned(ENGINE), 7, ROWS * 4 / 10),
    ] {
        let bytes = log("MDF", packing, blocks, ROWS as u64);
        let cut = &bytes[..bytes.len() * 7 / 10];
        let read = table(cut).expect("part of a log");
        let (t, cmd) = (values(&read, "time"), values(&read, "cmd"));
        assert!((least..ROWS).contains(&t.len()), "{packing:?} {blocks}: {}", t.len());
        assert!(
            (0..t.len())
                .all(|k| (t[k] - 0.005 * k as f64).abs() < 1e-9 && (cmd[k] - command(k)).abs() < 1e-6)
        );
        has_note(
            &read,
            &format!("`engine` is broken after record {} (the file ends at byte {}", t.len(), cut.len()),
        );
        let file = File::of(&format!("cut-{blocks}-{}.mf4", packing != Packing::None), cut);
        let measured = file.measured([Some("cmd"), Some("state")]).expect("part of a log");
        assert_eq!(measured.v.len(), t.len());
    }
    let bytes = log("MDF", Packing::Turned(ENGINE), 1, ROWS as u64);
    let error = table(&bytes[..bytes.len() - 1]).expect_err("its only block cannot be turned");
    assert!(error.contains("`engine` left out: the file ends at byte"), "{error}");
    let error = table(&bytes[..300]).expect_err("its channels are missing");
    assert!(error.contains("the file ends at byte 300"), "{error}");
}

#[test]
fn a_damaged_block_ends_the_log() {
    let mut bytes = log("MDF", Packing::Deflated, 4, ROWS as u64);
    let last = bytes.len() - 9;
    bytes[last] ^= 0x10;
    let read = table(&bytes).expect("three blocks");
    assert_eq!(values(&read, "cmd").len(), ROWS * 3 / 4);
    has_note(&read, "is damaged): what precedes is used");
}

#[test]
fn records_that_are_stated_but_missing_are_reported_and_others_are_none() {
    let read = table(&log("MDF", Packing::None, 1, 5000)).expect("a log");
    has_note(&read, "`engine` is broken after record 2000 (there should be 5000)");
    let read = table(&log("MDF", Packing::None, 1, 1500)).expect("a log");
    assert_eq!((values(&read, "cmd").len(), read.notes.len()), (1500, 1));
}

#[test]
fn a_log_that_was_not_finished_is_read_to_its_end() {
    let mut bytes = log("UnFinMF", Packing::None, 1, 0);
    let block = bytes.windows(4).position(|id| id == b"##DT").expect("records");
    bytes[block + 8..block + 16].copy_from_slice(&24_u64.to_le_bytes());
    let read = table(&bytes).expect("a log");
    assert_eq!(values(&read, "cmd").len(), ROWS);
    has_note(&read, "its writer did not finish it");
}
