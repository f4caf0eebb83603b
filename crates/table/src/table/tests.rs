//! Headers of instruments, in small.

use super::{Kind, Table, TableError};
use std::fmt::Write as _;

/// The labels of a table that holds these lines above rows of two signals behind a time.
#[track_caller]
fn labels(head: &str, [delimiter, decimal]: [&str; 2]) -> Vec<String> {
    let mut text = format!("{head}\n");
    for k in 0..30 {
        let cells = [f64::from(k) * 0.01, f64::from(k % 7) * 1.25, f64::from(k % 5) * -0.5];
        let cells = cells.map(|cell| format!("{cell:.3}").replace('.', decimal));
        let _ = writeln!(text, "{}", cells.join(delimiter));
    }
    of(&text)
}

#[track_caller]
fn of(text: &str) -> Vec<String> {
    let table = read(text).unwrap_or_else(|error| panic!("{error}"));
    table.columns.iter().map(super::Column::label).collect()
}

fn read(text: &str) -> Result<Table, String> {
    Table::parse(text, 2).map_err(|error| match error {
        TableError::Data(error) => error.to_string(),
        TableError::File(error) => error.to_string(),
    })
}

const SEMICOLONS: [&str; 2] = [";", ","];

#[test]
fn a_row_of_units_may_hold_words_that_nobody_knows() {
    for (units, labelled) in [
        ("Sec;kN;strokes", "load [strokes]"),
        ("s;km/h;deg C", "load [deg C]"),
        ("s;N/(m/s);℃", "load [℃]"),
        ("s;mm;Wert", "load"),
        ("(s);(in);(lbf)", "load [lbf]"),
        ("in s;in mm;in kN", "load [kN]"),
        ("s;1/min;kNm", "load [kNm]"),
    ] {
        let found = labels(&format!("clock;speed;load\n{units}"), SEMICOLONS);
        assert!(found[0].starts_with("clock [") && found[2] == labelled, "{units}: {found:?}");
    }
    assert_eq!(labels("[s];[mm];[U/min]\nt;s;n", SEMICOLONS), ["t [s]", "s [mm]", "n [U/min]"]);
    assert_eq!(labels("t;V;A\ns;V;A", SEMICOLONS), ["t [s]", "V [V]", "A [A]"]);
}

#[test]
fn lines_that_say_nothing_lie_between_names_and_rows() {
    let wanted = ["clock [s]", "stroke [mm]", "load [N]"];
    for between in [
        "raw;raw;raw",
        "T0 = 1;T0 = 1;T0 = 1\ndt = 5 ms;dt = 5 ms;dt = 5 ms\nraw;raw;raw",
        "f8;f8;f4",
        "REAL64;REAL64;INT16\n[data]",
        "\n***End of header***\n",
        "-----;-----;-----",
        "values;;",
        "---;:---:;---:",
        "Range;500;1000\nOffset;0,5;0",
    ] {
        assert_eq!(
            labels(&format!("a;b\nclock;stroke;load\ns;mm;N\n{between}"), SEMICOLONS),
            wanted,
            "{between}"
        );
    }
    let marked = "[names]\nclock stroke load\n\n[units]\ns mm N\n[data]";
    assert_eq!(labels(marked, [" ", "."]), wanted);
    let list = "[header]\nclock s\nstroke mm\nload N\n[column names]\nclock stroke load\n\n[data]";
    assert_eq!(labels(list, [" ", "."]), wanted);
}

#[test]
fn a_column_may_have_no_name() {
    let rows: String = (0..30).map(|k| format!("{k},{k}.5\n")).collect();
    assert_eq!(of(&format!(",load [N]\n{rows}")), ["", "load [N]"]);
    let listing = |stamp: fn(i32) -> String| {
        let rows: String = (0..30).map(|k| format!("{},{k}.5,{k}.25\n", stamp(k))).collect();
        read(&format!(",set,act\n{rows}")).unwrap().listing()
    };
    let since = |k: i32| format!("0 days 00:00:{:02}.005000", k);
    assert_eq!(listing(since), "1 without a name, times, 2 `set`, 3 `act`");
    assert_eq!(listing(|k| format!("row{k}")), "1 without a name, text, 2 `set`, 3 `act`");
}

#[test]
fn a_comment_may_name_the_columns_with_delimiters_of_its_own() {
    let wanted = ["clock", "stroke", "load"];
    for head in ["# clock  stroke  load", "# clock, stroke, load", "clock\tstroke\tload"] {
        assert_eq!(labels(head, SEMICOLONS), wanted, "{head}");
    }
    let keyed = "# name: clock  name: stroke  name: load\n# unit: s  unit: mm  unit: N";
    assert_eq!(labels(keyed, SEMICOLONS), ["clock [s]", "stroke [mm]", "load [N]"]);
}

#[test]
fn keys_stand_before_names_and_units() {
    let wanted = ["clock [s]", "stroke [mm]", "load [N]"];
    for head in [
        "Y_Unit_Label;mm;N;\nX_Unit;s\nclock;stroke;load",
        "Vertical Units;mm;N\nHorizontal Units;s\nScale;2;5\nclock;stroke;load",
        "# NAME0 = clock [s]\n# NAME1 = stroke [mm]\n# NAME2 = load [N]\n# END",
        "; Channel 1: clock [s]\n; Channel 2: stroke [mm]\n; Channel 3: load [N]\n; ---",
    ] {
        assert_eq!(labels(head, SEMICOLONS), wanted, "{head}");
    }
    let found = labels("Model;X\nTraceName;stroke;load\nGain;1;2\nVUnit;mm;N\nDate;2023;2023", SEMICOLONS);
    assert_eq!(found[1..], wanted[1..]);
    let pairs = |sample_time: &str| {
        let rows: String = (0..30).map(|k| format!("{};{k},5;{};{k},25\n", 2 * k, 2 * k)).collect();
        of(&format!(
            "Name;Scope\nName;set;Name;act\nSampleTime[ms];{sample_time};SampleTime[ms];{sample_time}\nUnit;mm;Unit;N\n\n{rows}"
        ))
    };
    assert_eq!(pairs("2"), ["time of set [ms]", "set [mm]", "time of act [ms]", "act [N]"]);
    assert_eq!(pairs("5")[0], "time of set", "the rows say another unit");
}

#[test]
fn of_keys_and_values_those_behind_a_key_for_names_are_names() {
    let head = |above: &str, end: &str| {
        let lines = format!(
            "{above}\nSampleTime[ms];2;SampleTime[ms];2\nSymbolName;axis.set;SymbolName;axis.act\nPort;851;Port;851\nBitMask;0xff;BitMask;0xff\nUnit;mm;Unit;%"
        );
        let lines: String = lines.lines().map(|line| format!("{line}{end}\n")).collect();
        let rows: String = (0..30).map(|k| format!("{};{k},5;{};{k},25{end}\n", 2 * k, 2 * k)).collect();
        of(&format!("File;scope\n\n{lines}\n{rows}"))
    };
    for end in ["", ";"] {
        assert_eq!(
            head("Name;set;Name;act", end),
            ["time of set [ms]", "set [mm]", "time of act [ms]", "act [%]"]
        );
        for above in ["Name;signal;Name;signal", "Comment;;Comment;"] {
            assert_eq!(head(above, end)[1], "axis.set [mm]", "{above}");
        }
    }
}

#[test]
fn units_may_stand_one_a_line() {
    let wanted = ["clock", "stroke [mm]", "load [N]"];
    let sections = "[header]\nclock\nstroke\nload\n\n[channel units]\nmm\nN\n\n[column names]\nclock stroke load\n\n[data]";
    assert_eq!(labels(sections, [" ", "."]), wanted);
    let counted =
        "# NAME0 = clock\n# NAME1 = stroke\n# NAME2 = load\n#\n# DISP_UNIT1 = mm\n# DISP_UNIT2 = N\n# END";
    assert_eq!(labels(counted, ["\t", "."]), wanted);
}

#[test]
fn quotation_marks_within_names_are_theirs() {
    let wanted = ["t", "\"A1\".set", "\"A1\".act"];
    assert_eq!(labels("t;\"A1\".set;\"A1\".act", SEMICOLONS), wanted);
    assert_eq!(labels("\"t\";\"\"\"A1\"\".set\";\"\"\"A1\"\".act\"", SEMICOLONS), wanted);
    let lines = "\"clock\n[s]\";\"stroke\n[mm]\";\"load\n[N]\"";
    assert_eq!(labels(lines, SEMICOLONS), ["clock [s]", "stroke [mm]", "load [N]"]);
}

#[test]
fn units_behind_numbers_are_the_column_s() {
    let rows = |cell: fn(i32) -> String| {
        (0..30).map(|k| format!("{} sec,{}\n", f64::from(k) * 0.01, cell(k))).collect::<String>()
    };
    let text = format!("clock,load\n{}", rows(|k| format!("{k}.5%")));
    let table = read(&text).unwrap();
    assert_eq!(table.listing(), "1 `clock [sec]`, 2 `load [%]`");
    assert_eq!((table.columns[0].values[3], table.columns[1].values[3]), (0.03, 3.5));
    // In another unit, or in none.
    for odd in ["1.2 kN", "7"] {
        let text = format!("clock,load\n{}9,{odd}\n", rows(|k| format!("{k}.5 N")));
        let table = read(&text).unwrap();
        let load = &table.columns[1];
        assert_eq!((load.fault_count, load.faults[0].cell.as_str()), (1, odd));
        assert!(load.has_other_unit(odd), "{odd}");
    }
    let zero = format!("clock,load\n{}9,0\n", rows(|k| format!("{k}.5 N")));
    assert_eq!(read(&zero).unwrap().columns[1].fault_count, 0, "zero is zero in all units");
    let names = format!("clock,load,name\n{}9 sec,8,chirp\n", rows(|k| format!("{k}.5,12Hz")));
    assert_eq!(read(&names).unwrap().listing(), "1 `clock [sec]`, 2 `load`, 3 `name`, text");
    let named = format!("clock,load [kN]\n{}", rows(|k| format!("{k}.5 N")));
    assert_eq!(read(&named).unwrap().columns[1].fault_count, 30, "the header says another unit");
}

#[test]
fn names_may_stand_before_every_value() {
    let rows = |row: &dyn Fn(i32, String) -> String| {
        let clock = |k: i32| format!("14:23:{:02}.{:03}", 45 + k / 50, k % 50 * 20);
        (0..60).map(|k| row(k, clock(k)) + "\n").collect::<String>()
    };
    let table = read(&rows(&|k, clock| format!("{clock} -> set:{k},act:-{k}.5"))).unwrap();
    assert_eq!(table.listing(), "1 `time`, times, 2 `set`, 3 `act`");
    assert!((table.columns[0].values[59] - 1.18).abs() < 1e-9 && table.columns[2].values[2] == -2.5);
    let table = read(&("boot\n".to_owned() + &rows(&|k, clock| format!("[{clock}] {k}\t{k}.5")))).unwrap();
    assert_eq!((table.columns.len(), table.columns[0].kind), (3, Kind::Stamp));
    assert_eq!(of(&rows(&|k, _| format!("set={k} act={k}.5"))), ["set", "act"]);
    assert_eq!(of(&rows(&|k, _| format!("{{\"set [mm]\": {k}, \"act\": {k}.5}}"))), ["set [mm]", "act"]);
    let headed = format!("14:23:44.9 -> set,act\n{}", rows(&|k, clock| format!("{clock} -> {k},{k}.5")));
    assert_eq!(of(&headed), ["time", "set", "act"]);
    // In another order, with one left out, and with another name.
    let mut text = rows(&|k, _| format!("set={k} act={k}.5 more={k}"));
    text += "act=7 more=1 set=8\nset=9 more=1\n";
    let table = read(&text).unwrap();
    let last = |column: usize| table.columns[column].values[60..].to_vec();
    assert_eq!((last(0), last(1)[0]), (vec![8.0, 9.0], 7.0));
    assert!(table.columns[1].values[61].is_nan() && table.faults.is_empty());
    let table = read(&(text + "set=9 other=1 act=2\nset=9 act=2 more=3\n")).unwrap();
    assert_eq!(table.faults.len(), 1, "a name that the first row has not");
}

#[test]
fn a_text_without_a_table_shows_its_first_line() {
    let error = read("Dear reader,\nsee page 12 of it.\n").unwrap_err();
    assert!(error.ends_with("; line 2 is `see page 12 of it.`"), "{error}");
}

#[test]
fn settings_of_the_channels_above_the_rows_are_no_rows() {
    let rows: String = (0..30).map(|k| format!("{},{k}.5,{},{k}.25\n", 2 * k, 2 * k)).collect();
    let pairs = "Name,a,Name,b\nPort,501,Port,501\nOffset,0,Offset,1\nScaleFactor,1,ScaleFactor,1\n\n";
    let rows_of = |text: &str| read(text).map(|table| table.places.len());
    assert_eq!(rows_of(&format!("{pairs}{rows}")), Ok(30));
    let keyed = format!("t,a,u,b\nPort,501,502,503\nSlot,1,2,3\n\n{rows}");
    assert_eq!(rows_of(&keyed), Ok(30));
    assert_eq!(of(&keyed), ["t", "a", "u", "b"]);
    // A first row with an odd cell is a row.
    let odd = format!("t,a,u,b\n0,ERR,0,1\n{rows}");
    assert_eq!(rows_of(&odd), Ok(31));
    let odd = format!("t,a,u,b\n{rows}60,ERR,60,1\n{rows}");
    assert_eq!(rows_of(&odd), Ok(61));
}
