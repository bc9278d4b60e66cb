//! Background work: on a thread, or between two frames in a browser, which has no threads.

use std::io;

/// Runs work in the background, on a thread with this name. In a browser it runs after the current frame, and
/// frames wait for it.
///
/// # Errors
///
/// If the system cannot start a thread.
pub fn in_background(name: &str, work: impl FnOnce() + Send + 'static) -> io::Result<()> {
    #[cfg(not(target_family = "wasm"))]
    return std::thread::Builder::new().name(name.to_owned()).spawn(work).map(drop);
    #[cfg(target_family = "wasm")]
    {
        let _ = name;
        wasm_bindgen_futures::spawn_local(async {
            next_turn().await;
            work();
        });
        Ok(())
    }
}

/// Runs asynchronous work in the background. While it waits, a browser goes on with frames.
///
/// # Errors
///
/// If the system cannot start a thread.
#[cfg(not(target_family = "wasm"))]
pub fn in_background_async<F: Future<Output = ()>>(
    name: &str,
    work: impl FnOnce() -> F + Send + 'static,
) -> io::Result<()> {
    in_background(name, || pollster::block_on(work()))
}

/// Runs asynchronous work in the background. While it waits, a browser goes on with frames.
///
/// # Errors
///
/// Never, in a browser.
#[cfg(target_family = "wasm")]
pub fn in_background_async<F: Future<Output = ()> + 'static>(
    _: &str,
    work: impl FnOnce() -> F + Send + 'static,
) -> io::Result<()> {
    wasm_bindgen_futures::spawn_local(work());
    Ok(())
}

/// Lets a browser draw and take input. Returns at once on other platforms.
pub async fn next_turn() {
    #[cfg(target_family = "wasm")]
    gloo_timers::future::TimeoutFuture::new(0).await;
}
