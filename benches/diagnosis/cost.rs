//! One diagnosis, measured.

use super::rigs::BenchRig;
use cpu_time::ProcessTime;
use peak_alloc::PeakAlloc;
use std::hint::black_box;
use switchback_diagnose::{Model, Settings, diagnose};

/// The allocator that knows how much was held at once.
pub(crate) const PEAK: PeakAlloc = PeakAlloc;

/// What a diagnosis cost.
pub(crate) struct Cost {
    name: String,
    samples: usize,
    /// Processor seconds.
    pub(crate) seconds: f64,
    passes: u64,
    peak_mb: f32,
    verdict: String,
}

impl Cost {
    /// Diagnoses a rig on one thread.
    pub(crate) fn of(bench: &BenchRig) -> Self {
        PEAK.reset_peak_usage();
        let start = ProcessTime::now();
        let diagnosis = black_box(diagnose(&bench.rig, Model::Identify, &Settings::default()));
        let seconds = start.elapsed().as_secs_f64();
        let samples = bench.rig.records.iter().map(|r| r.record.len()).sum();
        let (passes, verdict) = match diagnosis {
            Ok(d) => {
                let effects = d.verdict.effects.iter().chain(&d.verdict.class);
                let names: Vec<&str> = effects.map(|e| e.name()).collect();
                (d.passes, format!("{} {}", d.verdict.status.name(), names.join(" + ")))
            }
            Err(error) => (0, error.to_string()),
        };
        Self { name: bench.name.clone(), samples, seconds, passes, peak_mb: PEAK.peak_usage_as_mb(), verdict }
    }

    /// A row of the table; `unit` in seconds.
    pub(crate) fn row(&self, unit: f64) -> String {
        let Self { name, samples, seconds, passes, peak_mb, verdict } = self;
        let units = seconds / unit;
        format!("{name:28}{samples:>9}{seconds:>10.2}{units:>10.0}{passes:>9}{peak_mb:>9.0}  {verdict}")
    }
}
