//! A column that counts the samples, as steps of one where none is missing.

/// Sizes at which counters begin again.
const SIZES: [f64; 9] = [100.0, 128.0, 256.0, 1000.0, 1024.0, 4096.0, 10_000.0, 65_536.0, 4_294_967_296.0];

/// A counter that goes on where it began again by overflow, and where it started anew.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Counter {
    /// Whole numbers, increasing between starts.
    pub(super) counts: Vec<f64>,
    /// Samples from which it starts anew.
    pub(super) starts: Vec<usize>,
}

impl Counter {
    /// None where it runs back or stands still but for overflows and new starts.
    pub(super) fn of(raw: &[f64]) -> Option<Self> {
        let most = raw.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let size = SIZES.into_iter().find(|size| most < *size && most >= 0.9 * size);
        let (mut offset, mut counts, mut starts) = (0.0, Vec::with_capacity(raw.len()), Vec::new());
        for (k, now) in raw.iter().enumerate() {
            if let Some(before) = k.checked_sub(1).map(|k| raw[k])
                && *now <= before
            {
                let over =
                    size.map(|size| now + size - before).filter(|step| (1.0..0.25 * most).contains(step));
                let is_anew = over.is_none() && *now <= 1.0;
                if over.is_none() && !is_anew {
                    return None;
                }
                offset += over.map_or(before - now + 1.0, |step| step + before - now);
                starts.extend(is_anew.then_some(k));
            }
            counts.push(now + offset);
        }
        Some(Self { counts, starts })
    }

    /// Samples before which others are missing, or another record begins.
    pub(super) fn interruptions(&self) -> Vec<usize> {
        let counts = &self.counts;
        (1..counts.len()).filter(|k| counts[*k] - counts[k - 1] != 1.0 || self.starts.contains(k)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn overflows_go_on_and_new_starts_interrupt() {
        let bytes: Vec<f64> = (0..1000).filter(|k| *k != 500).map(|k| f64::from(k % 256)).collect();
        assert_eq!(Counter::of(&bytes).unwrap().interruptions(), [500]);
        let anew: Vec<f64> = (0..300).map(|k| f64::from(k % 130)).collect();
        assert_eq!(Counter::of(&anew).unwrap().interruptions(), [130, 260]);
        assert_eq!(Counter::of(&[0.0, 1.0, 5.0, 3.0, 4.0]), None);
    }
}
