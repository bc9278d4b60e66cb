//! The shadow map of a side, within the limits of the device.

use shadowfit::settings::CasterPolicy;
use shadowfit::{DepthConvention, Technique};
use shadowfit_render::Gpu;
use shadowfit_wgpu::{RESOLUTIONS, ShadowMapDescriptor, ShadowMapError};

use super::Side;
use crate::stage::shot::Shot;

/// Maps that the device had no memory for.
#[derive(Clone, Copy, Debug)]
pub(super) struct NoRoom {
    refused: ShadowMapDescriptor,
    /// The maps made instead.
    smaller: ShadowMapDescriptor,
}

/// Makes a shadow map. If the device has no memory for it, tries half of the texels per side, a quarter, and
/// so on. Also returns the descriptor of the map that was made.
pub(super) fn within_memory<T>(
    wanted: &ShadowMapDescriptor,
    mut make: impl FnMut(&ShadowMapDescriptor) -> Result<T, ShadowMapError>,
) -> Result<(T, ShadowMapDescriptor), ShadowMapError> {
    let mut descriptor = *wanted;
    loop {
        let least = *RESOLUTIONS.start();
        match make(&descriptor) {
            Err(ShadowMapError::OutOfMemory { .. }) if descriptor.resolution.iter().any(|side| *side > least) => {
                descriptor.resolution = descriptor.resolution.map(|side| (side / 2).max(least));
            }
            made => return made.map(|made| (made, descriptor)),
        }
    }
}

impl Side {
    /// Returns the technique of the settings, with its shadow map recreated as needed. If that is impossible,
    /// the old map stays in use, and [`Self::problem`] gives the reason.
    pub(super) fn drawable_technique(&mut self, shot: &Shot<'_>) -> Technique {
        let mut technique = shot.settings.technique;
        if technique.fit.depth == DepthConvention::NegativeOneToOne {
            self.problem = Some("depth -1 to 1 belongs to OpenGL: wgpu draws the map with 0 to 1 instead".to_owned());
            technique.fit.depth = DepthConvention::ZeroToOne;
        }
        let wanted = ShadowMapDescriptor::from(&technique);
        let Err(error) = self.set_shadow_map(shot.gpu, &wanted) else { return technique };
        let map = *self.evaluator.renderer.shadow_map().descriptor();
        self.problem = Some(match error {
            ShadowMapError::OutOfMemory { .. } => {
                let [width, height] = map.resolution;
                format!("{error}. They are drawn with {width} × {height} texels: choose that resolution to keep it")
            }
            _ => error.to_string(),
        });
        technique = technique.with_count(technique.maps.count().min(map.maps));
        let fit = &mut technique.fit;
        (fit.resolution, fit.depth) = (map.resolution.into(), map.depth);
        if fit.casters == CasterPolicy::DepthClamp && !map.depth_clamp {
            fit.casters = CasterPolicy::PerObject;
        }
        technique
    }

    /// Sets the shadow map. If there is no memory for it, sets the next smaller one and returns an error.
    fn set_shadow_map(&mut self, gpu: &Gpu, wanted: &ShadowMapDescriptor) -> Result<(), ShadowMapError> {
        // A rejected map is not tried again in each frame.
        let first =
            self.no_room.filter(|no_room| no_room.refused == *wanted).map_or(*wanted, |no_room| no_room.smaller);
        let renderer = &mut self.evaluator.renderer;
        let ((), set) = within_memory(&first, |descriptor| renderer.set_shadow_map(gpu, descriptor))?;
        self.no_room = (set != *wanted).then_some(NoRoom { refused: *wanted, smaller: set });
        let ShadowMapDescriptor { resolution, format, .. } = *wanted;
        if self.no_room.is_some() {
            return Err(ShadowMapError::OutOfMemory { resolution, maps: wanted.maps, format });
        }
        Ok(())
    }
}
