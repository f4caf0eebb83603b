//! Times of day written as one number: 120159.98 is 12:01:59.98.

/// What passes from the last second of a minute and of an hour to the next, beyond the usual step, where such numbers are read as seconds.
const JUMPS: [f64; 2] = [40.0, 4040.0];

/// Whether numbers are times of day as HHMMSS: no part is beyond its bound, and a minute or an hour ends among them.
pub(super) fn is_time_of_day(raw: &[f64]) -> bool {
    let is_within = |stamp: &f64| {
        (0.0..240_000.0).contains(stamp) && stamp % 100.0 < 60.0 && (stamp / 100.0).floor() % 100.0 < 60.0
    };
    let steps = || raw.windows(2).map(|pair| pair[1] - pair[0]);
    let mut sorted: Vec<f64> = steps().filter(|step| *step > 0.0).collect();
    sorted.sort_by(f64::total_cmp);
    let Some(usual) = sorted.get(sorted.len() / 2).copied() else { return false };
    let is_jump = |step: f64| JUMPS.iter().any(|jump| (step - jump - usual).abs() <= 0.5 * usual);
    usual < 20.0 && raw.iter().all(is_within) && steps().any(is_jump)
}

/// Seconds since midnight.
pub(super) fn seconds(stamp: f64) -> f64 {
    let minutes = (stamp / 100.0).floor();
    let (hour, minute) = ((minutes / 100.0).floor(), minutes % 100.0);
    3600.0 * hour + 60.0 * minute + (stamp - 100.0 * minutes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_end_of_a_minute_shows_a_time_of_day() {
        for start in [43_190.0, 46_790.0] {
            let clock = |k: i32| {
                let second = start + 0.02 * f64::from(k);
                let (hour, minute) = ((second / 3600.0).floor(), (second / 60.0).floor() % 60.0);
                10_000.0 * hour + 100.0 * minute + second % 60.0
            };
            let raw: Vec<f64> = (0..1000).map(clock).collect();
            assert!(is_time_of_day(&raw));
            assert!(raw.windows(2).all(|pair| (seconds(pair[1]) - seconds(pair[0]) - 0.02).abs() < 1e-6));
            assert!(!is_time_of_day(&raw[..400]), "nothing shows it within a minute");
        }
        let plain: Vec<f64> = (0..1000).map(|k| 0.5 * f64::from(k)).collect();
        assert!(!is_time_of_day(&plain));
    }
}
