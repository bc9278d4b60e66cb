//! The twin: the first edge pass in plain Rust. It repeats the arithmetic of `edges.wgsl`, `classify.wgsl`
//! and the look-up's WGSL, in f32 and in the same order, on a depth buffer and maps that were read back. Suns
//! with a radius are in `twin/soft.rs`. The rays of the later passes are in `twin/rays.rs`, and the maps'
//! estimates in `twin/estimate.rs`.

#[path = "twin/estimate.rs"]
mod estimate;
#[path = "twin/rays.rs"]
mod rays;
#[path = "twin/selection.rs"]
mod selection;
#[path = "twin/soft.rs"]
mod soft;
#[path = "twin/surface.rs"]
mod surface;
#[path = "../../../src/exact_edges/verdict.rs"]
#[allow(dead_code, reason = "the WGSL of the verdicts is for the crate itself")]
mod verdict;

use shadowfit::glam::{DMat4, DVec3, DVec4, Vec2, Vec3, Vec4};
use shadowfit::{Bias, DepthConvention, FittedMap};
use shadowfit_wgpu::exact_edges::NormalEncoding;
use shadowfit_wgpu::uniforms::{MapUniform, ReceiverUniform};
use shadowfit_wgpu::{MapView, ShadowMapDescriptor};

use self::surface::Surface;
pub(super) use self::verdict::Verdict;
use super::stage::{Drawn, Look, Stage};

/// A pixel's verdict, and its factor if the maps decide.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Classified {
    pub(super) verdict: Verdict,
    pub(super) factor: f32,
}

impl Classified {
    /// Returns whether the maps decide the factor.
    pub(super) fn is_sure(self) -> bool {
        matches!(self.verdict, Verdict::Lit | Verdict::Shadowed)
    }
}

/// Shift of the thresholds, for finding pixels next to one: in texels for positions, and relative for other
/// values. Depths are also shifted by a few roundings.
pub(super) type Slack = f32;

/// Slack of pixels that count as next to a threshold.
pub(super) const NEXT_TO: Slack = 1e-3;

// Constants of the WGSL.
const FOOTPRINT: f32 = 2.0;
const COARSEST_FOOTPRINT: f32 = 3.0;
const MOST_BLOCKS: f32 = 6.0;
const ROUNDED_TEXEL: f32 = 0.02;
const BENT: f32 = 0.015_625;
const ROUNDINGS: f32 = 4.0;
const SNAP: f32 = 0.003_906_25;
const STORED_TILT: f32 = 0.002;
const SAME_NORMAL: f32 = 0.9995;
const MOST_SNAP: f32 = 0.031_25;
const BEND: f32 = 0.5;
const MIN_COSINE: f32 = 0.005;
const POSITION_ROUNDING: f32 = 4.768_371_6e-7;
/// Least height of a ray's start, in metres, as in
/// [`EdgeView::new`](shadowfit_wgpu::exact_edges::EdgeView::new).
const RAY_OFFSET: f32 = 1e-3;
/// Rounding bound of a depth on a plane: 2⁻²⁴ in each of some sums.
const DEPTH_ROUNDING: f32 = 5e-7;
/// WebGPU's positions of four samples.
const FOUR: [Vec2; 4] =
    [Vec2::new(-0.125, -0.375), Vec2::new(0.375, -0.125), Vec2::new(-0.375, 0.125), Vec2::new(0.125, 0.375)];

/// A view, and the maps that classify its pixels.
pub(super) struct Twin {
    size: [i32; 2],
    convention: DepthConvention,
    world_from_pixel: [Vec4; 4],
    forward: Vec3,
    /// Depths, sample by sample.
    depths: Vec<f32>,
    samples: usize,
    normals: Option<(Vec<[f32; 4]>, NormalEncoding)>,
    /// For each ray: its start, in pixels from the first sample, and its position in the sun's disc.
    points: Vec<[Vec2; 2]>,
    point_reach: f32,
    descriptor: ShadowMapDescriptor,
    receiver: ReceiverUniform,
    /// Stored depths, layer by layer.
    stored: Vec<f32>,
    /// Pyramid for soft filters.
    pyramid: Option<soft::Pyramid>,
    /// Eye relative to the origin of the rays.
    eye: Vec3,
    slack: Slack,
    /// Shift of the distance of casters from a point, in texels.
    radius_slack: Slack,
}

struct Projected {
    texel: Vec2,
    surface: f32,
    depth: f32,
    gradient: Vec2,
}

impl Twin {
    /// Creates the twin of an image that a stage has drawn and traced.
    pub(super) fn new(stage: &Stage, look: &Look, drawn: &Drawn) -> Self {
        let map = stage.sun.map();
        let from_eye = MapView { origin: look.camera.eye, ..*stage.sun.map_view().expect("a frame") };
        let normals = drawn
            .normals
            .as_ref()
            .zip(look.normals)
            .map(|(normals, encoding)| (stage.gpu.texels(normals.texture()), encoding));
        let to_world = world_from_pixel(look);
        let stored = stage.stored();
        let first = if look.samples > 1 { FOUR[0] } else { Vec2::ZERO };
        let (count, is_soft) = (map.descriptor().edges.samples(), map.descriptor().filter.is_soft());
        let points = rays::points(count, is_soft, first);
        Self {
            size: look.size.map(u32::cast_signed),
            convention: look.convention,
            world_from_pixel: to_world.as_mat4().to_cols_array_2d().map(Vec4::from),
            forward: forward(&to_world, look),
            depths: stage.depths(&drawn.depth),
            samples: look.samples as usize,
            normals,
            point_reach: points.iter().map(|[place, _]| place.abs().max_element()).fold(0.0, f32::max),
            points,
            descriptor: *map.descriptor(),
            receiver: on_planes(stage.sun.maps(), &from_eye, map.descriptor()),
            pyramid: is_soft.then(|| soft::Pyramid::new(map.descriptor(), &stored)),
            stored,
            eye: (look.camera.eye - stage.rays.origin()).as_vec3(),
            slack: 0.0,
            radius_slack: 0.0,
        }
    }

    /// Classifies each pixel, in rows from the top.
    pub(super) fn verdicts(&self) -> Vec<Classified> {
        let [width, height] = self.size;
        (0..width * height).map(|index| self.classified([index % width, index / width])).collect()
    }

    /// Classifies a pixel with slightly lower and higher thresholds.
    pub(super) fn nearby(&mut self, index: usize, slack: Slack) -> Vec<Classified> {
        let index = (index as u32).cast_signed();
        let at = [index % self.size[0], index / self.size[0]];
        let found = [[-slack, 0.0], [slack, 0.0], [0.0, -slack], [0.0, slack]].map(|slacks| {
            [self.slack, self.radius_slack] = slacks;
            self.classified(at)
        });
        [self.slack, self.radius_slack] = [0.0; 2];
        found.to_vec()
    }

    fn classified(&self, pixel: [i32; 2]) -> Classified {
        let of = |verdict, factor| Classified { verdict, factor };
        let depth = self.depth_at(pixel);
        if depth == 0.0 {
            return of(Verdict::NoSurface, -1.0);
        }
        let surface = self.surface_of(pixel, depth);
        let faded = self.faded(surface.position);
        if faded >= 1.0 {
            return of(Verdict::Beyond, 1.0);
        }
        let facing = dot(surface.normal, self.receiver.to_light.into());
        if surface.is_known && surface.is_single && facing <= self.slack * 0.01 - surface.tilt {
            return of(Verdict::FacesAway, 0.0);
        }
        if !surface.is_single {
            return of(Verdict::Filtered, -1.0);
        }
        if !surface.is_known || facing < surface.tilt + self.slack * 0.01 {
            return of(Verdict::Unsure, -1.0);
        }
        match self.of_maps(&surface) {
            Verdict::Lit => of(Verdict::Lit, 1.0),
            Verdict::Shadowed => of(Verdict::Shadowed, faded),
            verdict => of(verdict, -1.0),
        }
    }

    fn view_depth(&self, position: Vec3) -> f32 {
        let [x, y, z, w] = self.receiver.view;
        dot(Vec3::new(x, y, z), position) + w
    }

    fn faded(&self, position: Vec3) -> f32 {
        let beyond = self.view_depth(position) - self.receiver.fade_near;
        if beyond <= self.slack * 0.01 {
            return 0.0;
        }
        let share = (beyond / self.receiver.fade_width.max(1e-30)).clamp(0.0, 1.0);
        share * share * (3.0 - 2.0 * share)
    }

    /// Returns the verdict of the finest map whose footprint is inside it and not too wide, or of the map
    /// selected by view depth.
    fn of_maps(&self, surface: &Surface) -> Verdict {
        let selection = self.choose(surface.position);
        if selection.first < 0 || selection.first == selection.clamped {
            return Verdict::Unsure;
        }
        let mut near = None;
        for entry in selection.first as u32..self.receiver.map_count {
            let map = &self.receiver.maps[entry as usize];
            let is_first = entry.cast_signed() == selection.first;
            if !is_first && self.free(entry, map, surface.position) < 0.0 {
                continue;
            }
            let projected = self.project(map, surface.position, surface.normal);
            let spread = self.spread_in(entry, map, surface);
            let rise = self.rise_in_map(map, surface);
            let is_soft = self.descriptor.filter.is_soft();
            let close = || self.footprint(map, &projected, spread, rise);
            match if is_soft { self.soft_footprint(map, &projected, spread, rise) } else { close() } {
                Verdict::TooWide if self.descriptor.selection.is_by_coverage() => {
                    near = if is_first && is_soft { Some(close()) } else { near };
                }
                Verdict::TooWide => return Verdict::Unsure,
                verdict => {
                    let is_contrary = near.is_some_and(|near| near != Verdict::TooWide && near != verdict);
                    return if is_contrary { Verdict::Unsure } else { verdict };
                }
            }
        }
        Verdict::Unsure
    }

    fn project(&self, map: &MapUniform, position: Vec3, normal: Vec3) -> Projected {
        let cosine = dot(normal, self.receiver.to_light.into()).clamp(MIN_COSINE, 1.0);
        let sine = (1.0 - cosine * cosine).sqrt();
        let offset = normal * (map.normal_offset * sine);
        let uv = texture_place(map, (position + offset).extend(1.0));
        let [u, v] = [map.depth_per_texel_u, map.depth_per_texel_v].map(|change| dot(change.into(), normal));
        let gradient = Vec2::new(u, v) / cosine;
        let rise = map.receiver_plane * (gradient.x.abs() + gradient.y.abs());
        let depth = uv.z + map.constant_depth + map.slope_depth * sine / cosine + rise;
        let texel = uv.truncate() * Vec2::from(map.size) + self.slack;
        Projected { texel, surface: uv.z, depth, gradient }
    }

    /// Returns the greatest distance between the starts of a pixel's rays and its first sample in a map, in
    /// texels. It is larger in the last map.
    fn spread_in(&self, entry: u32, map: &MapUniform, surface: &Surface) -> Vec2 {
        let [right, down] = self.texels_per_pixel(map, surface);
        let in_map = |shift: Vec3| texture_place(map, shift.extend(0.0)).truncate() * Vec2::from(map.size);
        let above = in_map(surface.normal * self.height_at(surface.position));
        let along = in_map(surface.off);
        let is_coarsest = entry + 1 == self.receiver.map_count;
        let beside = if is_coarsest { COARSEST_FOOTPRINT - FOOTPRINT } else { 0.0 };
        self.point_reach * (right.abs() + down.abs()) + above.abs() + along.abs() + beside
    }

    /// Returns how much nearer to the light a point's plane may be in depth, because the surface may be
    /// nearer to the eye.
    fn rise_in_map(&self, map: &MapUniform, surface: &Surface) -> f32 {
        let to_light = Vec3::from(self.receiver.to_light);
        let depth = texture_place(map, to_light.extend(0.0)).z;
        depth * dot(surface.off, surface.normal).abs() / dot(surface.normal, to_light).max(MIN_COSINE)
    }

    fn footprint(&self, map: &MapUniform, projected: &Projected, spread: Vec2, rise: f32) -> Verdict {
        let first = (projected.texel - spread - 0.5).floor() - (FOOTPRINT - 1.0);
        let last = (projected.texel + spread - 0.5).floor() + FOOTPRINT;
        let blocks = ((last - first + 1.0) * 0.5).ceil();
        let is_whole = first.cmpge(Vec2::ZERO).all() && (first + 2.0 * blocks).cmple(Vec2::from(map.size)).all();
        if !(is_whole && blocks.cmple(Vec2::splat(MOST_BLOCKS)).all()) {
            return Verdict::TooWide;
        }
        let is_reversed = self.descriptor.depth == DepthConvention::Reversed;
        let toward_light = if is_reversed { 1.0 } else { -1.0 };
        let steepness = projected.gradient.x.abs() + projected.gradient.y.abs();
        let rounding = map.constant_depth + toward_light * ROUNDED_TEXEL * steepness;
        let [mut is_lit, mut is_shadowed] = [true; 2];
        for row in 0..(2.0 * blocks.y) as u32 {
            for column in 0..(2.0 * blocks.x) as u32 {
                // Depths of a block are computed from its corner, half a texel away.
                let texel = first + Vec2::new(column as f32, row as f32);
                let corner = first + 1.0 + 2.0 * Vec2::new((column / 2) as f32, (row / 2) as f32);
                let offset = corner - projected.texel;
                let change = projected.gradient.x * offset.x + projected.gradient.y * offset.y;
                let biased = (projected.depth + rise + change).clamp(0.0, 1.0);
                let [x, y] = [(column, projected.gradient.x), (row, projected.gradient.y)]
                    .map(|(place, gradient)| if place % 2 == 0 { -gradient * 0.5 } else { gradient * 0.5 });
                let plane = (projected.surface + rounding + change + (y + x)).clamp(0.0, 1.0);
                let stored = self.stored_at(map, texel);
                let moved = self.depth_slack(steepness);
                is_lit &= self.is_nearer(plane + moved, stored);
                is_shadowed &= !self.is_nearer(biased + moved, stored);
            }
        }
        match (is_shadowed, is_lit) {
            (true, _) => Verdict::Shadowed,
            (false, true) => Verdict::Lit,
            _ => Verdict::Unsure,
        }
    }

    /// Returns the shift of depths on a plane with this depth change over a texel.
    fn depth_slack(&self, steepness: f32) -> f32 {
        self.slack * (steepness + DEPTH_ROUNDING / NEXT_TO)
    }

    /// Returns whether a depth is at least as near to the light as another one.
    fn is_nearer(&self, a: f32, b: f32) -> bool {
        if self.descriptor.depth == DepthConvention::Reversed { a >= b } else { a <= b }
    }

    fn stored_at(&self, map: &MapUniform, texel: Vec2) -> f32 {
        let size = Vec2::from(map.size);
        let shifted = texel + Vec2::from(map.texel_offset);
        let at = Vec2::select(shifted.cmpge(size), shifted - size, shifted);
        let [width, height] = self.descriptor.resolution;
        let index = (map.layer * height + at.y as u32) * width + at.x as u32;
        self.stored[index as usize]
    }
}

/// Returns a matrix times a vector, summed from the first column on.
fn transformed(m: &[Vec4; 4], v: Vec4) -> Vec4 {
    ((m[0] * v.x + m[1] * v.y) + m[2] * v.z) + m[3] * v.w
}

fn texture_place(map: &MapUniform, position: Vec4) -> Vec3 {
    transformed(&map.uv_from_world.map(Vec4::from), position).truncate()
}

fn dot(a: Vec3, b: Vec3) -> f32 {
    (a.x * b.x + a.y * b.y) + a.z * b.z
}

/// Returns the matrix from a pixel's column and row, and its depth minus the far plane's.
fn world_from_pixel(look: &Look) -> DMat4 {
    let [width, height] = look.size.map(f64::from);
    let clip_from_pixel = DMat4::from_cols(
        DVec4::X * (2.0 / width),
        DVec4::Y * (-2.0 / height),
        DVec4::Z,
        DVec4::new(1.0 / width - 1.0, 1.0 - 1.0 / height, f64::from(look.convention.far()), 1.0),
    );
    look.camera.clip_from_world(look.convention).as_dmat4().inverse() * clip_from_pixel
}

fn forward(to_world: &DMat4, look: &Look) -> Vec3 {
    let [x, y] = look.size.map(|side| f64::from(side) * 0.5 - 0.5);
    let far = f64::from(look.convention.far());
    let [less, more] = [0.25, 0.75].map(|depth| to_world.project_point3(DVec3::new(x, y, depth - far)));
    let forward = if look.convention == DepthConvention::Reversed { less - more } else { more - less };
    forward.normalize_or_zero().as_vec3()
}

/// Returns the uniform of the look-up, with the depth change per texel even without receiver-plane bias.
fn on_planes(maps: &[FittedMap], view: &MapView, descriptor: &ShadowMapDescriptor) -> ReceiverUniform {
    let (reader, reading) = (view.reader(), descriptor.reading());
    let mut uniform = ReceiverUniform::new(maps, &reader, &reading).with_fade(descriptor.fade).with_frame(view.frame);
    for slot in uniform.maps.iter_mut().take(uniform.map_count as usize) {
        let map = &maps[slot.layer as usize];
        let with_plane = FittedMap { bias: Bias { receiver_plane: 1.0, ..map.bias }, ..*map };
        let MapUniform { depth_per_texel_u, depth_per_texel_v, .. } =
            MapUniform::new(&with_plane, view.origin, &reading);
        *slot = MapUniform { depth_per_texel_u, depth_per_texel_v, ..*slot };
    }
    uniform
}
