//! Directional-light shadow maps for any wgpu renderer: the resource, its passes, and the WGSL
//! that looks it up. It imposes no scene, window or material system: the engine draws its casters
//! in a callback and pastes the WGSL into its own shaders.
//!
//! ```no_run
//! # fn demo(device: &wgpu::Device, queue: &wgpu::Queue, encoder: &mut wgpu::CommandEncoder,
//! #         fit: shadowfit::LightFit, forward: shadowfit::glam::Vec3) -> Result<(), shadowfit_wgpu::ShadowMapError> {
//! use shadowfit_wgpu::{MapView, ShadowMap, ShadowMapDescriptor, receiver_wgsl};
//!
//! let mut map = ShadowMap::new(device, &ShadowMapDescriptor::default())?;
//! let wgsl = receiver_wgsl(map.descriptor(), 1); // goes into the engine's own shader, as @group(1)
//!
//! // Each frame: positions in the engine's shaders are relative to `origin`, here the camera.
//! let view = MapView::from_eye(fit.origin, forward);
//! map.prepare(queue, &view, &[fit.into()], &shadowfit::settings::BiasSettings::default())?;
//! map.render(encoder, |pass, _map_index, _volume| {
//!     // Group 0 is set to the caster uniform; draw every caster that the volume keeps.
//!     pass.draw(0..3, 0..1);
//! });
//! # Ok(()) }
//! ```

mod map;
mod shader;
mod uniform;

pub use map::{MAX_MAPS, MapFit, MapView, RESOLUTIONS, ShadowMap, ShadowMapDescriptor, ShadowMapError};
pub use shader::{caster_wgsl, culling_wgsl, receiver_wgsl};
pub use uniform::{CasterUniform, CullingUniform, MapUniform, ReceiverUniform, VolumeUniform};
