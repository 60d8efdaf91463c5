//! CPU time of this process, of each of its threads, and of the whole machine, from `/proc`.
//!
//! On systems other than Linux all times are zero.

use std::collections::BTreeMap;
use std::fs;
use std::time::Duration;

/// User and system time of this process, summed over all threads.
#[must_use]
pub fn process_cpu_time() -> Duration {
    #[cfg(unix)]
    {
        let time = rustix::time::clock_gettime(rustix::time::ClockId::ProcessCPUTime);
        let seconds = u64::try_from(time.tv_sec).unwrap_or_default();
        let nanoseconds = u32::try_from(time.tv_nsec).unwrap_or_default();
        Duration::new(seconds, nanoseconds)
    }
    #[cfg(not(unix))]
    Duration::ZERO
}

/// CPU time of each thread of this process, by thread id.
#[must_use]
pub fn thread_cpu_times() -> BTreeMap<String, Duration> {
    let Ok(tasks) = fs::read_dir("/proc/self/task") else {
        return BTreeMap::new();
    };
    tasks
        .flatten()
        .filter_map(|task| {
            let text = fs::read_to_string(task.path().join("schedstat")).ok()?;
            let nanoseconds = text.split_whitespace().next()?.parse().ok()?;
            let id = task.file_name().to_string_lossy().into_owned();
            Some((id, Duration::from_nanos(nanoseconds)))
        })
        .collect()
}

/// Busy time of the machine since it started, summed over its cores, in steps of 10 ms.
#[must_use]
pub fn machine_busy_time() -> Duration {
    let text = fs::read_to_string("/proc/stat").unwrap_or_default();
    busy_time_of(text.lines().next().unwrap_or_default())
}

/// The busy time in the first line of `/proc/stat` (proc_stat(5)), which is
/// `cpu user nice system idle iowait irq softirq steal …` in ticks of 10 ms; idle and iowait do not
/// count as busy.
fn busy_time_of(line: &str) -> Duration {
    let ticks = line
        .split_whitespace()
        .skip(1)
        .map(|word| word.parse().unwrap_or(0_u64));
    let busy = ticks
        .take(8)
        .enumerate()
        .filter(|(column, _)| !matches!(column, 3 | 4));
    Duration::from_millis(busy.map(|(_, ticks)| ticks).sum::<u64>().saturating_mul(10))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn idle_time_is_not_busy() {
        let line = "cpu  100 1 20 5000 600 3 4 5 70 80";
        assert_eq!(busy_time_of(line), Duration::from_millis(1330));
        assert_eq!(busy_time_of(""), Duration::ZERO);
        assert_eq!(busy_time_of("cpu x"), Duration::ZERO);
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn work_takes_cpu_time() {
        let before = (process_cpu_time(), machine_busy_time());
        let mut state = 1_u32;
        while process_cpu_time() < before.0 + Duration::from_millis(5) {
            state = std::hint::black_box(crate::generate::hash32(state));
        }
        assert!(machine_busy_time() >= before.1);
        let threads: Duration = thread_cpu_times().values().sum();
        assert!(threads > Duration::ZERO);
    }
}
