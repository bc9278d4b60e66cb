//! The state between calls, and the memory around it.

use shadowfit::demand::{Counts, VisibleDemandSpace};
use shadowfit::glam::{DVec2, DVec3};
use shadowfit::settings::MAX_MAPS;
use shadowfit::{Aabb, CasterVolume, FitState, FittedMap, FittedMaps, Technique, ViewFrustum};

use crate::error::{Failure, ShadowfitResult as Code, Text};
use crate::types::{SHADOWFIT_MAX_VIEWS, SHADOWFIT_VERSION};

/// Memory of a light's shadows: one buffer of `shadowfit_state_size` bytes that you own. Use one state per light.
/// A state may move to another thread, but no two threads may use it at the same time.
pub struct ShadowfitState {
    _opaque: [u8; 0],
}

/// The first bytes of a buffer, which are checked before the rest is used.
#[repr(C)]
#[derive(Clone, Copy)]
pub(crate) struct Header {
    magic: u32,
    version: u32,
    /// Size of the state, which differs between builds of the library.
    state_size: usize,
    /// Size of the buffer, in bytes.
    pub(crate) size: usize,
    /// Greatest number of boxes in a list.
    pub(crate) max_boxes: usize,
}

/// First bytes of every buffer: "shft".
const MAGIC: u32 = 0x7466_6873;

impl Header {
    pub(crate) const fn new(size: usize, max_boxes: usize) -> Self {
        Self { magic: MAGIC, version: SHADOWFIT_VERSION, state_size: size_of::<State>(), size, max_boxes }
    }

    /// Returns an error for a buffer that is not a state of this library.
    pub(crate) fn check(&self) -> Result<(), Code> {
        let expected = Self::new(self.size, self.max_boxes);
        if self.magic != MAGIC {
            Err(Code::ShadowfitCallInitFirst)
        } else if self.version != expected.version
            || self.state_size != expected.state_size
            || size(self.max_boxes).is_none_or(|needed| needed > self.size)
        {
            Err(Code::ShadowfitOtherVersion)
        } else {
            Ok(())
        }
    }
}

/// Everything that is remembered between calls.
#[repr(C, align(16))]
pub(crate) struct State {
    pub(crate) header: Header,
    pub(crate) technique: Technique,
    pub(crate) history: FitState,
    pub(crate) fitted: FittedMaps,
    /// Space of the counts, if there are any.
    pub(crate) seen: Option<VisibleDemandSpace>,
    pub(crate) frame: Option<LastFrame>,
    pub(crate) kept: [Kept; MAX_MAPS],
    /// Whether maps are kept: `shadowfit_update` was called at least once.
    pub(crate) keeps: bool,
    pub(crate) error: Text,
}

/// The last frame whose fit succeeded.
#[derive(Clone, Copy)]
pub(crate) struct LastFrame {
    views: [ViewFrustum; SHADOWFIT_MAX_VIEWS],
    view_count: usize,
    pub(crate) origin: DVec3,
    pub(crate) number: u32,
    /// Casters of each map that can shadow something in view, once they are asked for.
    pub(crate) volumes: Option<[CasterVolume; MAX_MAPS]>,
}

impl LastFrame {
    pub(crate) fn new(views: &[ViewFrustum; SHADOWFIT_MAX_VIEWS], count: usize, origin: DVec3, number: u32) -> Self {
        Self { views: *views, view_count: count.clamp(1, SHADOWFIT_MAX_VIEWS), origin, number, volumes: None }
    }

    pub(crate) fn views(&self) -> &[ViewFrustum] {
        &self.views[..self.view_count]
    }
}

/// A map whose texels are kept from frame to frame.
#[derive(Clone, Copy, Default)]
pub(crate) struct Kept {
    /// The map that the texels belong to.
    pub(crate) map: Option<FittedMap>,
    /// Whether it is the map of the last fit.
    pub(crate) is_current: bool,
    /// Whether the texels were lost since they were drawn.
    pub(crate) is_lost: bool,
}

impl State {
    pub(crate) fn new(header: Header) -> Self {
        Self {
            header,
            technique: Technique::default(),
            history: FitState::new(),
            fitted: FittedMaps::default(),
            seen: None,
            frame: None,
            kept: [Kept::default(); MAX_MAPS],
            keeps: false,
            error: Text::EMPTY,
        }
    }

    /// Forgets all earlier frames.
    pub(crate) fn reset(&mut self) {
        self.history.reset();
        self.seen = None;
        self.forget_fit();
        self.forget_kept();
    }

    /// Sets another technique. The next fit keeps no map of the old one.
    pub(crate) fn set_technique(&mut self, technique: &Technique) {
        self.technique = *technique;
        self.forget_fit();
        self.forget_kept();
    }

    /// Makes the next updates draw whole maps.
    pub(crate) fn invalidate(&mut self) {
        self.kept.iter_mut().for_each(|kept| kept.is_lost = true);
    }

    /// Forgets all kept maps. Maps need no updates until the next one.
    fn forget_kept(&mut self) {
        self.kept = [Kept::default(); MAX_MAPS];
        self.keeps = false;
    }

    /// Begins a fit. Maps without an update since the last fit may have missed changes, so they are lost.
    pub(crate) fn begin_fit(&mut self) {
        self.forget_fit();
        for kept in &mut self.kept {
            kept.is_lost |= !kept.is_current;
            kept.is_current = false;
        }
    }

    /// Removes the maps of the last fit.
    pub(crate) fn forget_fit(&mut self) {
        self.frame = None;
        self.fitted = FittedMaps::default();
    }

    /// Returns the last frame, or an error that says that a fit is missing.
    pub(crate) fn last(&self) -> Result<&LastFrame, Failure> {
        self.frame.as_ref().ok_or_else(|| Code::ShadowfitCallFitFirst.into())
    }

    /// Returns a map of the last fit.
    pub(crate) fn map(&self, index: u32) -> Result<&FittedMap, Failure> {
        self.last()?;
        let count = self.fitted.len();
        self.fitted.get(index as usize).ok_or_else(|| {
            Failure::new(
                Code::ShadowfitBadInput,
                format_args!("there is no map {index}; the last fit has {count} maps"),
            )
        })
    }
}

/// The parts of a buffer.
pub(crate) struct Memory<'a> {
    pub(crate) state: &'a mut State,
    pub(crate) scratch: &'a mut [DVec2],
    /// Counts of the visible demand.
    pub(crate) counts: &'a mut Counts,
    /// Room for two lists of boxes.
    pub(crate) boxes: [&'a mut [Aabb]; 2],
}

/// Scratch elements for the outline of the content. Most outlines have far fewer corners.
const OUTLINE: usize = 4096;

/// Scratch elements per box of a list: its view depths in each view and in two predicted views, and its extents
/// along the light as a receiver and as a caster.
const PER_BOX: usize = 2 * SHADOWFIT_MAX_VIEWS + 2 + 2 * 4 + 2;

/// Returns the number of scratch elements for lists of this many boxes.
pub(crate) const fn scratch(max_boxes: usize) -> usize {
    max_boxes.saturating_mul(PER_BOX).saturating_add(OUTLINE)
}

/// Returns the size of a buffer for lists of this many boxes, in bytes, or `None` if no buffer is that large.
pub(crate) fn size(max_boxes: usize) -> Option<usize> {
    let lists = max_boxes.checked_mul(2 * size_of::<Aabb>())?;
    let scratch = scratch(max_boxes).checked_mul(size_of::<DVec2>())?;
    let bytes = (size_of::<State>() + size_of::<Counts>()).checked_add(scratch)?.checked_add(lists)?;
    isize::try_from(bytes).is_ok().then_some(bytes)
}
