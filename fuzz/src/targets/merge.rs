//! A part of a study, as `merge` reads it: the label on the first line, then the sums, whose hash and origin are put right, so that an input comes
//! further than the first check.

use super::{Scratch, reported};
use serde_json::Value;
use sha2::{Digest, Sha256};
use std::sync::OnceLock;
use switchback_study::consistency::Study;
use switchback_study::parts::{label, scenario_of};
use switchback_study::scenario::Scenario;

thread_local!(static FOLDER: Scratch = Scratch::new());

const SCENARIO: &str = "study = \"consistency\"\nquestion = \"?\"\nseed = 3\nreplicates = 40\n[system]\na = [-0.7]\nb = [0.3]\n\
    interval = [-1.0, 1.0]\n[[border]]\nname = \"spring\"\nkind = \"leaf_spring\"\nstiffness = 1.0\nfriction = 0.3\n[sweep]\n\
    noise = [0.1]\nsamples = [200]\npoints = [2]\nmethods = [\"efficient\"]\n";

/// Runs it on an input.
pub fn run(bytes: &[u8]) {
    let end = bytes.iter().position(|byte| *byte == b'\n').unwrap_or(bytes.len());
    let (first, rest) = bytes.split_at(end);
    FOLDER.with(|folder| {
        folder.write("part.json", first);
        if let Err(refusal) = label::<Value>(folder.path()).and_then(|_| scenario_of(folder.path())) {
            reported(&refusal);
        }
    });
    static SCENARIO_READ: OnceLock<Scenario> = OnceLock::new();
    let scenario = SCENARIO_READ.get_or_init(|| Scenario::parse("fuzz.toml", SCENARIO).expect("a scenario"));
    let study = Study::plan(scenario).expect("a study");
    let origin = study.origin("fuzz");
    let rest = rest.strip_prefix(b"\n").unwrap_or(rest);
    let end = rest.iter().position(|byte| *byte == b'\n').unwrap_or(rest.len());
    let mut sums = match serde_json::from_slice::<Value>(&rest[..end]) {
        Ok(Value::Object(mut head)) => {
            head.insert("origin".to_owned(), serde_json::to_value(&origin).expect("texts"));
            // The file begins with its schema.
            let schema = head.remove("schema").unwrap_or_default();
            let others = Value::Object(head).to_string();
            format!("{{\"schema\":{schema},{}", &others[1..]).into_bytes()
        }
        _ => rest[..end].to_vec(),
    };
    sums.extend_from_slice(&rest[end..]);
    let hash = Sha256::digest(&sums);
    sums.extend_from_slice(&hash);
    match study.begin().read(&sums, &origin) {
        Ok(state) => {
            let kept = state.snapshot().to_bytes(&origin);
            assert!(study.begin().read(&kept, &origin).is_ok(), "what was written is read");
            let _ = (state.missing(), state.replicates());
        }
        Err(why) => assert!(!why.to_string().is_empty()),
    }
}
