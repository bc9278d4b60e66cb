//! Work that nobody waits for: on a thread, or in a browser, which has none, between two frames.

use std::io;

/// Does work in the background, on a thread of this name. In a browser it runs once the present frame is done, and
/// frames wait for it.
///
/// # Errors
///
/// When the system gives no thread.
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

/// The same for work that waits now and then, which is when a browser goes on with frames.
///
/// # Errors
///
/// When the system gives no thread.
#[cfg(not(target_family = "wasm"))]
pub fn in_background_async<F: Future<Output = ()>>(
    name: &str,
    work: impl FnOnce() -> F + Send + 'static,
) -> io::Result<()> {
    in_background(name, || pollster::block_on(work()))
}

/// The same for work that waits now and then, which is when a browser goes on with frames.
///
/// # Errors
///
/// None in a browser.
#[cfg(target_family = "wasm")]
pub fn in_background_async<F: Future<Output = ()> + 'static>(
    _: &str,
    work: impl FnOnce() -> F + Send + 'static,
) -> io::Result<()> {
    wasm_bindgen_futures::spawn_local(work());
    Ok(())
}

/// Lets a browser draw and take input before what follows; elsewhere nothing waits.
pub async fn next_turn() {
    #[cfg(target_family = "wasm")]
    gloo_timers::future::TimeoutFuture::new(0).await;
}
