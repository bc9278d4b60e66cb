//! The GPU's classes compared with the CPU's, on scenes with every kind of error.
//!
//! They differ only by rounding, at pixels whose shadow ray passes within micrometres of an edge.

use glam::{DMat4, DVec2, DVec3, Vec2, Vec3};
use shadowfit::selection::MapOrder;
use shadowfit_testing::{TestGpu, open_test_gpu, test_gpu};
use shadowfit_truth::gpu::{GpuJudge, GpuJudgeInput, GpuPixel, GpuTracer, GpuTruthError};
use shadowfit_truth::{
    AlphaImage, Class, CutMaterial, CutOut, CutOuts, Judged, MapReading, MeasuredMap, PictureMaps, PixelCamera, Tracer,
    Truth, TruthLight, TruthPoint, TruthSettings, Wrap, judge,
};

use super::scenes::{PlainMap, Triangles, cuboid, level, looking_at, map_around, quad, sphere};

/// A picture that both the CPU and the GPU judge.
pub(crate) struct Picture {
    pub(crate) tracer: Tracer,
    pub(crate) camera: PixelCamera,
    pub(crate) settings: TruthSettings,
    pub(crate) maps: Vec<PlainMap>,
    pub(crate) reading: MapReading,
    depth_clamp: bool,
    /// Point that the GPU's triangles are relative to.
    pub(crate) origin: DVec3,
}

/// The results of both.
struct Both {
    truth: Truth,
    judged: Judged,
    gpu: Vec<GpuPixel>,
    /// Width of the edge zone of each pixel.
    edge_widths: Vec<f32>,
}

impl Picture {
    /// Creates a scene under a light, with a near and a far map of 512 texels. The picture's sides are not
    /// multiples of a workgroup's.
    pub(crate) fn new(triangles: Triangles, eye: DVec3, to_light: DVec3) -> Self {
        let near = PlainMap { split_far: 6.0, ..map_around(DVec3::ZERO, to_light, 6.0, 4.0, 512) };
        Self {
            tracer: Tracer::new(triangles),
            camera: looking_at(eye, DVec3::Y * 0.4, [203, 117]),
            settings: TruthSettings { max_distance: 30.0, ..TruthSettings::new(to_light) },
            maps: vec![near, map_around(DVec3::ZERO, to_light, 24.0, 3.0, 512)],
            reading: MapReading::ViewDepth,
            depth_clamp: false,
            origin: DVec3::ZERO,
        }
    }

    /// Creates the scene under overlapping maps of several sizes, not sorted by size, and one map that is not
    /// read.
    pub(crate) fn with_crossing_maps(blend: f32) -> Self {
        let around = |x: f64, width: f64, texels: u32| map_around(DVec3::X * x, sun(), width, 6.0, texels);
        let maps = vec![around(0.0, 24.0, 512), around(1.0, 3.0, 400), around(-1.5, 6.0, 300), around(0.5, 8.0, 512)];
        let texel = |map: &PlainMap| 1.0 / map.clip_from_world.row(0).truncate().length() / f64::from(map.texels);
        let areas = maps.iter().enumerate().map(|(index, map)| (index != 1).then(|| texel(map).powi(2)));
        let order = MapOrder::by_area(areas);
        assert!(order.iter().eq([3, 2, 0]));
        let picture = Self::new(boxes(), DVec3::new(-4.0, 3.0, 5.0), sun());
        Self { maps, reading: MapReading::Coverage { order, blend }, ..picture }
    }

    fn to_light(&self) -> DVec3 {
        self.settings.light.ray_from(DVec3::ZERO).direction
    }

    pub(crate) fn measured(&self) -> Vec<MeasuredMap> {
        self.maps.iter().map(|map| map.measured(self.to_light())).collect()
    }

    /// Judges the picture on both. Its factors come from maps that hold the nearest triangle at each texel's
    /// centre, with a bias of a centimetre on the left and of 3 m on the right. This gives acne, leaks, holes
    /// and jagged edges.
    fn judge(&self) -> Both {
        self.judge_maps(&self.measured())
    }

    fn judge_maps(&self, maps: &[MeasuredMap]) -> Both {
        let maps = self.picture_maps(maps);
        let seen = Truth::seen_by_rays(&self.tracer, &self.camera);
        let truth = Truth::trace(&self.tracer, &self.camera, &self.settings, &seen);
        let factors = self.factors(&maps, &truth);
        let judged = judge(&self.tracer, &truth, &maps, &factors, |_| true);
        let gpu = self.judge_on_gpu(&maps, &seen, &factors).expect("a picture that the GPU can judge");
        let edge_widths = judged.map_index.iter().map(|map| maps.edge_width(map.map(usize::from))).collect();
        Both { truth, judged, gpu, edge_widths }
    }

    /// Returns the maps and the way they are read.
    pub(crate) fn picture_maps<'a>(&self, maps: &'a [MeasuredMap]) -> PictureMaps<'a> {
        PictureMaps { maps, reading: self.reading, filter_radius: 1.0, depth_clamp: self.depth_clamp }
    }

    /// Computes the factor of each pixel. The sky is lit.
    pub(crate) fn factors(&self, maps: &PictureMaps, truth: &Truth) -> Vec<f32> {
        let factor = |point: &Option<TruthPoint>| point.as_ref().map_or(1.0, |point| self.factor(maps, point));
        truth.points.iter().map(factor).collect()
    }

    fn factor(&self, maps: &PictureMaps, point: &TruthPoint) -> f32 {
        let Some(index) = maps.read(point.view_depth, point.position).map(|read| read.main()) else { return 1.0 };
        let (map, clip_from_world) = (&maps.maps[index], self.maps[index].clip_from_world);
        let texel = map.project(point.position).texel.floor() + 0.5;
        let ndc = (texel / map.size - 0.5) * DVec2::new(2.0, -2.0);
        let depth = clip_from_world.project_point3(point.position).z;
        let centre = clip_from_world.inverse().project_point3(ndc.extend(depth));
        let to_light = self.to_light();
        let bias = if point.position.x < 0.0 { 0.01 } else { 3.0 };
        let mut factor = 1.0;
        self.tracer.for_each_hit((centre + to_light * bias).as_vec3(), to_light.as_vec3(), |hit| {
            let is_drawn = map.project(centre + to_light * (f64::from(hit.distance) + bias)).depth >= 0.0;
            if is_drawn || self.depth_clamp {
                factor = 0.0;
            }
        });
        factor
    }

    fn judge_on_gpu(
        &self,
        maps: &PictureMaps,
        seen: &[Option<u32>],
        factors: &[f32],
    ) -> Result<Vec<GpuPixel>, GpuTruthError> {
        let TestGpu { device, queue, .. } = test_gpu();
        let tracer = GpuTracer::new(&device, &queue, &self.tracer, self.origin)?;
        let texture = seen_texture(&device, &queue, self.camera.size, seen, factors);
        let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
        let mut gpu = GpuJudge::new(&device);
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let input = GpuJudgeInput {
            camera: &self.camera,
            settings: &self.settings,
            maps,
            before: None,
            timestamp_writes: None,
        };
        gpu.judge(&device, &queue, &mut encoder, &tracer, &view, &input)?;
        queue.submit([encoder.finish()]);
        gpu.read(&device, &queue)
    }
}

/// Creates the picture of triangles and factors that a renderer would have drawn.
pub(crate) fn seen_texture(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    [width, height]: [u32; 2],
    seen: &[Option<u32>],
    factors: &[f32],
) -> wgpu::Texture {
    let size = wgpu::Extent3d { width, height, depth_or_array_layers: 1 };
    let texture = device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size,
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::Rg32Uint,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    });
    let texels: Vec<[u32; 2]> = seen
        .iter()
        .zip(factors)
        .map(|(seen, factor)| [seen.map_or(0, |triangle| triangle + 1), factor.to_bits()])
        .collect();
    let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(width * 8), rows_per_image: None };
    queue.write_texture(texture.as_image_copy(), bytemuck::cast_slice(&texels), layout, size);
    texture
}

impl Both {
    /// Asserts that at least 99.9% of the facing pixels off the edge zone, and 99.5% of all facing pixels,
    /// have the same class; that 99.9% read the same map and have pixels per texel within 0.2%; and that edge
    /// zones are identical wherever the truth is, within a pixel's zone. Returns the CPU's number of pixels
    /// of each class.
    fn assert_agreement(&self, name: &str) -> [usize; 6] {
        let pixels = || (0..self.gpu.len()).filter(|pixel| self.truth.verdict(*pixel).is_some());
        let same = |pixel: &usize| self.judged.classes[*pixel] == self.gpu[*pixel].class;
        let share = |of: Vec<usize>, is_same: &dyn Fn(&usize) -> bool| {
            of.iter().filter(|pixel| is_same(pixel)).count() as f64 / of.len().max(1) as f64
        };
        let off_edges: Vec<usize> = pixels().filter(|pixel| !self.judged.edge_zone[*pixel]).collect();
        let classes = [share(off_edges, &same), share(pixels().collect(), &same)];
        let maps = share(pixels().collect(), &|pixel| self.judged.map_index[*pixel] == self.gpu[*pixel].map_index);
        // The texture has 256 steps per octave: half a step is 0.14%.
        let texels = share(pixels().collect(), &|pixel| {
            let (found, wanted) = (self.gpu[*pixel].pixels_per_texel, self.judged.pixels_per_texel[*pixel]);
            found == wanted || (found / wanted - 1.0).abs() <= 0.002
        });
        println!("{name}: classes {classes:?}, maps {maps}, pixels per texel {texels}");
        assert!(classes[0] >= 0.999 && classes[1] >= 0.995, "{name}: classes {classes:?}");
        assert!(maps >= 0.999 && texels >= 0.999, "{name}: maps {maps}, pixels per texel {texels}");
        self.assert_edge_zones(name);
        let mut counts = [0; 6];
        self.judged.classes.iter().for_each(|class| counts[*class as usize] += 1);
        counts
    }

    /// Asserts that every pixel whose edge zone differs has a pixel of differing truth within its zone, or a
    /// transition exactly at the end of its zone, to 0.1%.
    fn assert_edge_zones(&self, name: &str) {
        let width = self.truth.camera.size[0] as usize;
        let position = |pixel: usize| DVec2::new((pixel % width) as f64, (pixel / width) as f64);
        let truth_differs = |pixel: &usize| {
            let gpu = self.gpu[*pixel];
            self.truth.verdict(*pixel) != (gpu.class != Class::NotJudged).then_some(gpu.is_lit)
        };
        let differing: Vec<usize> = (0..self.gpu.len()).filter(truth_differs).collect();
        for pixel in (0..self.gpu.len()).filter(|pixel| self.truth.verdict(*pixel).is_some()) {
            if self.judged.edge_zone[pixel] == self.gpu[pixel].is_in_edge_zone {
                continue;
            }
            let texel_width =
                self.judged.map_index[pixel].map_or(1.0, |_| self.judged.pixels_per_texel[pixel].max(1.0));
            let reach = f64::from(self.edge_widths[pixel] * texel_width);
            let is_near = |other: &usize| position(*other).distance(position(pixel)) <= reach * 1.01 + 1.5;
            let is_tie = (f64::from(self.truth.transition_distance(pixel)) / reach - 1.0).abs() < 1e-3;
            assert!(is_tie || differing.iter().any(is_near), "{name}: the edge zone differs at {}", position(pixel));
        }
    }
}

pub(crate) fn sun() -> DVec3 {
    DVec3::new(0.5, 0.7, 0.3).normalize()
}

pub(crate) fn boxes() -> Triangles {
    let ground = level(0.0, [-15.0, -15.0], [15.0, 16.1]);
    let boxes = (0..12u32).flat_map(|index| {
        let angle = index as f32 * 2.4;
        let centre = Vec3::new(angle.cos(), 0.0, angle.sin()) * (0.5 + 0.4 * index as f32);
        let half = Vec3::new(0.2, 0.3 + 0.15 * (index % 5) as f32, 0.25);
        cuboid(centre + Vec3::Y * 0.02 - half * Vec3::new(1.0, 0.0, 1.0), centre + half * Vec3::new(1.0, 2.0, 1.0))
    });
    // A roof above the far map's near plane causes holes.
    let roof = level(5.0, [2.0, -6.0], [7.0, 3.0]);
    ground.into_iter().chain(boxes).chain(sphere(Vec3::new(-1.5, 1.0, 1.5), 0.6, 24)).chain(roof).collect()
}

/// Returns pseudorandom numbers from 0 to 1 that are the same on every machine.
fn random() -> impl FnMut() -> f32 {
    let mut state = 0x9E37_79B9_7F4A_7C15u64;
    move || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 40) as f32 / (1u64 << 24) as f32
    }
}

#[test]
fn boxes_and_a_sphere_are_judged_alike_with_every_kind_of_error() {
    let mut picture = Picture::new(boxes(), DVec3::new(-4.0, 3.0, 5.0), sun());
    let counts = picture.judge().assert_agreement("boxes");
    assert!(counts.iter().all(|count| *count >= 20), "{counts:?}");
    picture.depth_clamp = true;
    let clamped = picture.judge().assert_agreement("boxes, clamped");
    assert!(clamped[Class::Hole as usize] < counts[Class::Hole as usize], "{clamped:?} {counts:?}");
}

#[test]
fn triangles_relative_to_another_origin_far_from_the_worlds_are_judged_alike() {
    let away = Vec3::new(1000.0, 50.0, -2000.0);
    let moved = boxes().into_iter().map(|corners| corners.map(|corner| corner + away)).collect();
    let mut picture = Picture::new(moved, DVec3::new(-4.0, 3.0, 5.0), sun());
    picture.camera.eye += away.as_dvec3();
    picture.origin = away.as_dvec3() + DVec3::new(0.3, 0.1, -0.2);
    let moved_map = |map: &PlainMap| {
        let clip_from_world = map.clip_from_world * DMat4::from_translation(-away.as_dvec3());
        PlainMap { clip_from_world, ..*map }
    };
    picture.maps = picture.maps.iter().map(moved_map).collect();
    picture.judge().assert_agreement("away");
}

#[test]
fn maps_of_reversed_depth_are_read_alike() {
    let mut picture = Picture::new(boxes(), DVec3::new(-4.0, 3.0, 5.0), sun());
    let turn = DMat4::from_translation(DVec3::Z) * DMat4::from_scale(DVec3::new(1.0, 1.0, -1.0));
    for map in &mut picture.maps {
        map.clip_from_world = turn * map.clip_from_world;
    }
    let counts = picture.judge().assert_agreement("reversed");
    assert!(counts[Class::Hole as usize] >= 20, "{counts:?}");
}

#[test]
fn maps_that_are_read_by_coverage_are_read_alike_whatever_their_order() {
    let mut named = Vec::new();
    for blend in [0.0, 8.0, 64.0] {
        let both = Picture::with_crossing_maps(blend).judge();
        let counts = both.assert_agreement("crossing");
        assert!(counts.iter().all(|count| *count >= 20), "{counts:?}");
        let reads = |map: u8| both.judged.map_index.iter().filter(|read| **read == Some(map)).count();
        let read = [0, 1, 2, 3].map(reads);
        assert!(read[1] == 0 && [0, 2, 3].iter().all(|map| read[*map] > 200), "{read:?}");
        named.push(read);
    }
    // The wider the blend, the sooner the coarser map weighs more.
    assert!(named[0][3] > named[1][3] && named[1][3] > named[2][3], "{named:?}");
}

#[test]
fn maps_that_overlap_by_view_depth_are_read_alike() {
    let picture = Picture::new(boxes(), DVec3::new(-4.0, 3.0, 5.0), sun());
    let plain = picture.measured();
    let overlapping = [plain[0], plain[1].with_blend_near(4.5)];
    let near = |both: &Both| both.judged.map_index.iter().filter(|read| **read == Some(0)).count();
    let [plain, overlapping] = [&plain[..], &overlapping].map(|maps| {
        let both = picture.judge_maps(maps);
        both.assert_agreement("overlapping");
        near(&both)
    });
    assert!(overlapping > 200 && overlapping + 200 < plain, "{overlapping} of {plain}");
}

#[test]
fn edge_zones_are_as_wide_as_each_map_s_own_reach() {
    let picture = Picture::new(boxes(), DVec3::new(-4.0, 3.0, 5.0), sun());
    let plain = picture.measured();
    let wide = [plain[0].with_filter_radius(6.0), plain[1].with_filter_radius(0.5)];
    let zones = |both: &Both, map: u8| {
        let read = both.judged.map_index.iter().zip(&both.judged.edge_zone);
        read.filter(|(read, is_in_zone)| **read == Some(map) && **is_in_zone).count()
    };
    let [plain, wide] = [&plain[..], &wide].map(|maps| {
        let both = picture.judge_maps(maps);
        both.assert_agreement("own reach");
        [zones(&both, 0), zones(&both, 1)]
    });
    assert!(wide[0] > plain[0] && wide[1] < plain[1], "{wide:?} {plain:?}");
}

#[test]
fn grazing_light_is_judged_alike() {
    let to_light = DVec3::new(1.0, 0.04, 0.4).normalize();
    Picture::new(boxes(), DVec3::new(-4.0, 3.0, 5.0), to_light).judge().assert_agreement("grazing");
}

#[test]
fn cut_outs_are_judged_alike_whatever_their_wrapping_and_filtering() {
    let ground = level(0.0, [-15.0, -15.0], [15.0, 16.1]);
    let kinds = [(Wrap::Repeat, true), (Wrap::Mirror, false), (Wrap::Clamp, false), (Wrap::Mirror, true)];
    let mut random = random();
    let image = AlphaImage::new(5, 3, (0..15).map(|_| (random() * 255.0) as u8).collect()).expect("15 texels");
    let picket = AlphaImage::new(2, 1, vec![255, 0]).expect("2 texels");
    let mut triangles = ground;
    let mut cut_outs = Vec::new();
    for (index, (wrap, nearest)) in (0u8..).zip(kinds) {
        let x = f32::from(index) * 0.8 - 1.5;
        let at = |y: f32, z: f32| Vec3::new(x, y, z);
        for corners in quad([at(0.0, -2.0), at(0.0, 2.0), at(1.2, 2.0), at(1.2, -2.0)]) {
            let cut_out = CutOut {
                uvs: corners.map(|corner| Vec2::new(corner.z * 1.3 - 0.2, 0.9 - corner.y * 1.7)),
                alphas: [1.0, 0.9, 1.0],
                material: CutMaterial {
                    image: (index < 3).then_some(u32::from(index % 2)),
                    wrap: [wrap, Wrap::Repeat],
                    nearest,
                    base_alpha: 0.95,
                    cutoff: 0.4,
                },
            };
            cut_outs.push((triangles.len() as u32, cut_out));
            triangles.push(corners);
        }
    }
    let mut picture = Picture::new(triangles, DVec3::new(-4.0, 3.0, 2.0), sun());
    picture.tracer = picture.tracer.with_cut_outs(CutOuts::new(vec![picket, image], cut_outs));
    let counts = picture.judge().assert_agreement("cut-outs");
    assert!(counts[Class::Edge as usize] >= 20, "{counts:?}");
}

#[test]
fn thousands_of_random_triangles_are_judged_alike() {
    let mut random = random();
    let mut point = |size: f32| Vec3::new(random() - 0.5, random() - 0.5, random() - 0.5) * size;
    let random = (0..6000).map(|_| {
        let centre = point(6.0) + Vec3::Y * 2.8;
        [centre + point(0.3), centre + point(0.3), centre + point(0.3)]
    });
    let triangles: Triangles = level(0.0, [-15.0, -15.0], [15.0, 16.1]).into_iter().chain(random).collect();
    Picture::new(triangles, DVec3::new(-5.0, 4.0, 6.0), sun()).judge().assert_agreement("random");
}

#[test]
fn devices_with_enough_storage_buffers_make_the_passes_and_others_refuse_them() {
    let least = wgpu::Limits { max_storage_buffers_per_shader_stage: 7, ..wgpu::Limits::default() };
    let too_few = wgpu::Limits { max_storage_buffers_per_shader_stage: 6, ..least.clone() };
    for (limits, runs) in [(least, true), (too_few, false), (wgpu::Limits::downlevel_defaults(), false)] {
        let TestGpu { device, .. } = open_test_gpu(wgpu::Features::empty(), limits.clone());
        let refused = device.push_error_scope(wgpu::ErrorFilter::Validation);
        drop(GpuJudge::new(&device));
        let error = pollster::block_on(refused.pop());
        assert_eq!(error.is_none(), runs, "{error:?}");
        assert_eq!(GpuJudge::runs_with(&limits), runs);
    }
}

#[test]
fn moved_triangles_are_uploaded_again_and_the_texture_stays() {
    let TestGpu { device, queue, .. } = test_gpu();
    let mut picture = Picture::new(boxes(), DVec3::new(-4.0, 3.0, 5.0), sun());
    let mut tracer = GpuTracer::new(&device, &queue, &picture.tracer, DVec3::ZERO).expect("a scene that fits");
    let mut gpu = GpuJudge::new(&device);
    assert_eq!(gpu.read(&device, &queue), Err(GpuTruthError::NotJudged));
    let mut pictures = Vec::new();
    let mut textures = Vec::new();
    for raised in [0.0, 1.5] {
        let moved: Triangles = boxes().iter().map(|corners| corners.map(|corner| corner * (1.0 + raised))).collect();
        picture.tracer = Tracer::new(moved);
        tracer.update(&device, &queue, &picture.tracer).expect("a scene that fits");
        let seen = Truth::seen_by_rays(&picture.tracer, &picture.camera);
        let maps = [picture.maps[1].measured(sun())];
        let maps = PictureMaps { maps: &maps, reading: MapReading::ViewDepth, filter_radius: 0.5, depth_clamp: true };
        let texture = seen_texture(&device, &queue, picture.camera.size, &seen, &vec![1.0; seen.len()]);
        let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let input = GpuJudgeInput {
            camera: &picture.camera,
            settings: &picture.settings,
            maps: &maps,
            before: None,
            timestamp_writes: None,
        };
        let classes = gpu.judge(&device, &queue, &mut encoder, &tracer, &view, &input).expect("a picture");
        textures.push(classes.clone());
        queue.submit([encoder.finish()]);
        let found = gpu.read(&device, &queue).expect("the classes");
        let truth = Truth::trace(&picture.tracer, &picture.camera, &picture.settings, &seen);
        let differ = (0..found.len())
            .filter(|pixel| truth.verdict(*pixel).is_some_and(|is_lit| is_lit != found[*pixel].is_lit))
            .count();
        assert!(differ * 1000 <= found.len(), "{differ}");
        pictures.push(found);
    }
    assert!(textures[0] == textures[1] && pictures[0] != pictures[1]);
}

#[test]
fn a_gpu_judges_an_empty_scene_as_nothing() {
    let mut picture = Picture::new(Vec::new(), DVec3::new(-4.0, 3.0, 5.0), sun());
    picture.maps.clear();
    let both = picture.judge();
    assert!(both.gpu.iter().all(|pixel| pixel.class == Class::NotJudged) && both.gpu.len() == 203 * 117);
}

#[test]
fn what_the_gpu_cannot_judge_is_refused_by_its_reason() {
    let TestGpu { device, queue, .. } = test_gpu();
    let tracer = || Tracer::new(boxes());
    let refused = GpuTracer::new(&device, &queue, &tracer().with_alpha_test(|_, _| true), DVec3::ZERO);
    assert_eq!(refused.err(), Some(GpuTruthError::AlphaTest));
    let picture = Picture::new(boxes(), DVec3::new(-4.0, 3.0, 5.0), sun());
    let map = picture.maps[0].measured(sun());
    let judge = |change: &dyn Fn(&mut TruthSettings), maps: usize, size: [u32; 2]| {
        let mut settings = picture.settings;
        change(&mut settings);
        let camera = PixelCamera { size, ..picture.camera };
        let maps = PictureMaps {
            maps: &vec![map; maps],
            reading: MapReading::ViewDepth,
            filter_radius: 0.5,
            depth_clamp: false,
        };
        let gpu_tracer = GpuTracer::new(&device, &queue, &picture.tracer, DVec3::ZERO).expect("a scene that fits");
        let texture = seen_texture(&device, &queue, [8, 8], &[None; 64], &[1.0; 64]);
        let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let input =
            GpuJudgeInput { camera: &camera, settings: &settings, maps: &maps, before: None, timestamp_writes: None };
        GpuJudge::new(&device).judge(&device, &queue, &mut encoder, &gpu_tracer, &view, &input).err()
    };
    assert_eq!(judge(&|_| (), 8, [8, 8]), None);
    assert_eq!(judge(&|_| (), 9, [8, 8]), Some(GpuTruthError::TooManyMaps(9)));
    let light = |light: TruthLight| judge(&|settings| settings.light = light, 1, [8, 8]);
    let soft = TruthLight::Sun { to_light: sun(), radius: 0.1, rays: 64 };
    assert_eq!(light(soft), Some(GpuTruthError::SoftSun));
    assert_eq!(light(TruthLight::sun(sun())), None);
    let lamp = TruthLight::Spot { position: DVec3::Y * 9.0, image: None };
    assert_eq!(light(lamp), Some(GpuTruthError::PositionalLight));
    assert_eq!(judge(&|_| (), 1, [9, 8]), Some(GpuTruthError::Size { seen: [8, 8], camera: [9, 8] }));
}
