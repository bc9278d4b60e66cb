//! Visible demand, counted in the depth buffer by a compute pass. Fits place their maps where they improve
//! the most visible pixels.
//!
//! [`DemandPass`] counts the visible points that face the light, in two ways. The demand grid of
//! [`shadowfit::demand`], for windows, sorts them by position perpendicular to the light and by the texel
//! size that they need. The [`DepthHistogram`](shadowfit::demand::DepthHistogram), for cascades, sorts them
//! by view depth and foreshortening. Position and slope of a point come from the depths of its pixel and of
//! the neighbours. The CPU never waits for the GPU: counts arrive a frame or two late, and fits allow for
//! that.
//!
//! ```no_run
//! # fn demo(device: &wgpu::Device, queue: &wgpu::Queue, depth: &wgpu::TextureView, size: [u32; 2],
//! #         camera: &shadowfit::PerspectiveCamera, direction: shadowfit::glam::Vec3)
//! #         -> Result<(), Box<dyn std::error::Error>> {
//! use shadowfit::{DepthConvention, FitInput, ShadowFitter, Technique};
//! use shadowfit_wgpu::demand::{DemandPass, DemandView};
//!
//! let mut fitter = ShadowFitter::new(&Technique::default());
//! let mut demand = DemandPass::new(device, queue, 1).ok(); // without it, fits use the bounding boxes
//! loop {
//!     // The newest counts that have arrived. Until they do, the fitter keeps the earlier ones.
//!     if let Some(pass) = &mut demand
//!         && let Some(seen) = pass.take()?
//!     {
//!         fitter.set_visible_demand(seen);
//!     }
//!     let views = [camera.frustum()?];
//!     let maps = fitter.fit(&FitInput::new(&views, direction))?;
//!     // Draw the maps and the scene as usual, and then:
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
//! After a camera cut, drop the counts ([`ShadowFitter::reset`](shadowfit::ShadowFitter::reset)) and the
//! counts that are still on the GPU ([`DemandPass::reset`]). Outdated counts reduce sharpness, never
//! coverage. If several views share the maps, such as a split screen, make one pass per view.
//!
//! # Precision
//!
//! Slopes come from differences of neighbouring depths. Reversed `Depth32Float` is precise enough at any
//! distance. Plain depth of 24 or 32 bits with a near plane at 0.1 m is precise enough for a few hundred
//! metres, and 16 bits only for a few metres. The pass reads the first sample of multisampled textures, which
//! lies less than half a pixel from the pixel's centre.
//!
//! # Unsupported devices
//!
//! Devices without compute shaders and storage buffers (WebGL2) cannot run the pass, and neither can OpenGL,
//! whose shaders cannot load depth textures. [`DemandPass::new`] then returns an error. Leave
//! [`FitInput::demand`](shadowfit::FitInput::demand) empty, and fits use the bounding boxes.

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
