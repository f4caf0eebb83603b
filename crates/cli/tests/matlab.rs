//! The same record in MATLAB's two file formats.
#![cfg(feature = "matlab")]

use crate::common::bench_data::{Bench, rows, truth};
use hdf5_pure::FileBuilder;
use switchback_io::rig::Loaded;

#[track_caller]
fn is_the_record(loaded: &Loaded, labels: [&str; 2]) {
    let rig = &loaded.rig;
    let (v, y) = truth();
    let v_read: Vec<f64> = rig.records.iter().flat_map(|record| record.record.v().to_vec()).collect();
    let y_read: Vec<f64> = rig.records.iter().flat_map(|record| record.record.y().to_vec()).collect();
    assert_eq!((v_read, y_read), (v, y));
    assert_eq!(rig.sample_time, 0.01);
    assert_eq!([rig.input_label.as_str(), rig.output_label.as_str()], labels);
}

fn time() -> Vec<f64> {
    rows().map(|(t, _, _)| t).collect()
}

/// A tagged element of format v5, padded to whole eights.
fn element(kind: u32, contents: &[u8]) -> Vec<u8> {
    let mut bytes = kind.to_le_bytes().to_vec();
    bytes.extend((contents.len() as u32).to_le_bytes());
    bytes.extend(contents);
    bytes.resize(bytes.len().next_multiple_of(8), 0);
    bytes
}

/// A matrix of doubles, column by column.
fn matrix(name: &str, size: [u32; 2], values: &[f64]) -> Vec<u8> {
    let double = [6_u32.to_le_bytes(), [0; 4]].concat();
    let size: Vec<u8> = size.iter().flat_map(|n| n.to_le_bytes()).collect();
    let values: Vec<u8> = values.iter().flat_map(|x| x.to_le_bytes()).collect();
    element(
        14,
        &[element(6, &double), element(5, &size), element(1, name.as_bytes()), element(9, &values)].concat(),
    )
}

fn version_5(matrices: &[Vec<u8>]) -> Vec<u8> {
    let mut header = b"MATLAB 5.0 MAT-file".to_vec();
    header.resize(116, b' ');
    header.resize(124, 0);
    header.extend([0x00, 0x01, b'I', b'M']);
    [header, matrices.concat()].concat()
}

#[test]
fn version_5_vectors() {
    let (v, y) = truth();
    let n = v.len() as u32;
    let file = version_5(&[
        matrix("gain", [1, 1], &[3.0]),
        matrix("time_s", [n, 1], &time()),
        matrix("travel_mm", [n, 1], &v),
        matrix("force_N", [1, n], &y),
    ]);
    let loaded = Bench::new().with("bench.mat", file).load(&["bench.mat"]).expect("a good file");
    is_the_record(&loaded, ["travel [mm]", "force [N]"]);
    assert!(loaded.reported.notes[0].contains("left out: gain"), "{}", loaded.reported);
}

#[test]
fn a_version_5_matrix_whose_columns_are_numbered() {
    let (v, y) = truth();
    let file = version_5(&[matrix("data", [v.len() as u32, 3], &[time(), v, y].concat())]);
    let bench = Bench::new().with("bench.mat", file);
    let flags = ["bench.mat", "--time", "1", "--input", "data 2", "--output", "data 3"];
    is_the_record(&bench.load(&flags).expect("a good file"), ["data 2", "data 3"]);
    let tried = bench.load(&["bench.mat"]).expect("a good file");
    is_the_record(&tried, ["data 2", "data 3"]);
    assert!(tried.reported.to_string().contains("no name says which column is the input"));
}

#[test]
fn version_7_3_with_the_fields_of_a_struct() {
    let (v, y) = truth();
    let n = v.len() as u64;
    let mut file = FileBuilder::new();
    file.create_dataset("time").with_f64_data(&time()).with_shape(&[1, n]);
    let mut bench = file.create_group("bench");
    bench.create_dataset("travel").with_f64_data(&v).with_shape(&[1, n]);
    bench.create_dataset("force").with_f64_data(&y).with_shape(&[n, 1]);
    file.add_group(bench.finish());
    let bytes = file.finish().expect("a file");
    let loaded = Bench::new().with("bench.mat", bytes).load(&["bench.mat"]).expect("a good file");
    is_the_record(&loaded, ["bench.travel", "bench.force"]);
}

#[test]
fn a_file_that_is_none_is_reported() {
    let bench = Bench::new().with("bench.mat", "t,v,y\n0,1,2\n");
    assert!(bench.refusal(&["bench.mat"]).contains("bench.mat: the file cannot be read as MATLAB data"));
    let lonely = Bench::new().with("bench.mat", version_5(&[matrix("v", [3, 1], &[1.0, 2.0, 3.0])]));
    assert!(lonely.refusal(&["bench.mat"]).contains("no two numeric vectors of the same length"));
}

#[test]
fn sizes_that_contradict_the_contents_are_reported() {
    let negative = |n: i32| n as u32;
    let refused = |size: [u32; 2], values: &[f64]| {
        let file = version_5(&[matrix("v", size, values), matrix("y", [3, 1], &[1.0, 2.0, 3.0])]);
        Bench::new().with("bench.mat", file).refusal(&["bench.mat"])
    };
    // Their product is that of the contents, or overflows.
    let reported = refused([negative(-2), negative(-3)], &[0.0; 6]);
    assert!(reported.contains("`v` is said to have"), "{reported}");
    for size in [[3, 1 << 30], [1 << 16, 1 << 16], [negative(-1), 3]] {
        let reported = refused(size, &[0.0; 3]);
        assert!(
            reported.contains("cannot be read as MATLAB data") || reported.contains("is said to have"),
            "{reported}"
        );
    }
    // Two thousand million empty columns are no column.
    let reported = refused([0, i32::MAX as u32], &[]);
    assert!(reported.contains("no two numeric vectors of the same length"), "{reported}");
}
