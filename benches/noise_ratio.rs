//! The noise and the pass as ratios, from runs that alternate, so that they hold on a busy machine too.
//!
//! Every round times each piece of work once, in turn; a ratio is the median over the rounds of the ratio within
//! a round. `cargo bench --bench noise_ratio` prints the table; without `--bench` one round checks that it runs.

use std::hint::black_box;
use std::time::Instant;

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use switchback_noise::{BLOCK, NoisePass, NoisePlan, StreamId, WhiteNoise, Width};

/// Samples of one replicate, a multiple of the block.
const SAMPLES: usize = 160 * BLOCK;

/// Replicates, a multiple of every width.
const REPLICATES: usize = 16;

/// Normals that each piece of work draws.
const NORMALS: usize = SAMPLES * REPLICATES;

/// Something to time, which draws [`NORMALS`] normals.
struct Work {
    name: String,
    run: Box<dyn FnMut()>,
}

fn ziggurat() -> Work {
    let mut rng = ChaCha8Rng::seed_from_u64(1);
    let mut block = vec![0.0; BLOCK];
    let run = move || {
        for _ in 0..NORMALS / block.len() {
            block.iter_mut().for_each(|x| *x = StandardNormal.sample(&mut rng));
            black_box(&mut block);
        }
    };
    Work { name: "rand_distr ziggurat".into(), run: Box::new(run) }
}

fn white(width: Width) -> Work {
    let mut noise = WhiteNoise::new(width, StreamId { seed: 1, experiment: 0, replicate: 0 });
    let mut block = vec![0.0; BLOCK * noise.lanes()];
    let run = move || {
        for _ in 0..NORMALS / block.len() {
            noise.fill(&mut block);
            black_box(&mut block);
        }
    };
    Work { name: format!("white, lanes = {}", width.lanes()), run: Box::new(run) }
}

fn pass(width: Width, periods: &[usize]) -> Work {
    let plan = NoisePlan {
        ar: vec![-1.5, 0.7],
        ma: vec![],
        lags: 2,
        periods: periods.to_vec(),
        checkpoints: vec![SAMPLES / 10, SAMPLES],
        burn_in: 0,
    };
    let mut pass = NoisePass::new(plan, width).expect("the plan is valid");
    let run = move || {
        pass.run(1, 0, 0..REPLICATES as u32, |_, record| {
            black_box(record);
        })
    };
    Work { name: format!("pass, n = 2, T = {periods:?}, lanes = {}", width.lanes()), run: Box::new(run) }
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

fn main() {
    let rounds = if std::env::args().any(|argument| argument == "--bench") { 301 } else { 1 };
    println!("{:45} {:>9} {:>9} {:>9}", "median of alternating runs", "ns", "/ white", "/ zigg.");
    for width in Width::available() {
        let mut works = [
            ziggurat(),
            white(width),
            pass(width, &[22]),
            pass(width, &[1, 22]),
            pass(width, &[1, 14, 22, 38]),
        ];
        let mut times = vec![Vec::new(); works.len()];
        for _ in 0..rounds {
            for (work, times) in works.iter_mut().zip(&mut times) {
                let start = Instant::now();
                (work.run)();
                times.push(start.elapsed().as_secs_f64() * 1e9 / NORMALS as f64);
            }
        }
        let over = |i: usize, j: usize| median(times[i].iter().zip(&times[j]).map(|(a, b)| a / b).collect());
        for (i, work) in works.iter().enumerate() {
            let time = median(times[i].clone());
            println!("{:45} {time:9.3} {:9.3} {:9.3}", work.name, over(i, 1), over(i, 0));
        }
    }
}
