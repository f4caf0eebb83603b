//! What the program wrote and reads again: results of studies, and models, which must run once they were read.

use super::{Scratch, reported, text_of};
use switchback_io::model;
use switchback_study::results;

thread_local!(static FOLDER: Scratch = Scratch::new());

/// Runs it on an input.
pub fn run(bytes: &[u8]) {
    if text_of(bytes).is_none() {
        return;
    }
    let path = FOLDER.with(|folder| folder.write("fuzz.json", bytes));
    match results::read(&path) {
        Ok(read) => {
            let again = results::to_json(&read);
            let path = FOLDER.with(|folder| folder.write("again.json", again.as_bytes()));
            assert_eq!(results::read(&path).expect("what was written is read").cells.len(), read.cells.len());
        }
        Err(refusal) => reported(&refusal),
    }
    match model::read(&path) {
        Ok(file) => {
            let v: Vec<f64> = (0..50).map(|t| f64::from((7 * t) % 11) - 5.0).collect();
            if let Some(run) = file.run(&v, None) {
                assert_eq!(run.y.len(), v.len());
            }
            let path = FOLDER.with(|folder| folder.write("again.json", file.text().as_bytes()));
            model::read(&path).expect("what was written is read");
        }
        Err(refusal) => reported(&refusal),
    }
}
