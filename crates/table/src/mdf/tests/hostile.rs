use super::writer::{Field, Group, Packing, Writer};
use super::{PLAIN, clock, log_of, table};
use std::time::Instant;

const X: Field<'static> = Field {
    name: "x",
    unit: 0,
    conversion: 0,
    kinds: [0, 0, 0],
    bit: 0,
    byte: 8,
    bits: 8,
    flags: 0,
    validity: 0,
    composition: 0,
};

/// A log whose data are made by the test, with a group of records with so many bytes.
fn with_data(
    bytes: u32,
    count: u64,
    data: impl Fn(&mut Writer) -> u64,
) -> Result<crate::table::Table, String> {
    let mut writer = Writer::new("MDF", "4.10");
    let channels = writer.channels(&[clock(0, 4), X]);
    let group = writer.group(0, channels, Group { bytes: [bytes, 0], count, ..Group::default() });
    let records = data(&mut writer);
    let data = writer.data(0, group, records, 0);
    table(&writer.finish(data))
}

#[test]
fn lists_in_circles_end() {
    // Groups, and channels, that follow themselves.
    for (id, link) in [("##DG", 0), ("##CG", 0), ("##CN", 0), ("##CN", 1), ("##DG", 1)] {
        let mut writer = Writer(log_of(PLAIN, 100));
        let block = writer.0.windows(4).position(|bytes| bytes == id.as_bytes()).expect(id) as u64;
        writer.link(block, link, block);
        let _ = table(&writer.0);
    }
    // Lists of records that lead to themselves, by either link.
    for link in [0, 1] {
        let read = with_data(9, 0, |writer| {
            let records = writer.block("DT", &[], &[0; 90]);
            let list = writer.block("DL", &[0, records], &[0; 8]);
            writer.link(list, link, list);
            list
        });
        assert!(read.is_err() || read.is_ok_and(|read| read.places.len() < 1000));
    }
    // One block, in a list again and again.
    let read = with_data(9, 0, |writer| {
        let records = writer.block("DT", &[], &[0; 9000]);
        writer.block("DL", &[&[0][..], &vec![records; 100_000]].concat(), &[0; 8])
    });
    let read = read.expect("the first ones");
    assert!(read.places.len() < 2_000_000 / 9 && read.notes.iter().any(|note| note.contains("overlap")));
}

#[test]
fn counts_and_lengths_that_are_not_true_take_no_memory() {
    let most = u64::MAX;
    let read = with_data(9, most, |writer| writer.block("DT", &[], &[0; 90])).expect("ten records");
    assert_eq!(read.places.len(), 10);
    assert!(
        with_data(u32::MAX, most, |writer| writer.block("DT", &[], &[0; 90]))
            .expect_err("too long")
            .contains("records of")
    );
    assert!(with_data(0, most, |writer| writer.block("DT", &[], &[0; 90])).is_err());
    // Lengths of blocks, numbers of links, and of what a block was before it was compressed.
    for id in ["##HD", "##DG", "##CG", "##CN", "##CC", "##TX", "##MD", "##HL", "##DL", "##DZ", "##DT"] {
        for field in [8, 16, 32, 40] {
            for number in [0, 1, 23, 24, 25, 1 << 20, 1 << 32, 1 << 61, u64::MAX - 8, u64::MAX] {
                let mut bytes = log_of(if id == "##DT" { PLAIN } else { Packing::Turned }, 100);
                let block = bytes.windows(4).position(|bytes| bytes == id.as_bytes()).expect(id);
                bytes[block + field..block + field + 8].copy_from_slice(&number.to_le_bytes());
                let _ = table(&bytes);
            }
        }
    }
}

#[test]
fn a_small_file_of_many_bytes_is_bounded() {
    let zeros = vec![0; 1 << 24];
    let read = with_data(9, 0, |writer| writer.packed(&zeros, Packing::Deflated)).expect("zeros");
    assert_eq!(read.places.len(), (1 << 24) / 9);
    let mut writer = Writer::new("MDF", "4.10");
    let packed = writer.packed(&zeros, Packing::Deflated);
    // It says that fewer bytes come out.
    writer.0[packed as usize + 32..packed as usize + 40].copy_from_slice(&90_u64.to_le_bytes());
    let channels = writer.channels(&[clock(0, 4), X]);
    let group = writer.group(0, channels, Group { bytes: [9, 0], ..Group::default() });
    let data = writer.data(0, group, packed, 0);
    assert!(table(&writer.finish(data)).expect_err("damaged").contains("is damaged"));
}

#[test]
fn many_channels_of_one_name_are_named_apart_in_time() {
    let begun = Instant::now();
    let mut writer = Writer::new("MDF", "4.10");
    let channels = writer.channels(&vec![X; 70_000]);
    let group = writer.group(0, channels, Group { bytes: [9, 0], ..Group::default() });
    let records = writer.block("DT", &[], &[0; 90]);
    let data = writer.data(0, group, records, 0);
    let read = table(&writer.finish(data)).expect("the first ones");
    assert_eq!(read.columns.len(), 1 << 16);
    assert!(read.notes.iter().any(|note| note.contains("more than 65536 channels")), "{:?}", read.notes);
    assert!(begun.elapsed().as_secs() < 30, "{:?}", begun.elapsed());
}

#[test]
fn of_many_broken_groups_some_are_named() {
    let mut writer = Writer::new("MDF", "4.10");
    let mut data = 0;
    for _ in 0..300 {
        let channels = writer.channels(&[clock(0, 4), X]);
        let group = writer.group(0, channels, Group { bytes: [9, 0], ..Group::default() });
        let records = writer.block("DV", &[], &[0; 8]);
        data = writer.data(data, group, records, 0);
    }
    let said = table(&writer.finish(data)).expect_err("data by columns");
    assert!(said.contains("`group 8`") && said.contains("292 more groups are broken"), "{said}");
    assert!(!said.contains("`group 9`"), "{said}");
}

#[test]
fn changed_bytes_never_end_the_program() {
    let packings: [fn(usize) -> Packing; 3] = [PLAIN, |_| Packing::Deflated, Packing::Turned];
    let logs = packings.map(|packing| log_of(packing, 100));
    let mut state = 2026_u64;
    let mut below = |most: usize| {
        // Knuth's linear congruential generator.
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((state >> 33) % most.max(1) as u64) as usize
    };
    for k in 0..6000 {
        let mut bytes = logs[k % 3].clone();
        for _ in 0..=below(5) {
            // Blocks rather than records: what follows the sign of one.
            let signs: Vec<usize> =
                (0..bytes.len().saturating_sub(3)).filter(|k| bytes[*k..].starts_with(b"##")).collect();
            let Some(sign) = signs.get(below(signs.len())).copied() else { break };
            let at = (sign + below(120)).min(bytes.len() - 1);
            match below(4) {
                0 => bytes[at] ^= 1 << below(8),
                1 => bytes[at] = below(256) as u8,
                2 => bytes.truncate(at),
                _ => {
                    let other = signs[below(signs.len())] as u64;
                    let place = (sign + 24 + 8 * below(8)).min(bytes.len().saturating_sub(8));
                    if place + 8 <= bytes.len() {
                        bytes[place..place + 8].copy_from_slice(&other.to_le_bytes());
                    }
                }
            }
            if bytes.is_empty() {
                break;
            }
        }
        let _ = table(&bytes);
    }
}
