//! The functions of the module. Each runs on the one fitter of the instance. Addresses are valid until the
//! next call, because memory may grow.
#![allow(unsafe_code, reason = "an exported name must be unique in the program")]

use spin::Mutex;

use crate::error::ErrorNumbers;
use crate::fitter::{Drawn, Fitter};

/// The fitter of this instance. A module has one thread, so the lock is always free.
static FITTER: Mutex<Option<Fitter>> = Mutex::new(None);

fn with<T>(call: impl FnOnce(&mut Fitter) -> T) -> T {
    call(FITTER.lock().get_or_insert_with(Fitter::new))
}

/// Returns the address of the settings.
#[unsafe(no_mangle)]
extern "C" fn settings() -> *mut f64 {
    with(|fitter| fitter.settings_numbers.as_mut_ptr())
}

/// Reads the settings.
#[unsafe(no_mangle)]
extern "C" fn configure() {
    with(Fitter::configure);
}

/// Returns the address of the frame's light and views.
#[unsafe(no_mangle)]
extern "C" fn input() -> *mut f64 {
    with(|fitter| fitter.input.as_mut_ptr())
}

/// Makes room for boxes relative to a position, and returns their address.
#[unsafe(no_mangle)]
extern "C" fn boxes(count: usize, x: f64, y: f64, z: f64) -> *mut f32 {
    with(|fitter| {
        fitter.set_count(count);
        fitter.origin = shadowfit::glam::DVec3::new(x, y, z);
        fitter.boxes.as_mut_ptr().cast()
    })
}

/// Returns the address of the boxes' flags.
#[unsafe(no_mangle)]
extern "C" fn flags() -> *mut u8 {
    with(|fitter| fitter.flags.as_mut_ptr())
}

/// Fits the maps. Returns their number, or -1 for an error.
#[unsafe(no_mangle)]
extern "C" fn fit() -> i32 {
    with(|fitter| {
        let fitted = fitter.fit();
        fitter.error = fitted.map_or_else(ErrorNumbers::from, |_| ErrorNumbers::default());
        fitted.map_or(-1, |count| count as i32)
    })
}

/// Returns the address of the maps.
#[unsafe(no_mangle)]
extern "C" fn maps() -> *const f64 {
    with(|fitter| fitter.maps.as_ptr().cast())
}

/// Finds the casters of each map, for this frame or for kept maps, and returns the address of the masks.
#[unsafe(no_mangle)]
extern "C" fn casters(kept: u32) -> *const u8 {
    with(|fitter| {
        fitter.cull(if kept == 0 { Drawn::ThisFrame } else { Drawn::Kept });
        fitter.masks.as_ptr()
    })
}

/// Makes room for depths, and returns their address.
#[unsafe(no_mangle)]
extern "C" fn depths(count: usize) -> *mut f32 {
    with(|fitter| {
        fitter.depths.resize(count, 0.0);
        fitter.depths.as_mut_ptr()
    })
}

/// Counts the surfaces in the depths. Returns 0, or the number of an error.
#[unsafe(no_mangle)]
extern "C" fn count_depths(width: u32) -> u32 {
    with(|fitter| {
        let error = fitter.count_depths(width).map_or_else(ErrorNumbers::from, |()| ErrorNumbers::default());
        fitter.error = error;
        error.code
    })
}

/// Forgets the counted surfaces.
#[unsafe(no_mangle)]
extern "C" fn forget_depths() {
    with(Fitter::forget_depths);
}

/// Forgets all earlier frames.
#[unsafe(no_mangle)]
extern "C" fn reset() {
    with(Fitter::reset);
}

/// Returns the number of the last error, 0 for none.
#[unsafe(no_mangle)]
extern "C" fn error() -> u32 {
    with(|fitter| fitter.error.code)
}

/// Returns a value of the last error, by its index of 0 to 2.
#[unsafe(no_mangle)]
extern "C" fn error_value(index: usize) -> f64 {
    with(|fitter| fitter.error.values.get(index).copied().unwrap_or_default())
}

/// Returns the address of the name of the last error's input, in UTF-8.
#[unsafe(no_mangle)]
extern "C" fn error_input() -> *const u8 {
    with(|fitter| fitter.error.input.as_ptr())
}

/// Returns the length of that name, in bytes.
#[unsafe(no_mangle)]
extern "C" fn error_input_length() -> usize {
    with(|fitter| fitter.error.input.len())
}
