//! How much a thread does, and how long it waits for the GPU.

use std::cell::Cell;
use std::time::Duration;

use web_time::Instant;

std::thread_local! {
    static WAITED: Cell<Spent> = const { Cell::new(Spent::ZERO) };
    /// How many things were made that later frames use again.
    static MADE: Cell<u64> = const { Cell::new(0) };
}

/// Time that a thread has spent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Spent {
    /// By the wall's clock.
    pub wall: Duration,
    /// In which a core worked for it; the same as the wall's on systems that do not tell.
    pub cpu: Duration,
    /// Whether something was made in it that later frames use again: pipelines, targets, buffers of a scene.
    pub is_making: bool,
}

impl Spent {
    const ZERO: Self = Self { wall: Duration::ZERO, cpu: Duration::ZERO, is_making: false };

    /// Both together.
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

/// How long a core has worked for this thread; `None` on systems that do not tell.
fn cpu() -> Option<Duration> {
    #[cfg(target_os = "linux")]
    return rustix::time::clock_gettime(rustix::time::ClockId::ThreadCPUTime).try_into().ok();
    #[cfg(not(target_os = "linux"))]
    None
}

/// Does something that waits for the GPU.
pub(crate) fn waiting<T>(wait: impl FnOnce() -> T) -> T {
    let clock = Clock::start();
    let result = wait();
    WAITED.set(WAITED.get().plus(clock.spent()));
    result
}

/// Makes something that later frames use again.
pub(crate) fn making<T>(make: impl FnOnce() -> T) -> T {
    MADE.set(MADE.get() + 1);
    make()
}

/// Does something, and returns how long that took this thread without its waits for the GPU, in read-backs and
/// submissions.
pub fn own_time<T>(work: impl FnOnce() -> T) -> (T, Spent) {
    let (clock, waited, made) = (Clock::start(), WAITED.get(), MADE.get());
    let done = work();
    let spent = clock.spent().less(WAITED.get().less(waited));
    (done, Spent { is_making: MADE.get() != made, ..spent })
}
