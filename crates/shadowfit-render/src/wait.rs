//! Work of a thread, and its time spent waiting for the GPU.

use std::cell::Cell;
use std::time::Duration;

use web_time::Instant;

std::thread_local! {
    static WAITED: Cell<Spent> = const { Cell::new(Spent::ZERO) };
    /// Number of created objects that later frames reuse.
    static MADE: Cell<u64> = const { Cell::new(0) };
}

/// Time that a thread has spent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Spent {
    /// Wall-clock time.
    pub wall: Duration,
    /// CPU time of the thread. Equal to the wall-clock time if the system does not report it.
    pub cpu: Duration,
    /// Whether objects were created that later frames reuse: pipelines, targets, buffers of a scene.
    pub is_making: bool,
}

impl Spent {
    const ZERO: Self = Self { wall: Duration::ZERO, cpu: Duration::ZERO, is_making: false };

    /// Returns the sum of both.
    #[must_use]
    pub fn plus(self, other: Self) -> Self {
        let is_making = self.is_making || other.is_making;
        Self { wall: self.wall + other.wall, cpu: self.cpu + other.cpu, is_making }
    }

    fn less(self, other: Self) -> Self {
        let [wall, cpu] = [self.wall.saturating_sub(other.wall), self.cpu.saturating_sub(other.cpu)];
        Self { wall, cpu, is_making: self.is_making }
    }
}

/// Times work.
#[derive(Clone, Copy, Debug)]
struct Clock {
    begin: Instant,
    cpu: Option<Duration>,
}

impl Clock {
    fn start() -> Self {
        Self { begin: Instant::now(), cpu: cpu() }
    }

    fn spent(self) -> Spent {
        let wall = self.begin.elapsed();
        let worked = self.cpu.zip(cpu()).map(|(begin, end)| end.saturating_sub(begin));
        Spent { wall, cpu: worked.unwrap_or(wall), is_making: false }
    }
}

/// Returns the CPU time of this thread; `None` if the system does not report it.
fn cpu() -> Option<Duration> {
    #[cfg(target_os = "linux")]
    return rustix::time::clock_gettime(rustix::time::ClockId::ThreadCPUTime).try_into().ok();
    #[cfg(not(target_os = "linux"))]
    None
}

/// Runs work that waits for the GPU.
pub(crate) fn waiting<T>(wait: impl FnOnce() -> T) -> T {
    let clock = Clock::start();
    let result = wait();
    WAITED.set(WAITED.get().plus(clock.spent()));
    result
}

/// Creates an object that later frames reuse.
pub(crate) fn making<T>(make: impl FnOnce() -> T) -> T {
    MADE.set(MADE.get() + 1);
    make()
}

/// Runs work, and returns its time on this thread without waits for the GPU in read-backs and submissions.
pub fn own_time<T>(work: impl FnOnce() -> T) -> (T, Spent) {
    let (clock, waited, made) = (Clock::start(), WAITED.get(), MADE.get());
    let done = work();
    let spent = clock.spent().less(WAITED.get().less(waited));
    (done, Spent { is_making: MADE.get() != made, ..spent })
}
