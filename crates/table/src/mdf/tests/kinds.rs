use super::writer::{Field, Group, Writer};
use super::{clock, has_note, table, values};
use crate::tests::File;

/// Bytes of a record: seconds, and a byte that counts on.
const BYTES: u32 = 9;

fn counted(rows: u8) -> Vec<u8> {
    (0..rows).flat_map(|k| [&(0.01 * f64::from(k)).to_le_bytes()[..], &[k]].concat()).collect()
}

fn byte(name: &'static str) -> Field<'static> {
    Field { name, byte: 8, bits: 8, ..Field::default() }
}

/// A log of one group, of ten records unless others are given.
fn single(
    writer: Writer,
    fields: &[Field<'_>],
    (bytes, flags): ([u32; 2], u16),
    records: &[u8],
) -> Result<crate::table::Table, String> {
    let mut writer = writer;
    let channels = writer.channels(fields);
    let group = writer.group(0, channels, Group { bytes, flags, ..Group::default() });
    let records = writer.block("DT", &[], records);
    let data = writer.data(0, group, records, 0);
    table(&writer.finish(data))
}

/// The byte that counts on, converted.
fn converted(convert: impl Fn(&mut Writer) -> u64) -> Result<Vec<f64>, String> {
    let mut writer = Writer::new("MDF", "4.10");
    let conversion = convert(&mut writer);
    let fields = [clock(0, 4), Field { conversion, ..byte("x") }, byte("raw")];
    let read = single(writer, &fields, ([BYTES, 0], 0), &counted(10))?;
    match read.columns.iter().find(|column| column.name == "x") {
        Some(column) => Ok(column.values.clone()),
        None => Err(read.notes.join("; ")),
    }
}

#[test]
fn conversions_that_give_numbers_are_applied() {
    let of =
        |kind, values: &'static [f64]| converted(move |w| w.conversion(kind, &[], values)).expect("numbers");
    let nan = f64::NAN;
    let is = |found: &[f64], wanted: [f64; 5]| {
        let same = found.iter().zip(wanted).all(|(a, b)| (a - b).abs() < 1e-12 || a.is_nan() && b.is_nan());
        assert!(same, "{found:?} {wanted:?}");
    };
    is(&of(0, &[]), [0.0, 1.0, 2.0, 3.0, 4.0]);
    is(&of(1, &[-2.0, 0.5]), [-2.0, -1.5, -1.0, -0.5, 0.0]);
    is(&of(2, &[0.0, 1.0, 0.0, 0.0, 0.0, 2.0]), [0.0, 0.5, 1.0, 1.5, 2.0]);
    is(&of(2, &[0.0, 0.0, 12.0, 0.0, 1.0, 0.0]), [nan, 12.0, 6.0, 4.0, 3.0]);
    is(&of(4, &[1.0, 10.0, 3.0, 20.0]), [10.0, 10.0, 15.0, 20.0, 20.0]);
    is(&of(5, &[1.0, 10.0, 3.0, 20.0]), [10.0, 10.0, 10.0, 20.0, 20.0]);
    is(&of(6, &[0.0, 1.0, 7.0, 3.0, 3.0, 8.0, -1.0]), [7.0, 7.0, -1.0, 8.0, -1.0]);
    // Words for all numbers leave them as they are; where the others are converted they are missing.
    is(
        &converted(|w| {
            let n = w.text("neutral");
            w.conversion(7, &[n, 0], &[0.0])
        })
        .expect("numbers"),
        [0.0, 1.0, 2.0, 3.0, 4.0],
    );
    let with_words = |kind, keys: &'static [f64]| {
        converted(move |w| {
            let (missing, tenths) = (w.text("not available"), w.conversion(1, &[], &[0.0, 0.1]));
            w.conversion(kind, &[missing, tenths], keys)
        })
    };
    is(&with_words(7, &[2.0]).expect("numbers"), [0.0, 0.1, nan, 0.3, 0.4]);
    is(&with_words(8, &[1.0, 2.0]).expect("numbers"), [0.0, nan, nan, 0.3, 0.4]);
}

#[test]
fn conversions_that_give_none_leave_the_channel_out() {
    let formula = converted(|w| {
        let text = w.text("2*X");
        w.conversion(3, &[text], &[])
    });
    assert!(formula.expect_err("a formula").contains("channels left out: 1 of formulas"));
    let within = converted(|w| {
        let (word, text) = (w.text("off"), w.text("2*X"));
        let formula = w.conversion(3, &[text], &[]);
        w.conversion(7, &[word, formula], &[0.0])
    });
    assert!(within.expect_err("a formula").contains("1 of formulas"));
    for (kind, values) in [(1, &[1.0][..]), (2, &[1.0; 5]), (4, &[1.0]), (9, &[]), (200, &[1.0])] {
        let error = converted(move |w| w.conversion(kind, &[], values)).expect_err("no numbers");
        assert!(error.contains("1 of what cannot be read"), "{kind}: {error}");
    }
}

#[test]
fn values_that_are_not_valid_are_missing() {
    let flagged = Field { flags: 2, validity: 3, ..byte("x") };
    let fields = [clock(0, 4), flagged, Field { flags: 1, ..byte("never") }];
    let records: Vec<u8> =
        counted(10).chunks(9).flat_map(|r| [r, &[if r[8] == 4 { 8 } else { 7 }]].concat()).collect();
    let read = single(Writer::new("MDF", "4.10"), &fields, ([BYTES, 1], 0), &records).expect("a log");
    let missing: Vec<usize> = (0..10).filter(|k| values(&read, "x")[*k].is_nan()).collect();
    assert_eq!((missing, values(&read, "never").iter().all(|x| x.is_nan())), (vec![4], true));
}

#[test]
fn a_clock_may_follow_from_the_number_of_the_record_or_be_missing() {
    let mut writer = Writer::new("MDF", "4.10");
    let conversion = writer.conversion(1, &[], &[5.0, 0.25]);
    let fields = [Field { name: "t", conversion, kinds: [3, 1, 0], ..Field::default() }, byte("x")];
    let read = single(writer, &fields, ([BYTES, 0], 0), &counted(10)).expect("a log");
    assert_eq!((values(&read, "time")[3], values(&read, "x")[3]), (5.75, 3.0));
    // By angle.
    let fields = [Field { name: "phi", kinds: [2, 2, 4], bits: 64, ..Field::default() }, byte("x")];
    let read = single(Writer::new("MDF", "4.10"), &fields, ([BYTES, 0], 0), &counted(10)).expect("a log");
    assert_eq!(read.columns.iter().map(|column| column.name.as_str()).collect::<Vec<_>>(), ["phi", "x"]);
}

#[test]
fn structures_are_read_and_arrays_left_out() {
    let mut writer = Writer::new("MDF", "4.10");
    let parts = writer.channels(&[byte("a"), byte("b")]);
    let array = writer.block("CA", &[0], &[0; 16]);
    let whole = Field { name: "s", kinds: [0, 0, 10], bits: 72, composition: parts, ..Field::default() };
    let fields = [clock(0, 4), whole, Field { composition: array, ..byte("many") }, byte("x")];
    let read = single(writer, &fields, ([BYTES, 0], 0), &counted(10)).expect("a log");
    assert_eq!(
        read.columns.iter().map(|column| column.name.as_str()).collect::<Vec<_>>(),
        ["time", "a", "b", "x"]
    );
    has_note(&read, "1 of words or bytes, 1 of arrays");
}

#[test]
fn records_of_several_groups_may_stand_among_each_other() {
    let mut writer = Writer::new("MDF", "4.10");
    let first = writer.channels(&[clock(0, 4), byte("x")]);
    let second = writer.channels(&[clock(0, 4), byte("x"), Field { bits: 8, byte: 8, ..byte("x") }]);
    let of = |id, name| Group { name, id, bytes: [BYTES, 0], ..Group::default() };
    let texts = writer.group(0, 0, Group { id: 7, flags: 1, ..Group::default() });
    let second = writer.group(texts, second, of(2, ""));
    let first = writer.group(second, first, of(1, "bus"));
    let records: Vec<u8> = counted(100)
        .chunks(9)
        .enumerate()
        .flat_map(|(k, record)| {
            let text = [&[7, 0], &3_u32.to_le_bytes()[..], b"abc"].concat();
            [&[1 + u8::from(k % 3 == 0), 0], record, &text].concat()
        })
        .collect();
    let records = writer.records(&records, super::Packing::None, 11);
    let data = writer.data(0, first, records, 2);
    let read = table(&writer.finish(data)).expect("a log");
    let names: Vec<String> = read.columns.iter().map(crate::table::Column::label).collect();
    assert_eq!(names, ["bus time [s]", "bus.x", "group 2 time [s]", "group 2.x", "group 2.x 2"]);
    assert_eq!(values(&read, "bus.x")[..4], [1.0, 2.0, 4.0, 5.0]);
    assert_eq!(values(&read, "group 2.x")[..3], [0.0, 3.0, 6.0]);
    assert!(values(&read, "group 2.x")[34..].iter().all(|x| x.is_nan()));
}

#[test]
fn data_by_columns_and_other_compressions_are_refused_in_words() {
    for (id, data, said) in [
        ("DV", vec![0; 90], "data are stored by columns"),
        ("LD", vec![0; 16], "data are stored by columns"),
        ("DZ", [b"DT\x02\0", &[0; 20][..]].concat(), "has the number 2"),
        ("SD", vec![0; 8], "there is no block of records"),
    ] {
        let mut writer = Writer::new("MDF", "4.20");
        let channels = writer.channels(&[clock(0, 4), byte("x")]);
        let group = writer.group(0, channels, Group { bytes: [BYTES, 0], ..Group::default() });
        let records = writer.block(id, &[], &data);
        let data = writer.data(0, group, records, 0);
        let error = table(&writer.finish(data)).expect_err("nothing is left");
        assert!(error.contains(said) && error.contains("`group 1` left out"), "{error}");
    }
}

#[test]
fn words_in_place_of_numbers_are_reported() {
    let mut writer = Writer::new("MDF", "4.10");
    let (missing, tenths) = (writer.text("not available"), writer.conversion(1, &[], &[0.0, 0.1]));
    let conversion = writer.conversion(7, &[missing, tenths], &[2.0]);
    let channels = writer.channels(&[clock(0, 4), Field { conversion, ..byte("cmd") }, byte("state")]);
    let group = writer.group(0, channels, Group { bytes: [BYTES, 0], ..Group::default() });
    let records = writer.block("DT", &[], &counted(100));
    let data = writer.data(0, group, records, 0);
    let file = File::of("words.mf4", &writer.finish(data));
    let measured = file.measured([None, None]).expect("a good log");
    has_note(&measured.table, "`cmd` is missing where the log has a word in place of the number");
    assert!(measured.v.contains(&0.1) && !measured.v.contains(&0.2));
}

#[test]
fn of_several_groups_those_without_a_clock_are_left_out() {
    let mut writer = Writer::new("MDF", "4.10");
    let group = Group { name: "with", bytes: [BYTES, 0], ..Group::default() };
    let channels = writer.channels(&[clock(0, 4), byte("x")]);
    let with = writer.group(0, channels, group);
    let channels = writer.channels(&[byte("y")]);
    let without = writer.group(0, channels, Group { name: "without", ..group });
    let [first, second] = [(); 2].map(|()| writer.block("DT", &[], &counted(10)));
    let data = writer.data(0, with, first, 0);
    let data = writer.data(data, without, second, 0);
    let read = table(&writer.finish(data)).expect("a log");
    assert_eq!(
        read.columns.iter().map(|column| column.name.as_str()).collect::<Vec<_>>(),
        ["with time", "x"]
    );
    has_note(&read, "groups without a clock left out: without");
}
