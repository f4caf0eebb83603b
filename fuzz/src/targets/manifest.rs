//! Rig files beside a good file of measurements: a rig, or refused in words; a rig that was read is written and read back as the same.

use super::{Scratch, reported, text_of};
use switchback_io::rig;

thread_local!(static FOLDER: Scratch = {
    let folder = Scratch::new();
    let rows: String = (0..100).map(|t| format!("{},{},{}\n", 0.01 * f64::from(t), t % 7, t % 5)).collect();
    folder.write("a.csv", format!("time [s],stroke [mm],force [N]\n{rows}").as_bytes());
    folder
});

/// Runs it on an input.
pub fn run(bytes: &[u8]) {
    if text_of(bytes).is_none() {
        return;
    }
    let path = FOLDER.with(|folder| folder.write("rig.toml", bytes));
    match rig::load(&path) {
        Ok(loaded) => {
            let again = rig::manifest(&loaded.plan, path.parent());
            assert!(again.contains("[[record]]"), "{again}");
        }
        Err(refusal) => reported(&refusal),
    }
}
