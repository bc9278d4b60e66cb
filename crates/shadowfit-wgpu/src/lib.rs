//! Shadow maps of a directional light for any wgpu renderer. The engine keeps its scene, its materials and
//! its render passes. It provides a camera and bounding boxes, draws the casters whose numbers it gets back,
//! and pastes WGSL into its shaders. A caster's number is the index of its box.
//!
//! # One object, one loop
//!
//! [`SunShadows`] holds the shadows of one sun. In each frame it fits the maps, finds the regions that must
//! be redrawn, and keeps static casters from earlier frames. It also counts the visible points of the depth
//! buffer, so that the next fits make texels fine where the picture needs it:
//!
//! ```no_run
//! # struct Engine { moves: Vec<bool>, pipeline: wgpu::RenderPipeline, depth: wgpu::TextureView }
//! # impl Engine {
//! #     fn frames(&self) -> Vec<shadowfit::PerspectiveCamera> { Vec::new() }
//! #     fn boxes(&self) -> Vec<shadowfit::Aabb> { Vec::new() }
//! #     fn draw_caster(&self, _: &mut wgpu::RenderPass<'_>, _: u32) {}
//! #     fn draw_picture(&self, _: &mut wgpu::CommandEncoder, _: &wgpu::BindGroup) {}
//! # }
//! # fn demo(engine: &Engine, device: &wgpu::Device, queue: &wgpu::Queue) -> Result<(), Box<dyn std::error::Error>> {
//! use shadowfit::glam::Vec3;
//! use shadowfit::{Boxes, DepthConvention};
//! use shadowfit_wgpu::{
//!     Casters, SunFrame, SunShadows, SunShadowsDescriptor, WgslOptions, caster_wgsl, receiver_wgsl,
//! };
//!
//! let mut sun = SunShadows::new(device, queue, &SunShadowsDescriptor::default())?; // four maps of 2048² texels
//! // For the vertex shader of the shadow pass, at @group(0), and for the fragment shader of the picture, at @group(1).
//! let caster = caster_wgsl(sun.map().descriptor(), &WgslOptions::group(0));
//! let receiver = receiver_wgsl(sun.map().descriptor(), &WgslOptions::group(1));
//! // The engine's pipelines take `primitive_state()`, `depth_stencil_state()` and the layouts from `sun.map()`.
//!
//! for camera in engine.frames() {
//!     let views = [camera.frustum()?];
//!     let objects = engine.boxes();
//!     let boxes = Boxes::world(&objects);
//!     let casters = Casters { moves: &engine.moves, ..Casters::fixed(boxes) };
//!     // Positions in the shaders are relative to the eye; `with_origin` takes another place.
//!     let frame = SunFrame::new(&views, Vec3::new(0.3, -0.8, 0.2), boxes, casters);
//!     sun.update(queue, &frame)?;
//!
//!     let mut encoder = device.create_command_encoder(&Default::default());
//!     sun.render(&mut encoder, 0, |pass, region| {
//!         pass.set_pipeline(&engine.pipeline);
//!         for number in region.casters {
//!             engine.draw_caster(pass, *number);
//!         }
//!     });
//!     engine.draw_picture(&mut encoder, sun.receiver_group());
//!     let depth = DepthConvention::Reversed;
//!     sun.record_demand(&mut encoder, &engine.depth, camera.clip_from_world(depth), depth)?;
//!     queue.submit([encoder.finish()]);
//! }
//! # Ok(()) }
//! ```
//!
//! | name | meaning |
//! |---|---|
//! | [`SunShadows`] | the shadows of one sun |
//! | [`SunShadowsDescriptor`] | technique, bindings and texture of a sun's shadows |
//! | [`SunFrame`], [`Casters`] | the input of a frame: views, light, bounding boxes and static boxes |
//! | [`DrawRegion`] | a part of a pass: numbers of its casters, viewport, scissor rectangle |
//! | [`ShadowPass`], [`PassKind`](shadowfit::cache::PassKind) | a pass, for engines that schedule passes themselves |
//! | [`UpdatedRect`](shadowfit::cache::UpdatedRect) | a rectangle that a frame redraws, for debug views |
//! | [`caster_wgsl`], [`receiver_wgsl`], [`WgslOptions`] | the WGSL, for any bind group and with any prefix |
//! | [`LightSteps`] | how often the maps follow a moving sun, and how they cross-fade |
//! | [`UpdateSchedule`], [`Culling`] | the maps that may wait for another frame, and the casters that are culled |
//! | `exact_edges`, with the feature `rays` | shadow rays instead of the filter, for pixels whose texels disagree |
//! | [`SunShadowsError`] | the reason why a technique or a frame is refused; earlier maps stay as they are |
//!
//! The example `engine_integration` in the repository is a complete engine around this loop. The guide
//! (`docs/INTEGRATION.md`) explains it step by step.
//!
//! # Using single steps
//!
//! - [`SunShadows::fit`] and [`SunShadows::prepare`] are the two halves of [`SunShadows::update`]. Call only
//!   `prepare` for maps that are frozen or fitted by other code.
//! - [`ShadowMap`] holds the maps on the GPU: textures, layouts, bind groups, pipeline states, and one pass
//!   per map that redraws it. [`ShadowMapDescriptor`] gives their size and format, and [`MapView`] the origin
//!   and the eye that shaders read them with.
//! - [`demand`] counts the visible points of a depth buffer.
//! - [`SunShadows::culling_regions`] and [`culling_wgsl`] cull casters on the GPU, for engines that keep
//!   their casters there.
//! - [`MapTexture`] puts the maps into a texture of the engine, such as a frame graph's texture or one that
//!   several suns share.
//! - [`uniforms`] contains the uniforms of the WGSL, for engines that bind them themselves.

// Each module uses only the modules before it in this list: `descriptor` describes the maps, `wgsl` generates
// the WGSL of the look-ups, `maps` holds the maps on the GPU, `demand` counts visible points, `sun` is the
// object that engines use, and `exact_edges` traces rays at shadow edges.
pub mod demand;
mod descriptor;
#[cfg(feature = "rays")]
pub mod exact_edges;
mod maps;
mod pixels;
mod sun;
mod wgsl;

/// Uniforms of the WGSL as `bytemuck` types, for engines that fill their own buffers.
pub mod uniforms {
    pub use crate::maps::{CasterUniform, FadingUniform, MapUniform, ReceiverUniform};
}

pub use descriptor::{MapTextureError, RESOLUTIONS, ShadowMapDescriptor, ShadowMapError};
pub use maps::{DrawRegion, MapTexture, MapView, ShadowMap, ShadowPass};
pub use shadowfit::cache::{Casters, Culling, UpdateSchedule};
pub use shadowfit::settings::MAX_MAPS;
pub use sun::{LightSteps, SunFrame, SunShadows, SunShadowsDescriptor, SunShadowsError};
pub use wgsl::{CullingRegion, WgslOptions, caster_wgsl, culling_wgsl, receiver_wgsl, stored_wgsl};
