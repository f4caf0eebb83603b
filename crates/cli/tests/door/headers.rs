//! Names over units, comments, headers that come again.

use super::*;

#[test]
fn the_line_with_most_names_is_the_header() {
    for head in [
        "time,travel,force\ns,mm,N",
        "s,mm,N\ntime,travel,force",
        "x-axis,travel,force\nsecond,millimeter,Newton",
        "time,travel,force\ns,mm,N\nraw,raw,raw",
        "0,1,2",
        "# time  travel  force",
        "# name: time  name: travel  name: force\n# unit: s  unit: mm  unit: N",
    ] {
        let loaded = is_the_record(format!("{head}\n{}", lines(",", point)[0..].join("\n")), &[], "");
        let is_named = loaded.rig.input_label.contains("travel") || head == "0,1,2";
        assert!(is_named, "{head}: {}", loaded.rig.input_label);
    }
}

#[test]
fn short_rows_and_commas_to_spare_are_empty_cells() {
    is_the_record(
        table("time,travel,force,Comment", |k, t, v, y| {
            if k == 0 { format!("{t},{v},{y},begin") } else { format!("{t},{v},{y}") }
        }),
        &[],
        "have fewer than 4 cells",
    );
    let preamble = format!("Range;10;20;30;40\n{}", lines(";", point).join("\n"));
    is_the_record(preamble, &[], "line 1 above the table left out");
    is_the_record(table("time,travel,force,", |_, t, v, y| format!("{t},{v},{y},")), &[], "");
    is_the_record(table("time,travel,force", |_, t, v, y| format!("{t},{v},{y},")), &[], "");
    is_the_record(table("time,travel,force,", |_, t, v, y| format!("{t},{v},{y}")), &[], "");
}

#[test]
fn a_header_that_comes_again_is_no_row() {
    let again = |k: usize| if k > 0 && k.is_multiple_of(50) { "time,travel,force\n" } else { "" };
    let text = table("time,travel,force", |k, t, v, y| format!("{}{t},{v},{y}", again(k)));
    is_the_record(text, &[], "the header again at 11 lines, the first of them 52");
    let without_time = table("travel,force", |k, _, v, y| {
        format!("{}{v},{y}", if k == 300 { "travel,force\n" } else { "" })
    });
    let loaded = load(without_time, &["--rate", "100"]);
    assert_eq!(loaded.rig.records[0].record.len(), 300, "a record begins: {}", loaded.reported);
}

#[test]
fn instruments_state_the_sample_time_above_the_table() {
    let rigol = format!(
        "X,CH1,CH2,Start,Increment,\nSequence,VOLT,VOLT,-1.2e+01,1.0e-02\n{}",
        rows().enumerate().fold(String::new(), |mut text, (k, (_, v, y))| {
            let _ = writeln!(text, "{k},{v},{y},,");
            text
        })
    );
    is_the_record(rigol, &[], "0.01 s (100 Hz), as stated above the table");
    for line in ["Sample rate;100", "Abtastzeit [ms];10", "Sampling frequency: 0.1 kHz"] {
        let text = format!("Bench 4\n{line}\n{}", table("travel;force", |_, _, v, y| format!("{v};{y}")));
        is_the_record(text, &[], "as stated above the table");
    }
}

#[test]
fn a_measurement_file_of_labview_is_read() {
    let text = format!(
        "LabVIEW Measurement\t\nWriter_Version\t2\nSeparator\tTab\nDecimal_Separator\t.\n***End_of_Header***\t\n\t\t\t\nChannels\t2\t\t\nDelta_X\t0.01\t0.01\t\n***End_of_Header***\t\t\t\n{}",
        table("X_Value\tTravel\tForce\tComment", |_, t, v, y| format!("{t}\t{v}\t{y}"))
    );
    is_the_record(text, &[], "tabs between columns");
}
