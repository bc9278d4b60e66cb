//! The renderer of the shadowfit viewer. It uploads a CPU scene, draws its casters into a
//! [`shadowfit_wgpu::ShadowMap`], shades it under a sun and a sky, and reads pictures back. It needs no
//! window. The viewer, the tests and the report tool all draw with it.
//!
//! All positions on the GPU are relative to the camera's eye, so that pictures stay steady far from the
//! world's origin. Right-handed, y up, metres. The camera's depth is reversed (near 1, far 0).

pub mod attachment;
pub mod camera;
mod casters;
mod encoded;
mod formats;
mod frame;
mod gpu;
mod gpu_timer;
mod inset;
mod judged;
mod lines;
mod maker;
mod marks;
mod material;
mod overlay;
mod part;
pub mod passes;
mod pipelines;
mod pixel;
mod probe;
mod quad;
mod rays;
mod read_back;
mod renderer;
mod scene;
pub mod shaders;
mod statistics;
mod target;
mod timer;
mod uniform;
mod unrolled;
mod upload;
mod vertex_buffer;
mod wait;

pub use camera::{FlyCamera, FlyInput};
pub use casters::{Cluster, clustered};
pub use frame::Frame;
pub use gpu::{DeviceFault, Gpu, GpuError, Wanted, hush_lost_devices};
pub use gpu_timer::{GpuProfilerQuery, GpuTimer};
pub use inset::Inset;
pub use judged::{JudgedPicture, classes_texture};
pub use lines::{Line, box_lines};
pub use marks::Marks;
pub use overlay::Overlay;
pub use pixel::{PixelFacts, PixelQuery, PixelRead, TexelBlock};
pub use probe::{Probe, ProbeError, ProbePixel, ProbeTargets};
pub use quad::Quad;
pub use read_back::{ReadBack, ReadError, read_texture};
pub use renderer::Renderer;
pub use scene::GpuScene;
pub use shadowfit::cache::{Culling, UpdateKind, UpdatedRect};
pub use shadowfit_adapter::{AdapterChoice, AdapterError};
pub use shadowfit_gpu::bindings;
pub use shadowfit_rays::RayError;
pub use statistics::{MapStatistics, Statistics};
pub use target::RenderTarget;
pub use timer::PassTimes;
pub use uniform::{
    Atmosphere, BlockUniform, FrameUniform, InsetVertex, InstanceData, JudgedUniform, LineVertex, MarksUniform,
    MaterialUniform, QuadVertex,
};
pub use wait::{Spent, own_time};
