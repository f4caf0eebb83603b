//! The fuzz targets without a fuzzer: their corpus, and thousands of inputs made from it by a fixed seed, through the same functions.
//!
//! `SWITCHBACK_FUZZ=SECONDS` goes on for that long on each target, with seeds that nobody has seen before.

#[allow(unreachable_pub, reason = "it is a library elsewhere")]
#[path = "../../../fuzz/src/lib.rs"]
mod targets;

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use std::fs;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::path::Path;
use std::time::{Duration, Instant, SystemTime};

/// Longest input.
const MOST: usize = 1 << 16;

/// An input may not take longer, with a machine that does ten other things.
const PATIENCE: Duration = Duration::from_secs(60);

/// Runs a target on its corpus and on so many inputs made from it.
fn fuzz(name: &str, target: fn(&[u8]), inputs: u64) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fuzz/corpus").join(name);
    let entries = fs::read_dir(folder).expect("a corpus").flatten();
    let mut corpus: Vec<Vec<u8>> = entries.map(|entry| fs::read(entry.path()).expect("a file")).collect();
    // The order in which a system lists its files is its own.
    corpus.sort();
    assert!(!corpus.is_empty());
    corpus.iter().for_each(|input| check(name, target, input));
    let more = std::env::var("SWITCHBACK_FUZZ").ok().map(|seconds| seconds.parse().expect("seconds"));
    let (seed, until) = match more {
        None => (2026, None),
        Some(seconds) => (now(), Some(Instant::now() + Duration::from_secs(seconds))),
    };
    let mut mutator = Mutator { random: ChaCha8Rng::seed_from_u64(seed), corpus };
    let mut made = 0;
    while until.map_or(made < inputs, |until| Instant::now() < until) {
        check(name, target, &mutator.input());
        made += 1;
    }
    if until.is_some() {
        eprintln!("{name}: {made} inputs from seed {seed}");
    }
}

fn now() -> u64 {
    SystemTime::now().duration_since(SystemTime::UNIX_EPOCH).expect("after 1970").as_nanos() as u64
}

/// Runs a target on an input, which is kept where it breaks it.
fn check(name: &str, target: fn(&[u8]), input: &[u8]) {
    let begun = Instant::now();
    let ended = catch_unwind(AssertUnwindSafe(|| target(input)));
    let is_slow = begun.elapsed() > PATIENCE;
    if ended.is_err() || is_slow {
        let place = std::env::temp_dir().join(format!("switchback-fuzz-{name}"));
        fs::write(&place, input).expect("a writable temporary folder");
        eprintln!("{name}: broken by {}, {:?}", place.display(), begun.elapsed());
    }
    if let Err(panic) = ended {
        resume_unwind(panic);
    }
    assert!(!is_slow, "{name}: an input takes more than {PATIENCE:?}");
}

/// Makes inputs from those of a corpus, as fuzzers do that see no coverage.
struct Mutator {
    random: ChaCha8Rng,
    corpus: Vec<Vec<u8>>,
}

/// What files of numbers break on.
const TOKENS: [&str; 26] = [
    "0",
    "-1",
    "1e308",
    "-1e308",
    "1e-308",
    "1e999",
    "nan",
    "inf",
    "9223372036854775807",
    "18446744073709551616",
    "0x10",
    "1_000",
    "\"",
    "'",
    "[[",
    "]]",
    "{}",
    "[]",
    "\n\n",
    ",,",
    ";",
    "\t",
    "\0",
    "\u{1b}[31m",
    "\u{feff}",
    "ü",
];

impl Mutator {
    fn below(&mut self, limit: usize) -> usize {
        (self.random.next_u64() % limit.max(1) as u64) as usize
    }

    fn input(&mut self) -> Vec<u8> {
        let which = self.below(self.corpus.len());
        let mut input = self.corpus[which].clone();
        for _ in 0..=self.below(6) {
            self.mutate(&mut input);
        }
        input.truncate(MOST);
        input
    }

    fn mutate(&mut self, input: &mut Vec<u8>) {
        let at = self.below(input.len() + 1);
        let end = at + self.below((input.len() - at).min(64) + 1);
        match self.below(9) {
            // A bit, a byte.
            0 if at < input.len() => input[at] ^= 1 << self.below(8),
            1 if at < input.len() => input[at] = self.random.next_u64() as u8,
            // A piece goes, comes again, or moves.
            2 => drop(input.drain(at..end)),
            3 => {
                let piece = input[at..end].to_vec();
                let times = 1 + self.below(3);
                input.splice(at..at, piece.repeat(times));
            }
            4 => {
                let piece: Vec<u8> = input.drain(at..end).collect();
                let to = self.below(input.len() + 1);
                input.splice(to..to, piece);
            }
            // The end is missing, or is that of another.
            5 => input.truncate(at),
            6 => {
                let other = self.below(self.corpus.len());
                let from = self.below(self.corpus[other].len());
                input.truncate(at);
                input.extend_from_slice(&self.corpus[other][from..]);
            }
            // Something that files break on, put in or in place of a number.
            7 => {
                let token = TOKENS[self.below(TOKENS.len())];
                input.splice(at..at, token.bytes());
            }
            _ => {
                let is_of_number = |byte: &u8| byte.is_ascii_digit() || b".+-eE".contains(byte);
                let Some(first) = input[at..].iter().position(u8::is_ascii_digit) else { return };
                let first = at + first;
                let length = input[first..].iter().take_while(|byte| is_of_number(byte)).count();
                let token = TOKENS[self.below(12)];
                input.splice(first..first + length, token.bytes());
            }
        }
    }
}

#[test]
fn scenarios() {
    fuzz("scenario", targets::scenario::run, 10_000);
}

#[test]
fn manifests() {
    fuzz("manifest", targets::manifest::run, 20_000);
}

#[test]
fn csv_files() {
    fuzz("csv", targets::csv::run, 6000);
}

#[test]
#[cfg(feature = "matlab")]
fn mat_files() {
    fuzz("mat", targets::mat::run, 30_000);
}

#[test]
#[cfg(feature = "mdf")]
fn mdf_files() {
    fuzz("mdf", targets::mdf::run, 15_000);
}

#[test]
#[cfg(feature = "mcap")]
fn mcap_files() {
    fuzz("mcap", targets::mcap::run, 3000);
}

#[test]
#[cfg(feature = "parquet")]
fn parquet_files() {
    fuzz("parquet", targets::parquet::run, 10_000);
}

#[test]
fn json_files() {
    fuzz("json", targets::json::run, 5000);
}

#[test]
fn short_rigs() {
    fuzz("gap", targets::gap::run, 60);
}

#[test]
fn words_of_an_fmu() {
    fuzz("host", targets::host::run, 50_000);
}

#[test]
fn folders_of_reports() {
    fuzz("page", targets::page::run, 2000);
}

#[test]
fn parts_of_studies() {
    fuzz("merge", targets::merge::run, 5000);
}
