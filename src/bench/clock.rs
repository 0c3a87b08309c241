//! CPU time of a thread.

use std::time::Instant;

/// A clock that runs while this thread does, where the system tells; a wall clock elsewhere.
pub(super) struct Clock {
    wall: Instant,
    cpu: Option<f64>,
}

/// CPU time of this thread [s], on Linux.
fn cpu_seconds() -> Option<f64> {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    let nanoseconds: f64 = text.split_whitespace().next()?.parse().ok()?;
    Some(nanoseconds * 1e-9)
}

impl Clock {
    /// Starts.
    pub fn start() -> Self {
        Clock {
            wall: Instant::now(),
            cpu: cpu_seconds(),
        }
    }

    /// Seconds since the start; more than zero.
    pub fn seconds(&self) -> f64 {
        let cpu = self.cpu.and_then(|before| Some(cpu_seconds()? - before));
        // A counter that stands still is none.
        cpu.filter(|&s| s > 0.0)
            .unwrap_or_else(|| self.wall.elapsed().as_secs_f64())
            .max(1e-9)
    }
}
