//! The fit of a frame.

use shadowfit::glam::{DVec3, Mat4, Vec3};
use shadowfit::{FitError, FitInput, FittedMap, FittedMaps, PlacementSource, Scratch, ViewFrustum};

use crate::error::{Failure, ShadowfitResult as Code};
use crate::pointer::BoxList;
use crate::state::{LastFrame, Memory, size};
use crate::types::{SHADOWFIT_MAX_MAPS, SHADOWFIT_MAX_VIEWS, ShadowfitBias, ShadowfitMap, ShadowfitMaps};

/// The views, the light and the boxes of a frame.
pub(crate) struct Frame {
    pub(crate) views: [ViewFrustum; SHADOWFIT_MAX_VIEWS],
    pub(crate) view_count: usize,
    pub(crate) direction: Vec3,
    pub(crate) number: u32,
    pub(crate) origin: DVec3,
    pub(crate) receivers: Option<BoxList>,
    pub(crate) casters: Option<BoxList>,
}

/// The input of a fit, in the memory of the state.
pub(crate) struct Gathered<'a> {
    pub(crate) input: FitInput<'a>,
    pub(crate) scratch: Scratch<'a>,
}

impl Frame {
    /// Returns the input of a fit without visible demand. Lists that have gaps are copied.
    pub(crate) fn gather<'a>(
        &'a self,
        scratch: &'a mut [shadowfit::glam::DVec2],
        boxes: [&'a mut [shadowfit::Aabb]; 2],
    ) -> Result<Gathered<'a>, Failure> {
        let most = boxes[0].len();
        let longest = self.receivers.iter().chain(&self.casters).map(BoxList::count).max().unwrap_or(0);
        if longest > most {
            return Err(Failure::new(
                Code::ShadowfitTooSmall,
                format_args!(
                    "the state is for {most} boxes in a list, but there are {longest}; make it with {} bytes, the result of \
                     shadowfit_state_size({longest})",
                    size(longest).unwrap_or(usize::MAX)
                ),
            ));
        }
        let [first, second] = boxes;
        let views = self.views.get(..self.view_count).unwrap_or_default();
        let receivers = self.receivers.map(|list| list.gathered(first));
        let casters = self.casters.map(|list| list.gathered(second));
        let input = FitInput { receivers, casters, ..FitInput::new(views, self.direction) };
        Ok(Gathered { input, scratch: Scratch::new(scratch) })
    }
}

/// Fits the maps of a frame.
pub(crate) fn fit(memory: Memory<'_>, frame: &Frame) -> Result<(), Failure> {
    let Memory { state, scratch, counts, boxes } = memory;
    let Gathered { input, mut scratch } = frame.gather(scratch, boxes)?;
    let grid = state.seen.map(|seen| seen.grid(counts));
    let histogram = state.seen.map(|seen| seen.histogram(counts));
    let input = FitInput { demand: grid.as_slice(), histogram, ..input };
    let fitted = state.history.fit_into(&input, &state.technique, &mut scratch, &mut state.fitted);
    if let Err(error) = fitted {
        state.fitted = FittedMaps::default();
        return Err(match error {
            FitError::ScratchTooSmall { given, required } => Failure::new(
                Code::ShadowfitTooSmall,
                format_args!(
                    "the working memory holds {given} elements of {required}; make the state with shadowfit_state_size for \
                     more boxes"
                ),
            ),
            error => error.into(),
        });
    }
    state.frame = Some(LastFrame::new(&frame.views, frame.view_count, frame.origin, frame.number));
    Ok(())
}

/// Returns the maps of a fit as plain data, for positions relative to an origin.
pub(crate) fn written(fitted: &FittedMaps, origin: DVec3) -> ShadowfitMaps {
    let mut maps = ShadowfitMaps {
        size: size_of::<ShadowfitMaps>() as u32,
        count: fitted.len() as u32,
        from_visible_depths: u32::from(fitted.placement == PlacementSource::LastFrame),
        maps: [NO_MAP; SHADOWFIT_MAX_MAPS],
    };
    for (written, map) in maps.maps.iter_mut().zip(fitted.iter()) {
        *written = written_map(&map.relative_to(origin));
    }
    maps
}

const NO_MAP: ShadowfitMap = ShadowfitMap {
    clip_from_world: [0.0; 16],
    uv_from_world: [0.0; 16],
    light_from_world: [0.0; 16],
    bias: ShadowfitBias { constant_depth: 0.0, slope_depth: 0.0, normal_offset: 0.0, receiver_plane: 0.0 },
    texel_size: [0.0; 2],
    depth_range: 0.0,
    end_depth: 0.0,
    resolution: [0; 2],
    is_empty: 1,
};

fn written_map(map: &FittedMap) -> ShadowfitMap {
    let fit = &map.projection;
    let numbers = |matrix: &Mat4| matrix.to_cols_array();
    ShadowfitMap {
        clip_from_world: numbers(&fit.clip_from_world),
        uv_from_world: numbers(&fit.uv_from_world),
        light_from_world: numbers(&fit.light_from_world),
        bias: crate::bias::written(&map.bias),
        texel_size: fit.texel_size.to_array(),
        depth_range: fit.depth_range,
        end_depth: map.shader_end(),
        resolution: fit.resolution.to_array(),
        is_empty: fit.is_empty.into(),
    }
}
