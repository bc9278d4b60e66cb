//! Millions of random fits: without panics, with only finite numbers, and with one hash that is equal in
//! debug and release builds and for any number of threads.
//!
//! ```text
//! cargo run --release -p shadowfit-determinism --bin random_fits -- FITS WINDOWS [SEED]
//! ```

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::process::ExitCode;
use std::sync::atomic::{AtomicU64, Ordering};
use std::thread;
use std::time::Instant;

use shadowfit_determinism::chunk::{self, Kind};

fn main() -> ExitCode {
    let numbers: Option<Vec<u64>> = std::env::args().skip(1).map(|text| text.parse().ok()).collect();
    let (fits, windows, seed) = match numbers.as_deref() {
        Some([fits, windows]) => (*fits, *windows, 1),
        Some([fits, windows, seed]) => (*fits, *windows, *seed),
        _ => {
            eprintln!("give the number of fits of cascades, that of windows, and a seed or none");
            return ExitCode::from(2);
        }
    };
    let results = [(Kind::Cascades, fits), (Kind::Windows, windows)].map(|(kind, fits)| run(kind, fits, seed));
    if results.into_iter().all(|is_right| is_right) { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

/// Runs the chunks of a kind on all cores. Returns whether all were right.
fn run(kind: Kind, fits: u64, seed: u64) -> bool {
    let (chunks, start, next) = (fits.div_ceil(u64::from(chunk::FITS)), Instant::now(), AtomicU64::new(0));
    let work = || {
        let indices = std::iter::from_fn(|| Some(next.fetch_add(1, Ordering::Relaxed)).filter(|index| *index < chunks));
        indices.map(|index| (index, checked(kind, seed, index))).collect::<Vec<_>>()
    };
    let threads = thread::available_parallelism().map_or(1, usize::from);
    let mut results: Vec<(u64, Option<u64>)> = thread::scope(|scope| {
        let workers: Vec<_> = (0..threads).map(|_| scope.spawn(work)).collect();
        workers.into_iter().flat_map(|worker| worker.join().expect("chunks are caught")).collect()
    });
    results.sort_unstable();
    let wrong = results.iter().filter(|(_, hash)| hash.is_none()).count();
    let hash = chunk::of_all(results.into_iter().filter_map(|(_, hash)| hash));
    let (fits, seconds) = (chunks * u64::from(chunk::FITS), start.elapsed().as_secs_f64());
    println!(
        "{kind:?}: {fits} fits, hash {hash:#018x}, {wrong} chunks wrong, {:.0} fits per second",
        fits as f64 / seconds
    );
    wrong == 0
}

/// Returns the hash of a chunk. Prints a line and returns `None` for a wrong one.
fn checked(kind: Kind, seed: u64, index: u64) -> Option<u64> {
    let result = catch_unwind(AssertUnwindSafe(|| chunk::run(kind, seed, index)));
    let result = result.unwrap_or_else(|_| Err("a panic".to_owned()));
    result.inspect_err(|wrong| println!("{kind:?}, seed {seed}, chunk {index}: {wrong}")).ok()
}
