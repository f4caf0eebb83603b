//! Processor time and memory of this process.

/// Seconds of processor time that this process has taken on all its threads, from its beginning on.
#[cfg(unix)]
pub(super) fn processor() -> f64 {
    let now = rustix::time::clock_gettime(rustix::time::ClockId::ProcessCPUTime);
    now.tv_sec as f64 + now.tv_nsec as f64 * 1e-9
}

/// Elsewhere the time on the wall, which is the same where nothing else runs.
#[cfg(not(unix))]
pub(super) fn processor() -> f64 {
    static BEGUN: std::sync::OnceLock<std::time::Instant> = std::sync::OnceLock::new();
    BEGUN.get_or_init(std::time::Instant::now).elapsed().as_secs_f64()
}

/// What some work gives, and the seconds of processor time that it took.
pub(super) fn timed<T>(work: impl FnOnce() -> T) -> (T, f64) {
    let begun = processor();
    let made = work();
    (made, processor() - begun)
}

/// Bytes of memory that this process has taken at most so far, where the system tells.
pub(super) fn most_memory() -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    let kilobytes: f64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kilobytes * 1024.0)
}
