//! The shape of an error, whatever its cause: tails, spectrum, means and squares over travel, time, speed, rest, position, level and age.

use super::lines::{level, power};
use super::setting::{Setting, spread};

/// Where statistics are collected.
pub(super) type Columns = Vec<(String, f64)>;

/// Least number of samples in a cell.
const LEAST: f64 = 10.0;

/// Statistics of an error, records joined, in units of its root mean square.
pub(super) fn shape(tag: &str, error: &[f64], setting: &Setting, out: &mut Columns) {
    let count = error.len() as f64;
    let rms = (error.iter().map(|e| e * e).sum::<f64>() / count.max(1.0)).sqrt().max(f64::MIN_POSITIVE);
    let z: Vec<f64> = error.iter().map(|e| e / rms).collect();
    let mut add = |name: &str, value: f64| out.push((format!("{tag}_{name}"), value));
    tails(&z, setting, &mut add);
    spectrum(&z, setting, &mut add);
    profiles(&z, setting, &mut add);
    follows(&z, setting, &mut add);
}

fn ln(x: f64) -> f64 {
    libm::log(x)
}

fn tails(z: &[f64], setting: &Setting, add: &mut dyn FnMut(&str, f64)) {
    let count = z.len() as f64;
    let sizes: Vec<f64> = z.iter().map(|x| x.abs()).collect();
    let spread = spread(z.iter().copied()) + 1e-9;
    let largest = sizes.iter().copied().fold(0.0, f64::max);
    let beyond = |k: f64| sizes.iter().filter(|x| **x > k * spread).count() as f64 / count;
    add("fourth", ln(z.iter().map(|x| x.powi(4)).sum::<f64>() / count / 3.0 + 1e-6));
    add("median", ln(spread));
    add("largest", ln(largest / spread + 1e-6));
    add("beyond_4", ln(beyond(4.0) + 1e-4));
    add("beyond_6", ln(beyond(6.0) + 1e-4));
    let mut order: Vec<usize> = (2..z.len().saturating_sub(2)).collect();
    order.sort_by(|i, j| sizes[*j].total_cmp(&sizes[*i]).then(i.cmp(j)));
    order.truncate((z.len() / 200).max(5));
    let n = order.len().max(1) as f64;
    let mean = |of: &dyn Fn(usize) -> f64| order.iter().map(|t| of(*t)).sum::<f64>() / n;
    add("alone", mean(&|t| sizes[t - 1].max(sizes[t + 1]) / sizes[t].max(1e-12)));
    add("same_sign", mean(&|t| (z[t - 1] + z[t + 1]) * z[t].signum() / sizes[t].max(1e-12)));
    let share = |is: &dyn Fn(usize) -> bool| {
        let all = (0..z.len()).filter(|t| is(*t)).count() as f64 / count;
        mean(&|t| f64::from(u8::from(is(t)))) - all
    };
    add("largest_after_reversal", share(&|t| setting.since[t] < 4.0));
    add("largest_near_reversal", share(&|t| setting.travel[t] < 0.05));
    add("largest_at_rest", share(&|t| setting.rest[t] > 0.0));
    add("largest_at_ends", share(&|t| setting.level[t] < 0.05 || setting.level[t] > 0.95));
}

/// Longest stretch that is transformed.
const LONGEST: usize = 16_384;

fn spectrum(z: &[f64], setting: &Setting, add: &mut dyn FnMut(&str, f64)) {
    // The longest record: others would put steps between them.
    let (mut best, mut from) = (0..0, 0);
    for t in 1..=z.len() {
        if t == z.len() || setting.record[t] != setting.record[from] {
            if t - from > best.len() {
                best = from..t;
            }
            from = t;
        }
    }
    let part = &z[best.start..best.end.min(best.start + LONGEST)];
    let p = power(part, false);
    let sum: f64 = p.iter().sum::<f64>().max(f64::MIN_POSITIVE);
    let p: Vec<f64> = p.iter().map(|p| p / sum).collect();
    let n = p.len();
    let mut to = n;
    for octave in 0..9 {
        let from = to / 2;
        add(&format!("octave_{octave}"), p[from..to].iter().sum());
        to = from.max(1);
    }
    let logs: Vec<f64> = p.iter().map(|p| ln(p + 1e-12)).collect();
    add("flatness", logs.iter().sum::<f64>() / n as f64 - ln(1.0 / n as f64));
    let levels = level(&logs);
    let line = (12.min(n - 1)..n).max_by(|i, j| (logs[*i] - levels[*i]).total_cmp(&(logs[*j] - levels[*j])));
    let line = line.unwrap_or(0);
    add("line", ln(p[line.saturating_sub(2)..(line + 3).min(n)].iter().sum::<f64>() + 1e-9));
    add("line_above", logs[line] - levels[line]);
    add("line_at", ln((line + 1) as f64 / n as f64));
    let harmonic = |k: usize| {
        let h = (line + 1) * k;
        if h + 3 < n {
            logs[h - 3..h + 2].iter().copied().fold(f64::MIN, f64::max) - levels[h - 1]
        } else {
            0.0
        }
    };
    add("harmonic_2", harmonic(2));
    add("harmonic_3", harmonic(3));
    let mut sorted = p.clone();
    sorted.sort_by(|x, y| y.total_cmp(x));
    let most = |k: usize| ln(sorted.iter().take(2 * k).sum::<f64>() + 1e-9);
    [1, 3, 6].iter().for_each(|k| add(&format!("most_{k}"), most(*k)));
    for lag in [1, 2, 3, 5, 10, 30] {
        let products = part.iter().zip(part.iter().skip(lag)).map(|(x, y)| x * y).sum::<f64>();
        add(&format!("lag_{lag}"), products / part.iter().map(|x| x * x).sum::<f64>().max(1e-12));
    }
}

/// Mean and mean square of a signal in cells; zero where a cell is nearly empty.
struct Cells {
    mean: Vec<f64>,
    square: Vec<f64>,
}

impl Cells {
    fn of(z: &[f64], cells: usize, cell: &dyn Fn(usize) -> usize) -> Self {
        let (mut count, mut sum, mut square) = (vec![0.0; cells], vec![0.0; cells], vec![0.0; cells]);
        for (t, z) in z.iter().enumerate() {
            let k = cell(t);
            count[k] += 1.0;
            sum[k] += z;
            square[k] += z * z;
        }
        let over = |x: &[f64], log: bool| -> Vec<f64> {
            let one = |(x, n): (&f64, &f64)| match *n > LEAST {
                true if log => ln(x / n + 1e-3),
                true => x / n,
                false => 0.0,
            };
            x.iter().zip(&count).map(one).collect()
        };
        Self { mean: over(&sum, false), square: over(&square, true) }
    }
}

/// Cells along a quantity of the samples.
struct Axis<'a> {
    name: &'static str,
    /// Between these, below the first and above the last.
    edges: &'static [f64],
    values: &'a [f64],
}

fn profiles(z: &[f64], setting: &Setting, add: &mut dyn FnMut(&str, f64)) {
    let signed: Vec<f64> = z.iter().zip(&setting.branch).map(|(z, b)| z * b).collect();
    let axes = [
        Axis { name: "travel", edges: &[0.01, 0.03, 0.08, 0.2, 0.5], values: &setting.travel },
        Axis { name: "since", edges: &[2.0, 4.0, 8.0, 20.0, 60.0], values: &setting.since },
        Axis { name: "speed", edges: &[0.3, 0.7, 1.2, 2.0], values: &setting.speed },
        Axis { name: "rest", edges: &[1.0, 4.0, 15.0, 60.0], values: &setting.rest },
    ];
    for Axis { name, edges, values } in axes {
        let cell = |t: usize| edges.partition_point(|e| *e <= values[t]);
        let of_branch = Cells::of(&signed, edges.len() + 1, &cell);
        let plain = Cells::of(z, edges.len() + 1, &cell);
        for k in 0..=edges.len() {
            add(&format!("{name}_mean_{k}"), of_branch.mean[k]);
            add(&format!("{name}_square_{k}"), plain.square[k]);
        }
    }
    for (name, values) in [("position", &setting.position), ("level", &setting.level)] {
        let cell = |t: usize| ((values[t] * 6.0) as usize).min(5);
        let plain = Cells::of(z, 6, &cell);
        let of_branch = Cells::of(&signed, 6, &cell);
        for k in 0..6 {
            add(&format!("{name}_mean_{k}"), plain.mean[k]);
            add(&format!("{name}_branch_{k}"), of_branch.mean[k]);
            add(&format!("{name}_square_{k}"), plain.square[k]);
        }
    }
    let age = |t: usize| ((setting.clock[t] * 6.0) as usize).min(5);
    let (plain, of_branch) = (Cells::of(z, 6, &age), Cells::of(&signed, 6, &age));
    let slope = |x: &[f64]| x.iter().enumerate().map(|(k, x)| (k as f64 - 2.5) * x).sum::<f64>() / 17.5;
    let scatter = |x: &[f64]| {
        let mean = x.iter().sum::<f64>() / x.len().max(1) as f64;
        (x.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / x.len().max(1) as f64).sqrt()
    };
    add("age_mean", scatter(&plain.mean));
    add("age_mean_slope", slope(&plain.mean));
    add("age_square", scatter(&plain.square));
    add("age_square_slope", slope(&plain.square));
    add("age_branch_slope", slope(&of_branch.mean));
    let records = setting.record.last().map_or(1, |last| last + 1);
    let of_records = Cells::of(z, records, &|t| setting.record[t]);
    add("record_mean", scatter(&of_records.mean));
    add("record_square", scatter(&of_records.square));
}

fn follows(z: &[f64], setting: &Setting, add: &mut dyn FnMut(&str, f64)) {
    let squares: Vec<f64> = z.iter().map(|z| (z * z).min(25.0)).collect();
    for (name, signal) in &setting.follows {
        add(&format!("follows_{name}"), correlation(&squares, signal));
    }
    for lag in 0..4 {
        let pairs = setting.move_of_u.iter().zip(z.iter().skip(lag));
        let (xy, xx) = pairs.fold((0.0, 1e-300), |(xy, xx), (u, z)| (xy + u * z, xx + u * u));
        add(&format!("move_{lag}"), xy / (xx * z.len() as f64).sqrt());
    }
}

fn correlation(x: &[f64], y: &[f64]) -> f64 {
    let n = x.len() as f64;
    let (mx, my) = (x.iter().sum::<f64>() / n, y.iter().sum::<f64>() / n);
    let sums = x.iter().zip(y).fold([0.0; 3], |[xx, xy, yy], (x, y)| {
        let (x, y) = (x - mx, y - my);
        [xx + x * x, xy + x * y, yy + y * y]
    });
    let size = (sums[0] * sums[2]).sqrt();
    if size > 0.0 { sums[1] / size } else { 0.0 }
}

/// The lattice of measured values, and their ends.
pub(super) fn lattice(records: &[&[f64]], rms: f64, out: &mut Columns) {
    let mut values: Vec<f64> = records.iter().flat_map(|y| y.iter().copied()).collect();
    let count = values.len() as f64;
    let mut zero = 0.0;
    for y in records {
        zero += y.windows(2).filter(|w| w[0] == w[1]).count() as f64;
    }
    values.sort_by(f64::total_cmp);
    let (low, high) = (values[0], values[values.len() - 1]);
    let range = (high - low).max(f64::MIN_POSITIVE);
    let near = |at: f64| values.iter().filter(|y| (**y - at).abs() <= 0.002 * range).count() as f64;
    let ties = |at: f64| values.iter().filter(|y| **y == at).count() as f64;
    let mut add = |name: &str, value: f64| out.push((format!("lattice_{name}"), value));
    add("near_top", ln(near(high) / count + 1e-4));
    add("near_bottom", ln(near(low) / count + 1e-4));
    add("at_top", ln(ties(high)));
    add("at_bottom", ln(ties(low)));
    add("still", zero / count);
    values.dedup();
    add("unique", ln(values.len() as f64 / count));
    let mut steps: Vec<f64> = values.windows(2).map(|w| w[1] - w[0]).collect();
    steps.sort_by(f64::total_cmp);
    let step = steps.get(steps.len() / 2).copied().unwrap_or(1.0).max(f64::MIN_POSITIVE);
    let whole = |d: &&f64| (**d / step - (**d / step).round()).abs() < 0.03;
    add("step", ln(step / rms + 1e-9));
    add("smallest", ln(steps.first().copied().unwrap_or(0.0) / rms + 1e-9));
    add("whole", steps.iter().filter(whole).count() as f64 / steps.len().max(1) as f64);
}
