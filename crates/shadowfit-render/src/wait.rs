//! How long a thread waits for the GPU.

use std::cell::Cell;
use std::time::Duration;

use web_time::Instant;

std::thread_local! {
    static WAITED: Cell<Duration> = const { Cell::new(Duration::ZERO) };
}

/// Does something that waits for the GPU.
pub(crate) fn waiting<T>(wait: impl FnOnce() -> T) -> T {
    let begin = Instant::now();
    let result = wait();
    WAITED.set(WAITED.get() + begin.elapsed());
    result
}

/// How long this thread has waited for the GPU so far, in read-backs and submissions, to be told apart from its own work.
pub fn waited() -> Duration {
    WAITED.get()
}
