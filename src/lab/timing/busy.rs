//! What other processes take of the machine while something is timed. Linux tells; elsewhere nothing is known.

use std::fs;

/// Processor time up to now, in the kernel's ticks.
pub(super) struct Cores {
    /// Of all processes and interrupts, what a host takes from a virtual machine included.
    busy: u64,
    /// Busy and idle.
    all: u64,
    /// Of this process.
    own: u64,
}

impl Cores {
    /// Up to now.
    pub(super) fn now() -> Option<Self> {
        Self::read(&fs::read_to_string("/proc/stat").ok()?, &fs::read_to_string("/proc/self/stat").ok()?)
    }

    /// From the texts of proc(5): `cpu user nice system idle iowait irq softirq steal`, and fields 14 and 15 of a process.
    fn read(machine: &str, process: &str) -> Option<Self> {
        let line = machine.lines().find_map(|line| line.strip_prefix("cpu "))?;
        let ticks: Vec<u64> = line.split_whitespace().take(8).map(|t| t.parse().ok()).collect::<Option<_>>()?;
        let all = ticks.iter().sum::<u64>();
        let idle = ticks.get(3)? + ticks.get(4)?;
        // The name, in parentheses, may hold spaces.
        let fields: Vec<&str> = process.rsplit_once(')')?.1.split_whitespace().collect();
        let of = |at: usize| fields.get(at - 3)?.parse::<u64>().ok();
        Some(Self { busy: all - idle, all, own: of(14)? + of(15)? })
    }

    /// Share of all cores that others took between then and now; `None` if no tick has passed.
    pub(super) fn others_since(&self, then: &Self) -> Option<f64> {
        let all = self.all.checked_sub(then.all).filter(|all| *all > 0)?;
        let busy = self.busy.saturating_sub(then.busy);
        Some(busy.saturating_sub(self.own.saturating_sub(then.own)) as f64 / all as f64)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn stored(machine: [u64; 8], own: [u64; 2]) -> Cores {
        let numbers = machine.map(|n| n.to_string()).join(" ");
        let process = format!("7 (a name) with) S 1 2 3 4 5 6 7 8 9 10 {} {} 0 0", own[0], own[1]);
        Cores::read(&format!("cpu  {numbers} 0 0\ncpu0 1 2 3\n"), &process).unwrap()
    }

    #[test]
    fn others_are_what_is_busy_and_not_ours() {
        let then = stored([100, 0, 50, 1000, 10, 0, 0, 0], [60, 20]);
        let now = stored([180, 0, 70, 1080, 20, 0, 0, 10], [110, 30]);
        // 200 ticks in all; 110 busy, ten of them the host's; 60 ours.
        assert_eq!(now.others_since(&then), Some(0.25));
        assert_eq!(then.others_since(&then), None);
        assert_eq!(then.others_since(&now), None);
    }

    #[test]
    fn what_is_not_told_is_not_known() {
        assert!(Cores::read("", "7 (a) S 1").is_none() && Cores::read("cpu  1 2 x\n", "").is_none());
    }
}
