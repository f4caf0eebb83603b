//! The sizes that a file states: the library that reads Parquet takes memory by them, so that they are looked at before it does.

use super::compact::{Compact, LIST, STRUCT, Unread};
use super::magic::MAGIC;
use crate::door::Opened;
use parquet::file::metadata::{ColumnChunkMetaData, ParquetMetaData};
use parquet::file::reader::{ChunkReader, Length};
use parquet::schema::types::TypePtr;
use std::collections::BTreeSet;

/// Bytes after the list of parts: its length, and the sign of the format.
const TAIL: u64 = 8;

/// Columns within columns.
const DEEPEST: usize = 64;

/// Most bytes of a page. Those of 1 MiB are usual.
const LONGEST_PAGE: i64 = 1 << 28;

/// Most numbers in lists of a group of rows: those of one row are in memory at once.
const MOST_IN_LISTS: u64 = 1 << 25;

/// Most numbers of a file without a byte, and with each byte of it: numbers that do not change take none.
const FEW: u64 = 1 << 20;
const MOST_OF_A_BYTE: u64 = 1 << 13;

/// Sizes of a page.
#[derive(Default)]
struct Page {
    kind: i64,
    unpacked: i64,
    packed: i64,
    values: i64,
}

/// Looks at the schema of a file, which states how many columns are within each.
///
/// # Errors
/// Where it cannot be true. A file that has none is left to the library.
pub(super) fn check_schema(file: &Opened) -> Result<(), String> {
    let length = Length::len(file);
    let Some(tail) = length.checked_sub(TAIL).and_then(|at| file.get_bytes(at, TAIL as usize).ok()) else {
        return Ok(());
    };
    let parts = u64::from(u32::from_le_bytes(tail[..4].try_into().unwrap_or_default()));
    let Some(begin) = (length - TAIL).checked_sub(parts).filter(|_| tail.ends_with(MAGIC)) else {
        return Ok(());
    };
    let parts = file.get_bytes(begin, parts as usize).map_err(|error| error.to_string())?;
    let mut source = Compact::of(&parts[..], parts.len() as u64);
    let read = source.fields(&mut |source, number, kind| match (number, kind) {
        (2, LIST) => schema(source),
        _ => source.skip(kind),
    });
    read.map_err(|_| "the list of its parts, which stands at its end, is damaged".to_owned())
}

/// Columns one after the other, each followed by those within it.
fn schema(source: &mut Compact<&[u8]>) -> Result<(), Unread> {
    let (kind, count) = source.list()?;
    // Of each column that others are within, how many are still to come.
    let mut open: Vec<u64> = Vec::new();
    for _ in 0..count {
        let mut within = 0;
        if kind != STRUCT {
            return Err(Unread::Broken);
        }
        source.fields(&mut |source, number, kind| {
            match (number, kind) {
                (5, 5) => within = u64::try_from(source.whole()?).map_err(|_| Unread::Untrue)?,
                _ => source.skip(kind)?,
            }
            Ok(())
        })?;
        if let Some(last) = open.last_mut() {
            *last -= 1;
        }
        if within > count || open.len() > DEEPEST {
            return Err(Unread::Untrue);
        }
        open.push(within);
        while open.last() == Some(&0) {
            open.pop();
        }
    }
    Ok(())
}

/// Looks at the pages of the columns wanted.
///
/// # Errors
/// Where there are more numbers than `most`, or than can be there.
pub(super) fn check_pages(
    file: &Opened,
    metadata: &ParquetMetaData,
    wanted: &[TypePtr],
    most: u64,
) -> Result<(), String> {
    let names: BTreeSet<&str> = wanted.iter().map(|field| field.name()).collect();
    let is_wanted = |column: &&ColumnChunkMetaData| {
        column.column_path().parts().first().is_some_and(|name| names.contains(name.as_str()))
    };
    let mut numbers = 0_u64;
    let mut bytes = Length::len(file);
    let believed = bytes.saturating_mul(MOST_OF_A_BYTE).saturating_add(FEW);
    for group in metadata.row_groups() {
        let mut in_lists = 0_u64;
        for column in group.columns().iter().filter(is_wanted) {
            let count = u64::try_from(column.num_values().max(group.num_rows())).unwrap_or(0);
            numbers = numbers.saturating_add(count);
            if column.column_descr().max_rep_level() > 0 {
                in_lists = in_lists.saturating_add(count);
            }
            let (begin, length) = column.byte_range();
            bytes = bytes.checked_sub(length).ok_or("its columns are longer than the file")?;
            check_chunk(file, begin, length, column.num_values())
                .map_err(|reason| format!("`{}`: {reason}", column.column_path().string()))?;
        }
        if in_lists > MOST_IN_LISTS {
            return Err(format!(
                "a group of rows has more than {MOST_IN_LISTS} numbers in lists: write groups of fewer rows"
            ));
        }
        if group.num_rows() < 0 || numbers > most {
            return Err(format!("it holds more than {most} numbers"));
        }
        if numbers > believed {
            return Err(format!("it states {numbers} numbers, more than its bytes can hold"));
        }
    }
    Ok(())
}

/// Looks at the pages in so many bytes, which have so many values.
fn check_chunk(file: &Opened, mut at: u64, mut left: u64, mut values: i64) -> Result<(), String> {
    while left > 0 {
        let Ok(source) = file.get_read(at) else { return Ok(()) };
        let mut source = Compact::of(source, Length::len(file));
        let page = match page(&mut source) {
            Ok(page) => page,
            // The library will say so once it has read what precedes.
            Err(Unread::Broken) => return Ok(()),
            Err(Unread::Untrue) => return Err(format!("the page at byte {at} is damaged")),
        };
        let Page { kind, unpacked, packed, values: count } = page;
        let length = u64::try_from(packed).ok().and_then(|packed| packed.checked_add(source.read));
        let Some(length) = length.filter(|length| *length <= left) else { return Ok(()) };
        if packed.max(unpacked) > LONGEST_PAGE {
            return Err(format!("the page at byte {at} states a length of {} bytes", packed.max(unpacked)));
        }
        if kind == DICTIONARY && count > 8 * unpacked.max(0) {
            return Err(format!("the page at byte {at} states {count} values in {unpacked} bytes"));
        }
        if kind != DICTIONARY {
            values = values.saturating_sub(count.max(0));
        }
        if values < 0 {
            return Err(format!("at byte {at} there are more values than stated"));
        }
        at += length;
        left -= length;
    }
    Ok(())
}

/// The kind of a page with the values that others refer to.
const DICTIONARY: i64 = 2;

/// What stands before a page.
fn page<R: std::io::Read>(source: &mut Compact<R>) -> Result<Page, Unread> {
    let mut page = Page::default();
    source.fields(&mut |source, number, kind| {
        match (number, kind) {
            // Whole numbers of 32 bits, as the library takes them.
            (1, 5) => page.kind = whole(source)?,
            (2, 5) => page.unpacked = whole(source)?,
            (3, 5) => page.packed = whole(source)?,
            // Of each kind of page the first field is the number of values.
            (5 | 7 | 8, STRUCT) => source.fields(&mut |source, number, kind| match (number, kind) {
                (1, 5) => whole(source).map(|values| page.values = page.values.max(values)),
                _ => source.skip(kind),
            })?,
            _ => source.skip(kind)?,
        }
        Ok(())
    })?;
    Ok(page)
}

fn whole<R: std::io::Read>(source: &mut Compact<R>) -> Result<i64, Unread> {
    Ok(i64::from(source.whole()? as i32))
}
