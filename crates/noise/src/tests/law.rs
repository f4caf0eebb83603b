use statrs::distribution::{ContinuousCDF, Normal};

use crate::{BLOCK, StreamId, WhiteNoise, Width, white_samples};

/// Standard errors within which a statistic with a fixed seed has to fall.
const BOUND: f64 = 4.5;

fn replicate(replicate: u32, count: usize) -> Vec<f64> {
    white_samples(StreamId { seed: 42, experiment: 0, replicate }, count)
}

/// `1·3·5·…·(k−1)` for even k, zero for odd k.
fn normal_moment(k: i32) -> f64 {
    if k % 2 == 1 { 0.0 } else { (1..k).step_by(2).map(f64::from).product() }
}

/// Moments one to eight, and the counts beyond one to five and a half standard deviations on either side, of
/// a hundred million samples.
#[test]
fn moments_and_tail_counts_are_normal() {
    let mut noise = WhiteNoise::new(Width::detect(), StreamId { seed: 42, experiment: 0, replicate: 0 });
    let mut block = vec![0.0; BLOCK * noise.lanes()];
    let blocks = 100_000_000 / block.len();
    let count = (blocks * block.len()) as f64;
    let thresholds = [1.0, 2.0, 3.0, 4.0, 5.0, 5.5];
    let mut moments = [0.0; 8];
    let (mut above, mut below) = ([0_u32; 6], [0_u32; 6]);
    for _ in 0..blocks {
        noise.fill(&mut block);
        let mut sums = [0.0; 8];
        for &x in &block {
            let mut power = 1.0;
            for sum in &mut sums {
                power *= x;
                *sum += power;
            }
            for (i, &threshold) in thresholds.iter().enumerate() {
                above[i] += u32::from(x > threshold);
                below[i] += u32::from(x < -threshold);
            }
        }
        moments.iter_mut().zip(sums).for_each(|(m, s)| *m += s);
    }
    for (k, sum) in (1..).zip(moments) {
        let error = ((normal_moment(2 * k) - normal_moment(k).powi(2)) / count).sqrt();
        let z = (sum / count - normal_moment(k)) / error;
        assert!(z.abs() < BOUND, "moment {k} is off by {z} standard errors");
    }
    for (i, &threshold) in thresholds.iter().enumerate() {
        let expected = count * Normal::standard().sf(threshold);
        for observed in [above[i], below[i]] {
            let z = (f64::from(observed) - expected) / expected.sqrt();
            assert!(z.abs() < BOUND, "{observed} of {expected} beyond {threshold}");
        }
    }
}

/// Anderson and Darling's A² of a fully specified law; 3.857 is its upper 1 % point (Stephens 1974, case 0).
fn anderson_darling(mut x: Vec<f64>) -> f64 {
    x.sort_by(f64::total_cmp);
    let normal = Normal::standard();
    let n = x.len();
    let sum: f64 =
        (0..n).map(|i| (2 * i + 1) as f64 * (normal.cdf(x[i]).ln() + normal.sf(x[n - 1 - i]).ln())).sum();
    -(n as f64) - sum / n as f64
}

#[test]
fn anderson_and_darling_find_nothing() {
    for r in 0..4 {
        let statistic = anderson_darling(replicate(r, 500_000));
        assert!(statistic < 3.857, "A² = {statistic} of replicate {r}");
    }
    let squeezed = replicate(0, 500_000).iter().map(|x| x * 1.01).collect();
    assert!(anderson_darling(squeezed) > 3.857, "the test must see one per cent");
}

/// `√N` times the sample correlation of two unit white noises is a standard normal.
fn correlation(x: &[f64], y: &[f64]) -> f64 {
    x.iter().zip(y).map(|(x, y)| x * y).sum::<f64>() / (x.len() as f64).sqrt()
}

/// Between replicates, between experiments, between successive samples; and between the squares of the two
/// normals of a pair, which share their radius.
#[test]
fn streams_and_samples_are_uncorrelated() {
    let n = 200_000;
    let mut noises: Vec<Vec<f64>> = (0..16).map(|r| replicate(r, n)).collect();
    noises.push(white_samples(StreamId { seed: 42, experiment: 1, replicate: 0 }, n));
    noises.push(white_samples(StreamId { seed: 43, experiment: 0, replicate: 0 }, n));
    for (i, x) in noises.iter().enumerate() {
        for y in &noises[..i] {
            assert!(correlation(x, y).abs() < BOUND);
        }
        for lag in 1..=8 {
            assert!(correlation(&x[lag..], &x[..n - lag]).abs() < BOUND, "lag {lag}");
        }
        let square = |first: usize| -> Vec<f64> {
            x[first..].iter().step_by(2).map(|x| (x * x - 1.0) / std::f64::consts::SQRT_2).collect()
        };
        assert!(correlation(&square(0), &square(1)).abs() < BOUND);
    }
}
