//! Directional-light shadow maps for any wgpu renderer: the resource, its passes, and the WGSL
//! that looks it up. It imposes no scene, window or material system: the engine draws its casters
//! in a callback and pastes the WGSL into its own shaders.
//!
//! ```no_run
//! # fn demo(device: &wgpu::Device, queue: &wgpu::Queue, encoder: &mut wgpu::CommandEncoder,
//! #         fitted: &shadowfit::FittedMaps, camera: &shadowfit::PerspectiveCamera,
//! #         forward: shadowfit::glam::Vec3) -> Result<(), Box<dyn std::error::Error>> {
//! use shadowfit::Technique;
//! use shadowfit_wgpu::{MapFit, MapView, ShadowMap, ShadowMapDescriptor, WgslOptions, caster_wgsl, receiver_wgsl};
//!
//! let technique = Technique::default(); // four maps
//! let mut map = ShadowMap::new(device, &ShadowMapDescriptor::from(&technique))?;
//! // Goes into the engine's vertex shader of the shadow pass, as @group(0), and into its fragment shader, as @group(1).
//! let caster = caster_wgsl(map.descriptor(), &WgslOptions::group(0));
//! let receiver = receiver_wgsl(map.descriptor(), &WgslOptions::group(1));
//!
//! // Each frame: the maps as `shadowfit::MapFitter` fitted them, nearest first. It wants to know what the last frame
//! // showed, which the module `need` finds.
//! let mut maps: Vec<MapFit> = fitted.iter().map(MapFit::from).collect();
//! // Positions in the engine's shaders are relative to the eye.
//! let view = MapView::from_eye(camera.eye, forward);
//! // Leave out casters whose shadows are not seen. Without this, each map gets all that it can store.
//! MapFit::sweep(&mut maps, &view, &[camera.frustum()?], map.descriptor())?;
//! map.prepare(queue, &view, &maps)?;
//! map.render(encoder, 0, |pass, _map_index, _volume| {
//!     // The caster uniform is bound at group 0: draw every caster that the volume keeps.
//!     pass.draw(0..3, 0..1);
//! });
//! # Ok(()) }
//! ```

mod cache;
mod caught;
mod descriptor;
mod error;
mod kept_maps;
mod layers;
mod map;
mod map_fit;
pub mod need;
mod shader;
mod sun_frame;
mod sun_shadows;
mod sweep;
mod uniform;

pub use cache::{Casters, Culling, PassContent, UpdateSchedule};
pub use descriptor::{RESOLUTIONS, ShadowMapDescriptor};
pub use error::ShadowMapError;
pub use kept_maps::{KeptMaps, ShadowPass, ShadowPiece};
pub use layers::layers_wgsl;
pub use map::ShadowMap;
pub use map_fit::{MapFit, MapView};
pub use shader::{WgslOptions, caster_wgsl, culling_wgsl, receiver_wgsl};
pub use shadowfit::settings::MAX_MAPS;
pub use sun_frame::SunFrame;
pub use sun_shadows::{SunShadows, SunShadowsError};
pub use uniform::{CasterUniform, CullingUniform, MapUniform, ReceiverUniform};
