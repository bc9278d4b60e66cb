//! What the last frame showed, for fits that put their maps where it helps most: a compute pass over the depth buffer.
//!
//! [`DemandPass`] counts the visible points that face the light: by their place across the light and the texel that they
//! ask for (the demand grid of [`shadowfit::demand`], for windows), and by view depth and foreshortening (the
//! [`DepthHistogram`](shadowfit::demand::DepthHistogram)). Position and slope of a point come from the depths of its
//! pixel and of the neighbours. Nothing waits for the GPU: counts come back a frame or two late, which fits allow for.
//!
//! ```no_run
//! # fn demo(device: &wgpu::Device, queue: &wgpu::Queue, depth: &wgpu::TextureView, size: [u32; 2],
//! #         camera: &shadowfit::PerspectiveCamera, direction: shadowfit::glam::Vec3)
//! #         -> Result<(), Box<dyn std::error::Error>> {
//! use shadowfit::{DepthConvention, FitInput, ShadowFitter, Technique};
//! use shadowfit_wgpu::demand::{DemandPass, DemandView};
//!
//! let mut fitter = ShadowFitter::new(&Technique::default());
//! let mut demand = DemandPass::new(device, queue, 1).ok(); // without it fits take boxes
//! loop {
//!     // The newest counts that are there; those of the frame before until then.
//!     if let Some(pass) = &mut demand
//!         && let Some(seen) = pass.take()?
//!     {
//!         fitter.set_visible_demand(seen);
//!     }
//!     let views = [camera.frustum()?];
//!     let maps = fitter.fit(&FitInput::new(&views, direction))?;
//!     // Draw the maps and the scene as ever, and then:
//!     let mut encoder = device.create_command_encoder(&Default::default());
//!     if let Some(pass) = &mut demand {
//!         let settings = &fitter.technique().fit;
//!         let view = DemandView::from_camera(camera, DepthConvention::Reversed, direction, settings, size)?;
//!         pass.record(&mut encoder, depth, &view, None)?;
//!     }
//!     queue.submit([encoder.finish()]);
//! }
//! # }
//! ```
//!
//! After a camera cut, drop the counts ([`ShadowFitter::reset`](shadowfit::ShadowFitter::reset)) and those on their way
//! ([`DemandPass::reset`]); old counts cost sharpness, never coverage. For several views that share the maps, such as a
//! split screen, make a pass for each.
//!
//! # Precision
//!
//! Slopes come from differences of neighbouring depths. Reversed `Depth32Float` is exact enough at any distance; plain
//! depth of 24 or 32 bits with a near plane at a tenth of a metre is exact enough for some hundred metres; 16 bits are
//! for a few metres only. The pass reads the first sample of multisampled textures, which lies less than half a pixel
//! beside the pixel's centre.
//!
//! # Where it does not run
//!
//! Devices without compute shaders and storage buffers (WebGL2), and OpenGL, whose shaders cannot load depth textures.
//! [`DemandPass::new`] says so, and fits take boxes: leave [`FitInput::demand`](shadowfit::FitInput::demand) empty.

mod error;
mod pass;
mod reference;
mod view;

pub use crate::pixels::DepthBufferError;
pub use error::{DemandPassError, Unsupported};
pub(crate) use pass::supported;
pub use pass::{DemandPass, demand_wgsl};
pub use reference::{Depths, count_on_cpu};
pub use view::{DemandUniform, DemandView};
