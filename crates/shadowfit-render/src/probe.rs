//! What the renderer itself knew about each pixel: the visible point, its geometric normal, the
//! instance, and the shadow factor that it used. Measures judge these, not guesses from colours.

use glam::Vec3;

use crate::Gpu;
use crate::picture::{DEPTH_FORMAT, read_texture};

/// Format of both probe targets.
pub(crate) const PROBE_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba32Float;

/// One pixel of a [`Probe`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProbePixel {
    /// Visible point, relative to the eye, in metres.
    pub position: Vec3,
    /// Unit normal of the visible triangle, on the side of the eye, world axes.
    pub normal: Vec3,
    /// Index into the scene's instances.
    pub instance: usize,
    /// Filtered share of the light, 0..=1, as shaded.
    pub factor: f32,
}

/// All pixels of a picture, rows from the top; `None` where the sky is seen. Blended surfaces are
/// not there: what lies behind them is.
#[derive(Clone, Debug)]
pub struct Probe {
    /// Width and height, in pixels.
    pub size: [u32; 2],
    /// `size[0] * size[1]` pixels.
    pub pixels: Vec<Option<ProbePixel>>,
}

/// Textures that a probe is drawn into.
#[derive(Debug)]
pub(crate) struct ProbeTargets {
    size: [u32; 2],
    textures: [wgpu::Texture; 2],
    pub(crate) views: [wgpu::TextureView; 2],
    pub(crate) depth: wgpu::TextureView,
}

impl ProbeTargets {
    pub(crate) fn new(device: &wgpu::Device, size: [u32; 2]) -> Self {
        let texture = |format, usage| {
            device.create_texture(&wgpu::TextureDescriptor {
                label: Some("probe"),
                size: wgpu::Extent3d { width: size[0], height: size[1], depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: usage | wgpu::TextureUsages::RENDER_ATTACHMENT,
                view_formats: &[],
            })
        };
        let textures = [(); 2].map(|()| texture(PROBE_FORMAT, wgpu::TextureUsages::COPY_SRC));
        let views = [0, 1].map(|index: usize| textures[index].create_view(&Default::default()));
        let depth = texture(DEPTH_FORMAT, wgpu::TextureUsages::empty()).create_view(&Default::default());
        Self { size, textures, views, depth }
    }

    pub(crate) fn read(&self, gpu: &Gpu) -> Probe {
        let [points, normals] = [0, 1].map(|index: usize| {
            let bytes = read_texture(gpu, &self.textures[index], self.size, 16);
            bytemuck::pod_collect_to_vec::<u8, [f32; 4]>(&bytes)
        });
        let pixels = points.iter().zip(&normals).map(|(point, normal)| {
            (normal[3] > 0.0).then(|| ProbePixel {
                position: Vec3::new(point[0], point[1], point[2]),
                normal: Vec3::new(normal[0], normal[1], normal[2]),
                instance: normal[3] as usize - 1,
                factor: point[3],
            })
        });
        Probe { size: self.size, pixels: pixels.collect() }
    }
}
