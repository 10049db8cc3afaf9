//! CPU time and memory of this process, from Linux.

use std::fs;

/// Clock ticks per second in /proc: USER_HZ, 100 on every architecture that Linux and Android run on today.
const TICKS_PER_SECOND: f64 = 100.0;

/// A sample of /proc/self.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ProcessSample {
    /// Time on all cores since the process started, in seconds.
    pub cpu_seconds: Option<f64>,
    /// Resident memory in bytes.
    pub resident_bytes: Option<u64>,
}

impl ProcessSample {
    /// Takes a sample; its values are `None` on systems without /proc.
    pub fn take() -> ProcessSample {
        ProcessSample {
            cpu_seconds: fs::read_to_string("/proc/self/stat").ok().and_then(|s| cpu_seconds(&s)),
            resident_bytes: fs::read_to_string("/proc/self/status").ok().and_then(|s| resident_bytes(&s)),
        }
    }
}

/// Returns the load between two samples in percent of one core; 200 for two busy cores.
pub fn cpu_load(before: &ProcessSample, after: &ProcessSample, seconds: f64) -> Option<f64> {
    let (before, after) = (before.cpu_seconds?, after.cpu_seconds?);
    (seconds > 0.0 && after >= before).then(|| (after - before) / seconds * 100.0)
}

/// Sums fields 14 and 15 of /proc/self/stat, in seconds. The name in field 2 may contain spaces and `)`.
fn cpu_seconds(stat: &str) -> Option<f64> {
    let (_, rest) = stat.rsplit_once(')')?;
    let mut fields = rest.split_whitespace().skip(11);
    let (user, system): (f64, f64) = (fields.next()?.parse().ok()?, fields.next()?.parse().ok()?);
    Some((user + system) / TICKS_PER_SECOND)
}

fn resident_bytes(status: &str) -> Option<u64> {
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:"))?;
    let kilobytes: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kilobytes * 1024)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn linuxs_files_are_parsed() {
        let stat = "4242 (a (b) c) S 1 2 3 4 5 6 7 8 9 10 250 150 0 0 20 0 12 0 100 200 300";
        assert_eq!(cpu_seconds(stat), Some(4.0));
        assert_eq!(cpu_seconds("4242 (x) S 1 2"), None);
        assert_eq!(resident_bytes("Name:\tx\nVmRSS:\t   312 kB\n"), Some(312 * 1024));
        assert_eq!(resident_bytes("Name:\tx\n"), None);
    }

    #[test]
    fn this_process_has_memory_and_cpu_time() {
        let sample = ProcessSample::take();
        assert!(sample.resident_bytes.is_none_or(|b| b > 1 << 20));
        let later = ProcessSample { cpu_seconds: sample.cpu_seconds.map(|s| s + 1.5), ..sample };
        if sample.cpu_seconds.is_some() {
            assert!((cpu_load(&sample, &later, 1.0).unwrap() - 150.0).abs() < 1e-6);
        }
        assert_eq!(cpu_load(&ProcessSample::default(), &later, 1.0), None);
    }
}
