//! Directional-light shadow maps for any wgpu renderer. The engine keeps its scene, its materials and its passes: it gives
//! boxes and a camera, draws casters by number, and pastes WGSL into its own shaders.
//!
//! # One object, one loop
//!
//! [`SunShadows`] holds the shadows of one sun. It fits the maps, finds which parts have to be drawn, keeps static
//! casters from frame to frame, and reads from the depth buffer where fine texels help:
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
//! | name | is |
//! |---|---|
//! | [`SunShadows`] | the shadows of one sun: one object for each |
//! | [`SunShadowsDescriptor`] | how they are made: technique, bindings, texture |
//! | [`SunFrame`], [`Casters`] | what an engine tells about a frame: views, light, boxes, which of them move, and what stands |
//! | [`DrawRegion`] | one draw of a pass: casters by number, viewport, scissor rectangle |
//! | [`ShadowPass`], [`PassKind`](shadowfit::cache::PassKind) | a pass, for engines that schedule passes themselves |
//! | [`UpdatedRect`](shadowfit::cache::UpdatedRect) | a rectangle that a frame draws, for tools that show it |
//! | [`caster_wgsl`], [`receiver_wgsl`], [`WgslOptions`] | the WGSL, for any bind group and with any prefix |
//! | [`LightSteps`] | how the maps of a sun that moves are held still, and cross-faded |
//! | [`UpdateSchedule`], [`Culling`] | which maps may wait for another frame, and which casters are left out |
//! | `exact_edges`, with the feature `rays` | rays instead of the filter where the texels of a map disagree |
//! | [`SunShadowsError`] | why a technique or a frame is refused; earlier maps stay as they are |
//!
//! The example `engine_integration` of the repository is a whole engine around this loop, and its guide
//! (`docs/INTEGRATION.md`) goes through it step by step.
//!
//! # Every step by itself
//!
//! - [`SunShadows::fit`] and [`SunShadows::prepare`] are the halves of [`SunShadows::update`]: maps that are frozen, or
//!   fitted by other code, are drawn and kept by the second alone.
//! - [`ShadowMap`] holds the maps on the GPU: textures, layouts, bind groups, states for pipelines, and a pass for each
//!   map that redraws it. [`ShadowMapDescriptor`] says how large and of which format they are, and [`MapView`] from
//!   where they are read.
//! - [`demand`] counts the visible points of a depth buffer.
//! - [`SunShadows::culling_regions`] and [`culling_wgsl`] cull casters on the GPU, for engines that keep them there.
//! - [`MapTexture`] puts the maps into a texture of the engine's: one that a frame graph owns, or that suns share.
//! - [`uniforms`] has those of the WGSL, for engines that bind them themselves.

// Rooms, each of which uses those above it: `descriptor` says how maps are, `wgsl` writes the text of the look-ups, `maps`
// holds the maps on the GPU, `demand` counts visible points, `sun` is the object that engines use, and `exact_edges`
// makes its edges exact.
pub mod demand;
mod descriptor;
#[cfg(feature = "rays")]
pub mod exact_edges;
mod maps;
mod pixels;
mod sun;
mod wgsl;

/// The uniforms of the WGSL as `bytemuck` types, for engines that fill buffers of their own.
pub mod uniforms {
    pub use crate::maps::{CasterUniform, FadingUniform, MapUniform, ReceiverUniform};
}

pub use descriptor::{MapTextureError, RESOLUTIONS, ShadowMapDescriptor, ShadowMapError};
pub use maps::{DrawRegion, MapTexture, MapView, ShadowMap, ShadowPass};
pub use shadowfit::cache::{Casters, Culling, UpdateSchedule};
pub use shadowfit::settings::MAX_MAPS;
pub use sun::{LightSteps, SunFrame, SunShadows, SunShadowsDescriptor, SunShadowsError};
pub use wgsl::{CullingRegion, WgslOptions, caster_wgsl, culling_wgsl, receiver_wgsl, stored_wgsl};
