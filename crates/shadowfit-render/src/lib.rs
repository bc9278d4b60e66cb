//! The renderer of the shadowfit samples: uploads a CPU scene, draws its casters into a
//! [`shadowfit_wgpu::ShadowMap`], shades it under a sun and a sky, and reads pictures back. It
//! needs no window; the viewer, the tests and the report tool all draw with it.
//!
//! Everything on the GPU is relative to the camera's eye, so that pictures stay steady far from
//! the world's origin. Right-handed, y up, metres; the camera's depth is reversed (near 1, far 0).

pub mod camera;
mod casters;
mod frame;
mod gpu;
mod lines;
mod material;
mod pipelines;
mod probe;
mod renderer;
mod scene;
pub mod shaders;
mod target;
mod timer;
mod uniform;

pub use camera::{FlyCamera, FlyInput};
pub use casters::{Cluster, clustered};
pub use frame::{Frame, Inset, MapStatistics, Overlay, Statistics};
pub use gpu::{AdapterChoice, Gpu, GpuError};
pub use lines::{Line, box_lines};
pub use probe::{Probe, ProbeError, ProbePixel, ProbeTargets};
pub use renderer::Renderer;
pub use scene::GpuScene;
pub use shadowfit_wgpu::Culling;
pub use target::{ReadError, RenderTarget};
pub use timer::PassTimes;
pub use uniform::{Atmosphere, FrameUniform, InsetUniform, InstanceData, LineVertex, MaterialUniform};
