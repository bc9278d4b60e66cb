//! Reading and writing through the pointers of callers. Everything else works on references.
//!
//! All functions here accept null and misaligned pointers. A pointer that is not null must point to memory of
//! the stated size.
#![allow(clippy::cast_ptr_alignment, reason = "checked, or read without alignment")]

use shadowfit::demand::Counts;
use shadowfit::glam::{DVec2, DVec3, Vec3};
use shadowfit::{Aabb, Boxes};

use crate::error::{Failure, ShadowfitResult as Code};
use crate::state::{Header, Memory, ShadowfitState, State, scratch, size};
use crate::types::{
    ShadowfitBoxes, ShadowfitCamera, ShadowfitDepths, ShadowfitFilter, ShadowfitFrame, ShadowfitMaps, ShadowfitProof,
    ShadowfitTechnique, ShadowfitUpdate, ShadowfitView,
};

/// A struct that begins with its size as a `u32`, and whose members may have any bits.
///
/// # Safety
///
/// Both must be true.
pub(crate) unsafe trait Sized32: Copy {}

macro_rules! sized {
    ($($kind:ty),+) => {
        // SAFETY: `size` is the first member, the struct is `repr(C)`, and all members are numbers and pointers.
        $(unsafe impl Sized32 for $kind {})+
    };
}

sized!(
    ShadowfitCamera,
    ShadowfitDepths,
    ShadowfitFilter,
    ShadowfitFrame,
    ShadowfitMaps,
    ShadowfitProof,
    ShadowfitTechnique,
    ShadowfitUpdate,
    ShadowfitView
);

/// Returns an error unless the struct's `size` is the size that this library knows.
unsafe fn check_size<T: Sized32>(pointer: *const T) -> Result<(), Code> {
    if pointer.is_null() {
        return Err(Code::ShadowfitNullPointer);
    }
    // SAFETY: the struct begins with a `u32`.
    let size = unsafe { pointer.cast::<u32>().read_unaligned() };
    if size as usize == size_of::<T>() { Ok(()) } else { Err(Code::ShadowfitOtherVersion) }
}

/// Reads a struct.
pub(crate) unsafe fn read<T: Sized32>(pointer: *const T) -> Result<T, Code> {
    // SAFETY: the caller's struct has the size that it states.
    unsafe {
        check_size(pointer)?;
        Ok(pointer.read_unaligned())
    }
}

/// Reads an element of an array of structs.
pub(crate) unsafe fn read_at<T: Sized32>(array: *const T, index: usize) -> Result<T, Code> {
    if array.is_null() {
        return Err(Code::ShadowfitNullPointer);
    }
    // SAFETY: the caller's array has an element of this index.
    unsafe { read(array.add(index)) }
}

/// A struct of the caller to write a result into. It keeps its `size`.
pub(crate) struct Output<T>(*mut T);

impl<T: Sized32> Output<T> {
    pub(crate) unsafe fn new(pointer: *mut T) -> Result<Self, Code> {
        // SAFETY: as for the caller.
        unsafe { check_size(pointer)? };
        Ok(Self(pointer))
    }

    pub(crate) fn write(self, value: T) {
        // SAFETY: `new` checked the pointer and the size.
        unsafe { self.0.write_unaligned(value) }
    }
}

/// Reads numbers of an array.
pub(crate) unsafe fn numbers<const COUNT: usize>(pointer: *const f64) -> Result<[f64; COUNT], Code> {
    if pointer.is_null() {
        return Err(Code::ShadowfitNullPointer);
    }
    // SAFETY: the caller's array has this many numbers.
    Ok(unsafe { pointer.cast::<[f64; COUNT]>().read_unaligned() })
}

/// The caller's counts of visible surfaces.
pub(crate) struct GivenCounts(*const Counts);

impl GivenCounts {
    pub(crate) unsafe fn new(pointer: *const u32) -> Result<Self, Code> {
        if pointer.is_null() { Err(Code::ShadowfitNullPointer) } else { Ok(Self(pointer.cast())) }
    }

    pub(crate) fn copy(&self, into: &mut Counts) {
        // SAFETY: the caller's array has this many numbers and does not overlap.
        unsafe { core::ptr::copy_nonoverlapping(self.0.cast::<u8>(), into.as_mut_ptr().cast(), size_of::<Counts>()) }
    }
}

/// Greatest coordinate of an origin, in metres, as for eyes.
const MAX_ORIGIN: f64 = 1e18;

/// Returns the position of an origin, or an error for coordinates that are not finite or too large.
pub(crate) fn position(position: [f64; 3]) -> Result<DVec3, Failure> {
    let position = DVec3::from_array(position);
    if position.is_finite() && position.abs().max_element() <= MAX_ORIGIN {
        return Ok(position);
    }
    Err(Failure::new(
        Code::ShadowfitBadInput,
        format_args!("an origin is {position}; give numbers from -{MAX_ORIGIN:e} to {MAX_ORIGIN:e}"),
    ))
}

/// Reads a list of finite boxes.
pub(crate) unsafe fn boxes(pointer: *const ShadowfitBoxes) -> Result<Option<BoxList>, Failure> {
    if pointer.is_null() {
        return Err(Code::ShadowfitNullPointer.into());
    }
    // SAFETY: as for the caller.
    let list = unsafe { BoxList::new(&pointer.read_unaligned()) }?;
    list.map(BoxList::check).transpose()
}

/// Writes a value without a size.
pub(crate) unsafe fn write<T>(pointer: *mut T, value: T) -> Result<(), Code> {
    if pointer.is_null() {
        return Err(Code::ShadowfitNullPointer);
    }
    // SAFETY: the caller's pointer is for a `T`.
    unsafe { pointer.write_unaligned(value) };
    Ok(())
}

/// Creates a state in a buffer. The size is the buffer's size, or becomes the needed one.
pub(crate) unsafe fn create(pointer: *mut ShadowfitState, given: *mut usize, max_boxes: usize) -> Result<(), Code> {
    if pointer.is_null() || given.is_null() {
        return Err(Code::ShadowfitNullPointer);
    }
    // SAFETY: `given` points to a `size_t`.
    let available = unsafe { given.read_unaligned() };
    let needed = size(max_boxes);
    let Some(needed) = needed.filter(|needed| *needed <= available) else {
        // SAFETY: as above.
        unsafe { given.write_unaligned(needed.unwrap_or(usize::MAX)) };
        return Err(Code::ShadowfitTooSmall);
    };
    let state = pointer.cast::<State>();
    if !state.is_aligned() {
        return Err(Code::ShadowfitMisaligned);
    }
    // SAFETY: the buffer is aligned and large enough for the state and for the memory behind it, which is set to
    // zeros, the bits of valid numbers.
    unsafe {
        state.write(State::new(Header::new(available, max_boxes)));
        let behind = state.add(1).cast::<u8>();
        behind.write_bytes(0, needed - size_of::<State>());
    }
    Ok(())
}

/// Returns the parts of a buffer that [`create`] has made.
pub(crate) unsafe fn open<'a>(pointer: *mut ShadowfitState) -> Result<Memory<'a>, Code> {
    // SAFETY: as for the caller.
    let max_boxes = unsafe { header(pointer)? }.max_boxes;
    let state = pointer.cast::<State>();
    // SAFETY: the header says that the state was written here, that the buffer holds the memory behind it, and
    // `State` keeps all parts aligned. They do not overlap.
    unsafe {
        let elements = state.add(1).cast::<DVec2>();
        let counts = elements.add(scratch(max_boxes)).cast::<Counts>();
        let lists = counts.add(1).cast::<Aabb>();
        Ok(Memory {
            state: &mut *state,
            scratch: core::slice::from_raw_parts_mut(elements, scratch(max_boxes)),
            counts: &mut *counts,
            boxes: [
                core::slice::from_raw_parts_mut(lists, max_boxes),
                core::slice::from_raw_parts_mut(lists.add(max_boxes), max_boxes),
            ],
        })
    }
}

/// Returns the state for reading.
pub(crate) unsafe fn peek<'a>(pointer: *const ShadowfitState) -> Result<&'a State, Code> {
    // SAFETY: the header says that the state was written here.
    unsafe {
        header(pointer)?;
        Ok(&*pointer.cast::<State>())
    }
}

/// Reads the header of a buffer, and returns an error unless it is a state of this library.
unsafe fn header(pointer: *const ShadowfitState) -> Result<Header, Code> {
    if pointer.is_null() {
        return Err(Code::ShadowfitNullPointer);
    }
    if !pointer.cast::<State>().is_aligned() {
        return Err(Code::ShadowfitMisaligned);
    }
    // SAFETY: a buffer is at least as large as a header, whose members may have any bits.
    let header = unsafe { pointer.cast::<Header>().read() };
    header.check()?;
    Ok(header)
}

/// A list of boxes of the caller.
#[derive(Clone, Copy)]
pub(crate) struct BoxList {
    first: *const u8,
    count: usize,
    stride: usize,
    pub(crate) origin: DVec3,
}

impl BoxList {
    /// Returns the list, or `None` if its boxes are unknown.
    pub(crate) unsafe fn new(boxes: &ShadowfitBoxes) -> Result<Option<Self>, Failure> {
        let ShadowfitBoxes { min_max, count, stride, origin } = *boxes;
        if min_max.is_null() {
            return if count == 0 { Ok(None) } else { Err(Code::ShadowfitNullPointer.into()) };
        }
        let least = size_of::<Aabb>();
        if stride != 0 && stride < least {
            return Err(Failure::new(
                Code::ShadowfitBadInput,
                format_args!("the stride of boxes is {stride} bytes; give 0 or at least {least}"),
            ));
        }
        let stride = if stride == 0 { least } else { stride };
        if count.checked_mul(stride).is_none_or(|bytes| bytes > isize::MAX as usize) {
            return Err(Failure::new(
                Code::ShadowfitBadInput,
                format_args!("{count} boxes of {stride} bytes exceed the memory of this machine"),
            ));
        }
        Ok(Some(Self { first: min_max.cast(), count, stride, origin: position(origin)? }))
    }

    pub(crate) const fn count(&self) -> usize {
        self.count
    }

    /// Refuses boxes with numbers that are not finite.
    pub(crate) fn check(self) -> Result<Self, Failure> {
        let is_bad = |aabb: &Aabb| !(aabb.min.is_finite() && aabb.max.is_finite());
        let Some((index, Aabb { min, max })) = self.iter().enumerate().find(|(_, aabb)| is_bad(aabb)) else {
            return Ok(self);
        };
        Err(Failure::new(Code::ShadowfitBadInput, format_args!("box {index} is {min} to {max}; give finite numbers")))
    }

    /// Returns the boxes one by one.
    pub(crate) fn iter(self) -> impl Iterator<Item = Aabb> {
        (0..self.count).map(move |index| {
            // SAFETY: `new` checked the list, and the caller's array has this many boxes.
            let [a, b, c, d, e, f] = unsafe { self.first.add(index * self.stride).cast::<[f32; 6]>().read_unaligned() };
            Aabb::new(Vec3::new(a, b, c), Vec3::new(d, e, f))
        })
    }

    /// Returns the boxes as a slice: the caller's array, or a copy if that has gaps or is misaligned.
    pub(crate) fn gathered(self, copy: &mut [Aabb]) -> Boxes<'_> {
        let boxes = if self.stride == size_of::<Aabb>() && self.first.cast::<Aabb>().is_aligned() {
            // SAFETY: `new` checked the list, and the caller's array has this many boxes.
            unsafe { core::slice::from_raw_parts(self.first.cast::<Aabb>(), self.count) }
        } else {
            let copy = &mut copy[..self.count];
            copy.iter_mut().zip(self.iter()).for_each(|(copy, aabb)| *copy = aabb);
            copy
        };
        Boxes { origin: self.origin, boxes }
    }
}

/// The depths of a caller's depth buffer.
#[derive(Clone, Copy)]
pub(crate) struct DepthRead {
    first: *const u8,
    row_stride: isize,
}

impl DepthRead {
    pub(crate) unsafe fn new(depths: &ShadowfitDepths) -> Result<Self, Failure> {
        let ShadowfitDepths { width, height, depths, row_stride, .. } = *depths;
        if depths.is_null() {
            return Err(Code::ShadowfitNullPointer.into());
        }
        let row = (width as usize).saturating_mul(size_of::<f32>());
        let is_short = row_stride != 0 && row_stride.unsigned_abs() < row;
        let stride = if row_stride == 0 { row.cast_signed() } else { row_stride };
        let bytes = (height as usize).checked_mul(stride.unsigned_abs());
        if is_short || bytes.is_none_or(|bytes| bytes > isize::MAX as usize) {
            return Err(Failure::new(
                Code::ShadowfitBadInput,
                format_args!("the stride of depth rows is {row_stride} bytes; give 0 or at least {row}"),
            ));
        }
        Ok(Self { first: depths.cast(), row_stride: stride })
    }

    /// Returns the depth at a column and a row inside the picture.
    pub(crate) fn at(self, x: usize, y: usize) -> f32 {
        // SAFETY: `new` checked the rows, and the caller's picture has this pixel.
        unsafe { self.first.offset(y.cast_signed() * self.row_stride).cast::<f32>().add(x).read_unaligned() }
    }
}

/// Returns the text of a caller, or an error if it is not UTF-8.
pub(crate) unsafe fn text<'a>(pointer: *const core::ffi::c_char, length: usize) -> Result<&'a str, Failure> {
    if pointer.is_null() {
        return Err(Code::ShadowfitNullPointer.into());
    }
    if length > isize::MAX as usize {
        return Err(Failure::new(
            Code::ShadowfitBadInput,
            format_args!("the text has {length} bytes, which is too long"),
        ));
    }
    // SAFETY: the caller's text has this many bytes.
    let bytes = unsafe { core::slice::from_raw_parts(pointer.cast::<u8>(), length) };
    core::str::from_utf8(bytes).map_err(|error| {
        let at = error.valid_up_to();
        Failure::new(Code::ShadowfitBadTechnique, format_args!("the text is not UTF-8 from byte {at} on"))
    })
}

/// Returns the length of a text that ends with a zero byte; 0 for null.
pub(crate) unsafe fn length(pointer: *const core::ffi::c_char) -> usize {
    // SAFETY: the caller's text ends with a zero byte.
    if pointer.is_null() { 0 } else { unsafe { core::ffi::CStr::from_ptr(pointer) }.count_bytes() }
}

/// Indices of the caller to write into.
pub(crate) struct Indices {
    first: *mut u32,
    capacity: usize,
}

impl Indices {
    pub(crate) unsafe fn new(first: *mut u32, capacity: usize) -> Result<Self, Code> {
        if first.is_null() && capacity > 0 { Err(Code::ShadowfitNullPointer) } else { Ok(Self { first, capacity }) }
    }

    /// Writes numbers up to the capacity. Returns the count of all.
    pub(crate) fn fill(&self, numbers: impl Iterator<Item = u32>) -> usize {
        let mut count = 0;
        for number in numbers {
            if count < self.capacity {
                // SAFETY: the caller's array has this many numbers.
                unsafe { self.first.add(count).write_unaligned(number) };
            }
            count += 1;
        }
        count
    }
}
