//! CPU time and memory of this process, as reported by the operating system.

use std::fs;
use std::time::Duration;

use rustix::time::{ClockId, clock_gettime};

/// Returns the CPU time that all threads of the process have used so far.
pub fn cpu_time() -> Duration {
    let time = clock_gettime(ClockId::ProcessCPUTime);
    Duration::new(time.tv_sec as u64, time.tv_nsec as u32)
}

/// Returns the current resident memory in MiB; `None` if `/proc` does not report it.
pub fn resident_mib() -> Option<f64> {
    kilobytes(&fs::read_to_string("/proc/self/status").ok()?, "VmRSS:")
}

/// Returns the figure in kB after a key, in MiB.
fn kilobytes(text: &str, key: &str) -> Option<f64> {
    let line = text.lines().find_map(|line| line.strip_prefix(key))?;
    Some(line.trim().strip_suffix("kB")?.trim().parse::<f64>().ok()? / 1024.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn figures_in_proc_are_parsed() {
        let text = "Name:\tyoro\nVmHWM:\t  204800 kB\nVmRSS:\t    1024 kB\n";
        assert_eq!(kilobytes(text, "VmHWM:"), Some(200.0));
        assert_eq!(kilobytes(text, "VmSwap:"), None);
        assert_eq!(kilobytes("VmRSS: many", "VmRSS:"), None);
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn work_takes_cpu_time_and_memory() {
        let before = cpu_time();
        let numbers: Vec<u64> = (0..4_000_000).collect();
        let resident = resident_mib().unwrap();
        assert!(resident > 30.0, "{resident} MiB");
        let start = std::time::Instant::now();
        while start.elapsed() < Duration::from_millis(20) {}
        assert!(cpu_time() > before);
        drop(numbers);
    }
}
