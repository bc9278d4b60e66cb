//! Parallel creation of pipelines: a driver may compile a large shader for seconds, on the calling thread.

#[cfg(not(target_family = "wasm"))]
use std::thread;

#[cfg(not(target_family = "wasm"))]
use crate::errors::catch_errors;

/// Stack size of a compiling thread, in bytes. It is as large as a main thread's, because shader compilers
/// recurse.
#[cfg(not(target_family = "wasm"))]
const STACK: usize = 8 << 20;

/// Calls `make` for each kind in parallel, on up to one thread per core, and returns the results in the order
/// of the kinds. In browsers and on OpenGL the calls run one after the other.
///
/// `make` may run twice for a kind: if the device reports an error on a thread, it runs again on the calling
/// thread, so that this thread's error scopes and handlers receive the error.
pub fn make_at_once<K, T>(device: &wgpu::Device, kinds: &[K], make: impl Fn(&K) -> T + wgpu::WasmNotSync) -> Vec<T>
where
    K: wgpu::WasmNotSync,
    T: wgpu::WasmNotSend,
{
    #[cfg(target_family = "wasm")]
    {
        let _ = device;
        kinds.iter().map(make).collect()
    }
    #[cfg(not(target_family = "wasm"))]
    {
        let cores = thread::available_parallelism().map_or(1, Into::into);
        // OpenGL's context belongs to one thread at a time.
        let one_by_one = device.adapter_info().backend == wgpu::Backend::Gl;
        if one_by_one || kinds.len().min(cores) <= 1 {
            return kinds.iter().map(make).collect();
        }
        let make = &make;
        let on_thread = |kind| move || catch_errors(device, || make(kind)).ok();
        let mut made = Vec::new();
        for some in kinds.chunks(cores) {
            let found: Vec<Option<T>> = thread::scope(|scope| {
                let spawn = |kind| thread::Builder::new().stack_size(STACK).spawn_scoped(scope, on_thread(kind)).ok();
                let threads: Vec<_> = some.iter().map(spawn).collect();
                threads.into_iter().map(|thread| thread?.join().ok().flatten()).collect()
            });
            made.extend(found.into_iter().zip(some).map(|(found, kind)| found.unwrap_or_else(|| make(kind))));
        }
        made
    }
}
