//! The functions that C calls. The order is the order of use.

use core::ffi::{CStr, c_char};

use shadowfit::glam::{DVec3, Vec3};
use shadowfit::uniform::{CasterUniform, DemandUniform, ReceiverUniform};

use crate::constants::{ShadowfitCasterConstants, ShadowfitDemandConstants, ShadowfitReceiverConstants};
use crate::demand::DepthBuffer;
use crate::error::{Failure, ShadowfitResult};
use crate::fit::Frame;
use crate::pointer::{self, BoxList, DepthRead, GivenCounts, Indices, Output};
use crate::state::{Memory, ShadowfitState};
use crate::types::{
    SHADOWFIT_MAX_VIEWS, SHADOWFIT_VERSION, ShadowfitBias, ShadowfitBoxes, ShadowfitCamera, ShadowfitDepths,
    ShadowfitFilter, ShadowfitFrame, ShadowfitMaps, ShadowfitProof, ShadowfitRect, ShadowfitTechnique, ShadowfitUpdate,
    ShadowfitView,
};
use crate::{bias, cache, casters, constants, fit, proof, state, technique, view};

/// Runs a call on a state. Stores the text of its error.
unsafe fn call<'a>(
    pointer: *mut ShadowfitState,
    call: impl FnOnce(Memory<'a>) -> Result<(), Failure>,
) -> ShadowfitResult {
    // SAFETY: as for the caller.
    let memory = match unsafe { pointer::open(pointer) } {
        Ok(memory) => memory,
        Err(code) => return code,
    };
    let Err(failure) = call(memory) else { return ShadowfitResult::ShadowfitOk };
    // SAFETY: as above. The call has ended, so nothing else refers to the memory.
    if let Ok(memory) = unsafe { pointer::open(pointer) } {
        memory.state.error = failure.text;
    }
    failure.code
}

/// Returns the size in bytes of a state for lists of up to `max_boxes` boxes.
#[unsafe(no_mangle)]
pub extern "C" fn shadowfit_state_size(max_boxes: usize) -> usize {
    state::size(max_boxes).unwrap_or(usize::MAX)
}

/// Makes a state with the technique "windows-4" in a buffer, such as malloc(shadowfit_state_size(1000)).
/// `*size` is the size of the buffer. If it is too small, it becomes the size that is needed. Pass
/// `SHADOWFIT_VERSION` as `version`. To free the state, free the buffer.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shadowfit_init(
    buffer: *mut ShadowfitState,
    size: *mut usize,
    max_boxes: usize,
    version: u32,
) -> ShadowfitResult {
    if version != SHADOWFIT_VERSION {
        return ShadowfitResult::ShadowfitOtherVersion;
    }
    // SAFETY: as for the caller.
    match unsafe { pointer::create(buffer, size, max_boxes) } {
        Ok(()) => ShadowfitResult::ShadowfitOk,
        Err(code) => code,
    }
}

/// Returns a sentence about the last error of a state, in UTF-8. It is valid until the next error.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shadowfit_error(state: *const ShadowfitState) -> *const c_char {
    // SAFETY: as for the caller.
    match unsafe { pointer::peek(state) } {
        Ok(state) => state.error.as_c_str().as_ptr(),
        Err(code) => code.text().as_ptr(),
    }
}

/// Returns a sentence about a result, for calls without a valid state.
#[unsafe(no_mangle)]
pub extern "C" fn shadowfit_result_text(result: u32) -> *const c_char {
    ShadowfitResult::ALL.get(result as usize).map_or(c"this is no result of shadowfit", |code| code.text()).as_ptr()
}

/// Forgets all earlier frames. Call it after a camera cut or when a level begins.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shadowfit_reset(state: *mut ShadowfitState) -> ShadowfitResult {
    // SAFETY: as for the caller.
    unsafe {
        call(state, |memory| {
            memory.state.reset();
            Ok(())
        })
    }
}

/// Returns the name of a preset by its index from 0 on, or null behind the last one.
#[unsafe(no_mangle)]
pub extern "C" fn shadowfit_preset(index: usize) -> *const c_char {
    technique::preset_name(index).map_or(core::ptr::null(), CStr::as_ptr)
}

/// Sets the technique to a preset, such as "windows-4".
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shadowfit_set_preset(state: *mut ShadowfitState, name: *const c_char) -> ShadowfitResult {
    // SAFETY: as for the caller.
    unsafe {
        call(state, |memory| {
            let name = pointer::text(name, pointer::length(name))
                .map_err(|failure| failure.with_code_unless_null(ShadowfitResult::ShadowfitUnknownPreset))?;
            memory.state.set_technique(&technique::preset(name)?);
            Ok(())
        })
    }
}

/// Changes the parameters of the technique that a TOML text names: a file of the viewer, or a few lines such as
/// `"[map]\nresolution = 1024\nfilter = \"pcf_3x3\""`. An error changes nothing.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shadowfit_set_technique(
    state: *mut ShadowfitState,
    toml: *const c_char,
    length: usize,
) -> ShadowfitResult {
    // SAFETY: as for the caller.
    unsafe {
        call(state, |memory| {
            let technique = technique::with_text(&memory.state.technique, pointer::text(toml, length)?)?;
            memory.state.set_technique(&technique);
            Ok(())
        })
    }
}

/// Writes the parts of the technique that create textures and choose shaders.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shadowfit_technique(
    state: *mut ShadowfitState,
    technique: *mut ShadowfitTechnique,
) -> ShadowfitResult {
    // SAFETY: as for the caller.
    unsafe {
        call(state, |memory| {
            Output::new(technique)?.write(technique::written(&memory.state.technique));
            Ok(())
        })
    }
}

/// Writes the view of a camera.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shadowfit_view_from_camera(
    state: *mut ShadowfitState,
    camera: *const ShadowfitCamera,
    view: *mut ShadowfitView,
) -> ShadowfitResult {
    // SAFETY: as for the caller.
    unsafe {
        call(state, |_| {
            Output::new(view)?.write(view::from_camera(&pointer::read(camera)?)?);
            Ok(())
        })
    }
}

/// Writes the view of a matrix from world positions to clip space: projection times view, multiplied in double. `eye`
/// is the camera's position, and `depth` is SHADOWFIT_DEPTH_....
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shadowfit_view_from_matrix(
    state: *mut ShadowfitState,
    clip_from_world: *const f64,
    eye: *const f64,
    depth: u32,
    view: *mut ShadowfitView,
) -> ShadowfitResult {
    // SAFETY: as for the caller.
    unsafe {
        call(state, |memory| {
            let output = Output::new(view)?;
            let (matrix, eye) = (pointer::numbers(clip_from_world)?, pointer::numbers(eye)?);
            let end = memory.state.technique.fit.max_distance;
            output.write(view::from_matrix(&matrix, DVec3::from_array(eye), depth, end)?);
            Ok(())
        })
    }
}

/// Sets the visible surfaces of an earlier frame, so that fits place the maps better and faster. Null forgets them.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shadowfit_set_visible_depths(
    state: *mut ShadowfitState,
    depths: *const ShadowfitDepths,
) -> ShadowfitResult {
    // SAFETY: as for the caller.
    unsafe {
        call(state, |memory| {
            if depths.is_null() {
                memory.state.seen = None;
                return Ok(());
            }
            let depths = pointer::read(depths)?;
            let rows = DepthRead::new(&depths)?;
            DepthBuffer::new(&depths, &pointer::read(depths.view)?)?.count(memory, rows)
        })
    }
}

/// Writes the constant block of the demand shader for a depth buffer on the GPU: `depths->depths` is ignored, and
/// `row_stride` is negative if its texture's rows begin at the bottom.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shadowfit_demand_constants(
    state: *mut ShadowfitState,
    depths: *const ShadowfitDepths,
    constants: *mut ShadowfitDemandConstants,
) -> ShadowfitResult {
    // SAFETY: as for the caller. Both structs have the same size, and any bits are words.
    unsafe {
        call(state, |memory| {
            let depths = pointer::read(depths)?;
            let block = DepthBuffer::new(&depths, &pointer::read(depths.view)?)?.uniform(memory.state)?;
            pointer::write(constants.cast::<DemandUniform>(), block)?;
            Ok(())
        })
    }
}

/// As `shadowfit_set_visible_depths`, with the SHADOWFIT_COUNTS numbers that the demand shader wrote for `depths`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shadowfit_set_visible_counts(
    state: *mut ShadowfitState,
    depths: *const ShadowfitDepths,
    counts: *const u32,
) -> ShadowfitResult {
    // SAFETY: as for the caller.
    unsafe {
        call(state, |memory| {
            let depths = pointer::read(depths)?;
            let counts = GivenCounts::new(counts)?;
            DepthBuffer::new(&depths, &pointer::read(depths.view)?)?.set_counts(memory, &counts)
        })
    }
}

/// Fits the maps of a frame. If it fails, draw the frame without shadows.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shadowfit_fit(
    state: *mut ShadowfitState,
    frame: *const ShadowfitFrame,
    maps: *mut ShadowfitMaps,
) -> ShadowfitResult {
    // SAFETY: as for the caller.
    unsafe {
        call(state, |Memory { state, scratch, counts, boxes }| {
            state.begin_fit();
            let (output, frame) = (Output::new(maps)?, read_frame(frame)?);
            fit::fit(Memory { state: &mut *state, scratch, counts, boxes }, &frame)?;
            output.write(fit::written(&state.fitted, frame.origin));
            Ok(())
        })
    }
}

/// Writes the indices of the boxes to draw into a map of the last fit, and their number. `which` is
/// SHADOWFIT_CASTERS_.... `rect` is null, or a rectangle of `shadowfit_update`. If there are more than `capacity`,
/// the first ones are written, and the result is `SHADOWFIT_TOO_SMALL`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shadowfit_casters(
    state: *mut ShadowfitState,
    map: u32,
    rect: *const ShadowfitRect,
    which: u32,
    boxes: *const ShadowfitBoxes,
    indices: *mut u32,
    capacity: usize,
    count: *mut usize,
) -> ShadowfitResult {
    // SAFETY: as for the caller.
    unsafe {
        call(state, |memory| {
            pointer::write(count, 0)?;
            let rect = if rect.is_null() { None } else { Some(rect.read_unaligned()) };
            let indices = Indices::new(indices, capacity)?;
            let list = pointer::boxes(boxes)?;
            let origin = list.map_or(DVec3::ZERO, |list| list.origin);
            let volume = casters::volume(memory.state, map, rect.as_ref(), which, origin)?;
            let Some(list) = list else { return Ok(()) };
            let drawn = list.iter().zip(0..).filter(|(aabb, _)| volume.intersects_aabb(aabb.min, aabb.max));
            let found = indices.fill(drawn.map(|(_, index)| index));
            pointer::write(count, found)?;
            if found <= capacity {
                return Ok(());
            }
            Err(Failure::new(
                ShadowfitResult::ShadowfitTooSmall,
                format_args!("{found} casters were found, but there is room for {capacity} indices"),
            ))
        })
    }
}

/// Says which parts of a kept map to draw again, with all static casters. Call it for each map after each fit.
/// `changed` are the old and the new boxes of static casters that came, went or moved, or null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shadowfit_update(
    state: *mut ShadowfitState,
    map: u32,
    changed: *const ShadowfitBoxes,
    update: *mut ShadowfitUpdate,
) -> ShadowfitResult {
    // SAFETY: as for the caller.
    unsafe {
        call(state, |memory| {
            let output = Output::new(update)?;
            let changed = if changed.is_null() { None } else { pointer::boxes(changed)? };
            output.write(cache::update(memory.state, map, changed)?);
            Ok(())
        })
    }
}

/// Makes the next updates draw whole maps, such as after the texture was lost.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shadowfit_invalidate(state: *mut ShadowfitState) -> ShadowfitResult {
    // SAFETY: as for the caller.
    unsafe {
        call(state, |memory| {
            memory.state.invalidate();
            Ok(())
        })
    }
}

/// Writes the constant block of the caster shader for a map of the last fit.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shadowfit_caster_constants(
    state: *mut ShadowfitState,
    map: u32,
    constants: *mut ShadowfitCasterConstants,
) -> ShadowfitResult {
    // SAFETY: as for the caller. Both structs have the same layout, which a test compares.
    unsafe {
        call(state, |memory| {
            let block = constants::caster(memory.state, map)?;
            pointer::write(constants.cast::<CasterUniform>(), block)?;
            Ok(())
        })
    }
}

/// Writes the constant block of the look-up for the last fit.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shadowfit_receiver_constants(
    state: *mut ShadowfitState,
    constants: *mut ShadowfitReceiverConstants,
) -> ShadowfitResult {
    // SAFETY: as for the caller. Both structs have the same layout, which a test compares.
    unsafe {
        call(state, |memory| {
            let block = constants::receiver(memory.state)?;
            pointer::write(constants.cast::<ReceiverUniform>(), block)?;
            Ok(())
        })
    }
}

/// Writes the smallest bias that clears planes for a filter of your own shader, for a map of the last fit.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shadowfit_bias(
    state: *mut ShadowfitState,
    map: u32,
    filter: *const ShadowfitFilter,
    bias: *mut ShadowfitBias,
) -> ShadowfitResult {
    // SAFETY: as for the caller.
    unsafe {
        call(state, |memory| {
            let (filter, origin) = (pointer::read(filter)?, memory.state.last()?.origin);
            let map = memory.state.map(map)?.projection.relative_to(origin);
            let found = bias::of_filter(&filter, &map, memory.state.technique.fit.up)?;
            pointer::write(bias, bias::written(&found))?;
            Ok(())
        })
    }
}

/// Proves, for debug builds, that a map of the last fit holds all receivers and casters of the same frame.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shadowfit_prove(
    state: *mut ShadowfitState,
    frame: *const ShadowfitFrame,
    map: u32,
    proof: *mut ShadowfitProof,
) -> ShadowfitResult {
    // SAFETY: as for the caller.
    unsafe {
        call(state, |memory| {
            let (output, frame) = (Output::new(proof)?, read_frame(frame)?);
            output.write(proof::proof(memory, &frame, map)?);
            Ok(())
        })
    }
}

/// Reads a frame and its views.
unsafe fn read_frame(pointer: *const ShadowfitFrame) -> Result<Frame, Failure> {
    // SAFETY: as for the caller.
    unsafe {
        let frame = pointer::read(pointer)?;
        let view_count = frame.view_count as usize;
        if !(1..=SHADOWFIT_MAX_VIEWS).contains(&view_count) {
            return Err(Failure::new(
                ShadowfitResult::ShadowfitBadInput,
                format_args!("view_count is {view_count}; give 1 to {SHADOWFIT_MAX_VIEWS}"),
            ));
        }
        let mut views = [view::frustum(&pointer::read_at(frame.views, 0)?); SHADOWFIT_MAX_VIEWS];
        for (index, view) in views.iter_mut().enumerate().take(view_count).skip(1) {
            *view = view::frustum(&pointer::read_at(frame.views, index)?);
        }
        Ok(Frame {
            views,
            view_count,
            direction: Vec3::from_array(frame.light_direction),
            number: frame.number,
            origin: pointer::position(frame.origin)?,
            receivers: BoxList::new(&frame.receivers)?,
            casters: BoxList::new(&frame.casters)?,
        })
    }
}
