//! The edge pass on triangles that are casters and visible: a depth pre-pass, and the results of the pass and
//! of the look-up at each pixel.

use std::sync::{Arc, OnceLock};

use shadowfit::glam::{Affine3A, DVec3, Vec3, Vec4};
use shadowfit::settings::Edges;
use shadowfit::{Aabb, Boxes, DepthConvention, PerspectiveCamera, Technique};
use shadowfit_rays::{MeshId, RayInstance, RayMesh, RayScene};
use shadowfit_wgpu::exact_edges::{
    EdgeCounts, EdgeError, EdgeOutcome, EdgePass, EdgeView, NormalEncoding, exact_factor_wgsl,
};
use shadowfit_wgpu::{SunFrame, SunShadows, WgslOptions};

use crate::engine::casters::{CasterShader, Casters, Shape, look_up_wgsl};
use crate::engine::picture::{DepthPicture, READ_BACK, SeenCorner};
use crate::engine::points::{Bound, Point};
use crate::engine::{Engine, dispatch};

/// Triangles that are drawn together.
#[derive(Clone, Debug, Default)]
pub(super) struct Thing {
    /// Three corners per triangle, in world space, in metres.
    pub(super) corners: Vec<Vec3>,
    /// Offset in metres.
    pub(super) shift: Vec3,
    pub(super) moves: bool,
    /// Whether it is missing in the rays.
    pub(super) is_lacking: bool,
    /// Whether it casts shadows but is not visible, like the sides that an engine culls.
    pub(super) is_culled: bool,
    /// Hierarchy of the triangles, which clones share once it is built.
    pub(super) mesh: Arc<OnceLock<RayMesh>>,
}

impl Thing {
    /// Returns an axis-aligned box.
    pub(super) fn solid(min: Vec3, max: Vec3) -> Self {
        Self { corners: crate::demand_picture::cuboid(min, max), ..Self::default() }
    }

    pub(super) fn bounds(&self) -> Aabb {
        let [least, most] = [Vec3::min, Vec3::max].map(|pick: fn(Vec3, Vec3) -> Vec3| {
            self.corners.iter().copied().reduce(pick).expect("a thing has corners") + self.shift
        });
        Aabb::new(least, most)
    }
}

/// Settings of an image.
#[derive(Clone, Copy, Debug)]
pub(super) struct Look {
    pub(super) camera: PerspectiveCamera,
    pub(super) direction: Vec3,
    pub(super) size: [u32; 2],
    pub(super) samples: u32,
    pub(super) convention: DepthConvention,
    /// Format of the depth buffer.
    pub(super) format: wgpu::TextureFormat,
    pub(super) normals: Option<NormalEncoding>,
    pub(super) number: u32,
}

impl Look {
    pub(super) fn aspect(size: [u32; 2]) -> f32 {
        size[0] as f32 / size[1] as f32
    }
}

/// Textures that an image was drawn into.
#[derive(Debug)]
pub(super) struct Drawn {
    pub(super) depth: wgpu::TextureView,
    pub(super) normals: Option<wgpu::TextureView>,
}

/// All resources for drawing images.
pub(super) struct Stage {
    pub(super) gpu: Engine,
    pub(super) sun: SunShadows,
    pub(super) pass: EdgePass,
    pub(super) rays: RayScene,
    pub(super) things: Vec<Thing>,
    meshes: Vec<MeshId>,
}

/// Returns the technique with traced edges.
pub(super) fn traced(technique: Technique, samples: u32) -> Technique {
    technique.with_edges(Edges::Traced { samples })
}

/// WGSL that evaluates points: the filter's factor, and the factor that an engine reads after the pass.
const READ: &str = "
fn answer(position: vec3<f32>, normal: vec3<f32>, pixel: vec2<f32>) -> Answer {
    let filtered = shadowfit_factor_at(position, normal, pixel);
    return Answer(vec4<f32>(filtered, shadowfit_exact_factor(position, normal, pixel), 0.0, 0.0), vec4<f32>(0.0));
}
";

/// WGSL that returns the texels of a texture, layer by layer and row by row.
const LOAD: &str = "
@group(0) @binding(0) var loaded: TEXTURE;
@group(0) @binding(1) var<storage, read_write> values: array<f32>;
@compute @workgroup_size(64) fn load(@builtin(global_invocation_id) id: vec3<u32>) {
    let size = textureDimensions(loaded);
    let count = size.x * size.y;
    if id.x < COUNT {
        let at = vec2<u32>(id.x % count % size.x, id.x % count / size.x);
        let index = id.x / count;
        values[id.x] = LOAD;
    }
}
";

impl Stage {
    pub(super) fn new(technique: &Technique, things: Vec<Thing>) -> Self {
        let gpu = Engine::shared();
        gpu.require_map(&technique.into());
        if matches!(technique.edges, Edges::Traced { .. }) {
            gpu.require_depth_loads();
        }
        let sun = SunShadows::new(&gpu.device, &gpu.queue, &(*technique).into()).expect("maps");
        let pass = EdgePass::new(&gpu.device, &gpu.queue).expect("a device that computes");
        let mut rays = RayScene::new(&gpu.device, &gpu.queue).expect("a device that traces");
        let mesh = |thing: &Thing| {
            let triangles = || thing.corners.as_chunks::<3>().0.iter().copied();
            let mesh = thing.mesh.get_or_init(|| RayMesh::from_triangles(triangles()).expect("a mesh"));
            rays.add_mesh(mesh).expect("room")
        };
        let meshes = things.iter().map(mesh).collect();
        let mut stage = Self { gpu, sun, pass, rays, things, meshes };
        stage.place();
        stage
    }

    /// Places the instances of the rays.
    fn place(&mut self) {
        let things = self.things.iter().zip(&self.meshes).filter(|(thing, _)| !thing.is_lacking);
        let instance =
            |(thing, mesh): (&Thing, &MeshId)| RayInstance::new(*mesh, Affine3A::from_translation(thing.shift));
        let instances: Vec<_> = things.map(instance).collect();
        self.rays.set_instances(DVec3::ZERO, &instances).expect("room");
    }

    /// Draws the maps of a frame, and its surfaces.
    pub(super) fn draw(&mut self, look: &Look) -> Drawn {
        self.place();
        self.draw_maps(look);
        self.draw_surfaces(look)
    }

    fn draw_maps(&mut self, look: &Look) {
        let aabbs: Vec<Aabb> = self.things.iter().map(Thing::bounds).collect();
        let moves: Vec<bool> = self.things.iter().map(|thing| thing.moves).collect();
        let boxes = Boxes { origin: DVec3::ZERO, boxes: &aabbs };
        let views = [look.camera.frustum().expect("a camera")];
        let casters = shadowfit_wgpu::Casters { moves: &moves, ..shadowfit_wgpu::Casters::fixed(boxes) };
        let frame = SunFrame::new(&views, look.direction, boxes, casters).with_origin(DVec3::ZERO);
        self.sun.update(&self.gpu.queue, &SunFrame { number: look.number, ..frame }).expect("a good frame");
        let pipeline = CasterShader::new(self.sun.map(), Shape::Triangles).pipeline(&self.gpu);
        let shifted = |thing: &Thing| thing.corners.iter().map(|corner| *corner + thing.shift).collect::<Vec<Vec3>>();
        let casters = Casters::triangles(&self.gpu, self.things.iter().map(shifted));
        let mut encoder = self.gpu.encoder();
        casters.draw_sun(&mut encoder, &pipeline, &self.sun);
        self.gpu.submit(encoder);
    }

    /// Draws depths, and normals if the look has them.
    pub(super) fn draw_surfaces(&self, look: &Look) -> Drawn {
        let corners = self.corners(look);
        let picture = DepthPicture { format: look.format, ..DepthPicture::new(look.size, look.convention) };
        let depth = self.gpu.draw_depths(&DepthPicture { samples: look.samples, ..picture }, &corners);
        let normals = look.normals.map(|_| {
            let usage = READ_BACK | wgpu::TextureUsages::TEXTURE_BINDING;
            self.gpu.texture(look.size, 1, wgpu::TextureFormat::Rgba32Float, usage)
        });
        if normals.is_some() {
            self.gpu.draw_depths(&DepthPicture { normals: normals.as_ref(), ..picture }, &corners);
        }
        Drawn { depth, normals }
    }

    /// Returns the index of the visible triangle at each pixel, counted over all things.
    pub(super) fn triangles(&self, look: &Look) -> Vec<Option<usize>> {
        let mut corners = self.corners(look);
        for (index, corner) in corners.iter_mut().enumerate() {
            corner.normal = Vec4::splat((index / 3 + 1) as f32);
        }
        let usage = READ_BACK | wgpu::TextureUsages::TEXTURE_BINDING;
        let numbers = self.gpu.texture(look.size, 1, wgpu::TextureFormat::Rgba32Float, usage);
        let picture = DepthPicture { format: look.format, ..DepthPicture::new(look.size, look.convention) };
        self.gpu.draw_depths(&DepthPicture { normals: Some(&numbers), ..picture }, &corners);
        let numbers: Vec<[f32; 4]> = self.gpu.texels(numbers.texture());
        numbers.iter().map(|number| (number[0] as usize).checked_sub(1)).collect()
    }

    /// Draws depths into a part of a texture of another size.
    pub(super) fn draw_part(&self, look: &Look, texture: [u32; 2], [left, top]: [u32; 2]) -> Drawn {
        let part = [left, top, look.size[0], look.size[1]];
        let whole = DepthPicture::new(texture, look.convention);
        let picture = DepthPicture { part, samples: look.samples, format: look.format, ..whole };
        Drawn { depth: self.gpu.draw_depths(&picture, &self.corners(look)), normals: None }
    }

    /// Returns positions in clip space, and normals.
    fn corners(&self, look: &Look) -> Vec<SeenCorner> {
        let clip = look.camera.clip_from_world(look.convention).as_dmat4();
        let mut corners = Vec::new();
        for thing in &self.things {
            for [a, b, c] in thing.corners.as_chunks::<3>().0 {
                let normal = (*b - *a).cross(*c - *a).normalize_or_zero();
                let stored = match look.normals {
                    // Ten bits.
                    Some(NormalEncoding::Unsigned) => ((normal * 0.5 + 0.5) * 1023.0).round() / 1023.0,
                    _ => normal,
                };
                corners.extend([a, b, c].map(|corner| {
                    let relative = (*corner + thing.shift).as_dvec3() - look.camera.eye;
                    let clip = (clip * relative.extend(1.0)).as_vec4();
                    // A degenerate triangle is not drawn.
                    SeenCorner { clip: if thing.is_culled { Vec4::W } else { clip }, normal: stored.extend(0.0) }
                }));
            }
        }
        corners
    }

    /// Traces the edges of a drawn image. `edit` changes the settings.
    pub(super) fn trace_edges<'a>(
        &mut self,
        look: &Look,
        drawn: &'a Drawn,
        edit: impl FnOnce(&mut EdgeView<'a>),
    ) -> Result<EdgeOutcome, EdgeError> {
        let clip_from_eye = look.camera.clip_from_world(look.convention);
        let mut view = EdgeView::new(&drawn.depth, clip_from_eye, look.convention, look.camera.eye);
        if let (Some(normals), Some(encoding)) = (&drawn.normals, look.normals) {
            view = view.with_normals(normals, encoding);
        }
        edit(&mut view);
        let mut encoder = self.gpu.encoder();
        let result = self.pass.record(&mut encoder, &self.sun, Some(&self.rays), &view);
        self.gpu.submit(encoder);
        result
    }

    /// Returns the factors of the last image, whose edges must be traced.
    pub(super) fn factors(&self) -> Vec<f32> {
        assert_eq!(self.pass.result(), EdgeOutcome::Traced);
        self.gpu.texels(self.pass.factors().texture())
    }

    /// Traces the edges of an image, and returns its factors and counts.
    pub(super) fn traced<'a>(
        &mut self,
        look: &Look,
        drawn: &'a Drawn,
        edit: impl FnOnce(&mut EdgeView<'a>),
    ) -> (Vec<f32>, EdgeCounts) {
        assert_eq!(self.trace_edges(look, drawn, edit), Ok(EdgeOutcome::Traced));
        let factors = self.factors();
        (factors, self.pass.take_counts().expect("the frame is finished"))
    }

    /// Returns the filter's factor and the factor that an engine reads, for points by pixel: position in
    /// world space and normal.
    pub(super) fn read(&self, points: &[[Vec4; 2]], width: u32) -> Vec<[f32; 2]> {
        let map = self.sun.map();
        let wgsl = look_up_wgsl(map.descriptor(), &WgslOptions::group(0))
            + &exact_factor_wgsl(&WgslOptions::group(1), 0)
            + READ;
        let point = |point: &[Vec4; 2]| {
            let [position, normal] = point.map(|vector| vector.truncate().to_array());
            Point { position, normal }
        };
        let points: Vec<Point> = points.iter().map(point).collect();
        let bound = [
            Bound { layout: map.receiver_layout(), group: self.sun.receiver_group() },
            Bound { layout: self.pass.layout(), group: self.pass.group() },
        ];
        self.gpu.ask(&wgsl, &bound, &points, width).iter().map(|values| [values.one[0], values.one[1]]).collect()
    }

    /// Returns the depths of all samples of a texture: sample by sample, row by row.
    pub(super) fn depths(&self, view: &wgpu::TextureView) -> Vec<f32> {
        let texture = view.texture();
        let samples = texture.sample_count();
        let (kind, load) = if samples > 1 {
            ("texture_depth_multisampled_2d", "textureLoad(loaded, at, index)")
        } else {
            ("texture_depth_2d", "textureLoad(loaded, at, 0)")
        };
        self.loaded(view, kind, load, texture.width() * texture.height() * samples)
    }

    /// Returns the depths of all layers of the maps.
    pub(super) fn stored(&self) -> Vec<f32> {
        let map = self.sun.map();
        let ([width, height], layers) = (map.descriptor().resolution, map.descriptor().maps);
        let (kind, load) = if map.descriptor().format.is_depth() {
            ("texture_depth_2d_array", "textureLoad(loaded, at, index, 0)")
        } else {
            ("texture_2d_array<f32>", "textureLoad(loaded, at, index, 0).x")
        };
        self.loaded(map.view(), kind, load, width * height * layers)
    }

    fn loaded(&self, view: &wgpu::TextureView, kind: &str, load: &str, count: u32) -> Vec<f32> {
        let wgsl = LOAD
            .replace("TEXTURE", kind)
            .replace("COUNT", &format!("{count}u"))
            .replace("= LOAD", &format!("= {load}"));
        let pipeline = self.gpu.compute_pipeline(None, &wgsl, "load");
        let usage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC;
        let values = self.gpu.buffer(&vec![0.0_f32; count as usize], usage);
        let resources = [wgpu::BindingResource::TextureView(view), values.as_entire_binding()];
        let group = self.gpu.group(&pipeline.get_bind_group_layout(0), resources);
        let mut encoder = self.gpu.encoder();
        dispatch(&mut encoder, &pipeline, &[&group], [count.div_ceil(64), 1]);
        self.gpu.values(encoder, &values)
    }
}
