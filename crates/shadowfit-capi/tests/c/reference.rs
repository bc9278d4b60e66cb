//! Writes results of the core for the tests in C: `walk.bin`, a walk of 60 frames, and `xna.bin`, the matrices of the
//! XNA sample. C must compute the same.
//!
//! Files are numbers in the byte order of this machine, as `tests.c` reads them.

use std::fs;
use std::io::Write;
use std::path::PathBuf;

use serde_json::Value;
use shadowfit::culling::{CasterVolume, Reader};
use shadowfit::demand::{COUNTS, Counts, DepthRows, VisibleDemandSpace};
use shadowfit::glam::{DVec2, DVec3, Vec3};
use shadowfit::scroll::{Scroll, TexelRect};
use shadowfit::settings::MAX_MAPS;
use shadowfit::uniform::{CasterUniform, ReceiverUniform};
use shadowfit::{
    Aabb, Boxes, DepthConvention, FitInput, FitState, FittedMap, FittedMaps, PerspectiveCamera, Scratch, Technique,
    ViewFrustum,
};

const FRAMES: u32 = 60;
/// Size of the depth buffers, in pixels.
const SIZE: [u32; 2] = [96, 54];
/// Far from the world's origin, where f32 positions would be too coarse.
const ORIGIN: DVec3 = DVec3::new(20_000.0, 0.0, -30_000.0);

/// A file of numbers.
#[derive(Default)]
struct File(Vec<u8>);

impl File {
    fn ints(&mut self, numbers: impl IntoIterator<Item = u32>) {
        numbers.into_iter().for_each(|number| self.0.extend(number.to_ne_bytes()));
    }

    fn floats(&mut self, numbers: impl IntoIterator<Item = f32>) {
        numbers.into_iter().for_each(|number| self.0.extend(number.to_ne_bytes()));
    }

    fn doubles(&mut self, numbers: impl IntoIterator<Item = f64>) {
        numbers.into_iter().for_each(|number| self.0.extend(number.to_ne_bytes()));
    }

    fn save(&self, name: &str) -> std::io::Result<()> {
        let folder = std::env::args_os().nth(1).map_or_else(PathBuf::new, PathBuf::from);
        fs::File::create(folder.join(name))?.write_all(&self.0)
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    walk()?.save("walk.bin")?;
    xna()?.save("xna.bin")?;
    Ok(())
}

/// Returns a ground and rows of houses.
fn boxes() -> Vec<Aabb> {
    let house = |index: u32| {
        let (column, row) = ((index % 12) as f32, (index / 12) as f32);
        let (x, z) = (column * 17.0 - 100.0 + row, row * -19.0 + 60.0);
        let height = 3.0 + (index * 7 % 11) as f32;
        Aabb::new(Vec3::new(x, 0.0, z), Vec3::new(x + 9.0, height, z + 6.0))
    };
    let ground = Aabb::new(Vec3::new(-150.0, -1.0, -220.0), Vec3::new(150.0, 0.0, 120.0));
    std::iter::once(ground).chain((0..144).map(house)).collect()
}

fn camera(frame: u32) -> PerspectiveCamera {
    let turn = 0.3 + 0.008 * frame as f32;
    PerspectiveCamera {
        eye: ORIGIN + DVec3::new(0.15 * f64::from(frame), 1.7, 70.0 - 0.4 * f64::from(frame)),
        forward: Vec3::new(turn - 0.5, -0.12, -1.0),
        up: Vec3::Y,
        fov_y: 0.9,
        aspect: 16.0 / 9.0,
        near: 0.1,
        far: 400.0,
    }
}

/// Returns the light's direction. It turns in the second half of the walk.
fn light(frame: u32) -> Vec3 {
    Vec3::new(0.4 + 0.01 * frame.saturating_sub(40) as f32, -0.8, 0.3)
}

/// Returns the depths of the ground, with the sky above it.
fn depths(camera: &PerspectiveCamera) -> Vec<f32> {
    let world_from_clip = camera.clip_from_world(DepthConvention::Reversed).as_dmat4().inverse();
    let eye_height = camera.eye.y;
    let clip_from_world = camera.clip_from_world(DepthConvention::Reversed).as_dmat4();
    let depth = |x: u32, y: u32| {
        let ndc = |pixel: u32, pixels: u32| (f64::from(pixel) + 0.5) / f64::from(pixels) * 2.0 - 1.0;
        let near = world_from_clip.project_point3(DVec3::new(ndc(x, SIZE[0]), -ndc(y, SIZE[1]), 1.0));
        if near.y >= 0.0 {
            return 0.0;
        }
        clip_from_world.project_point3(near * (-eye_height / near.y)).z as f32
    };
    (0..SIZE[1]).flat_map(|y| (0..SIZE[0]).map(move |x| (x, y))).map(|(x, y)| depth(x, y)).collect()
}

fn walk() -> Result<File, Box<dyn std::error::Error>> {
    let mut file = File::default();
    let (boxes, technique) = (boxes(), Technique::default().with_max_distance(300.0));
    file.ints([FRAMES, boxes.len() as u32, SIZE[0], SIZE[1]]);
    file.doubles(ORIGIN.to_array());
    file.floats(boxes.iter().flat_map(|aabb| [aabb.min.to_array(), aabb.max.to_array()]).flatten());
    let list = Boxes { origin: ORIGIN, boxes: &boxes };
    let mut storage = vec![DVec2::ZERO; 40_000];
    let (mut fitter, mut counts) = (FitState::new(), vec![0; COUNTS].into_boxed_slice());
    let mut seen: Option<VisibleDemandSpace> = None;
    let mut kept: [Option<FittedMap>; MAX_MAPS] = [None; MAX_MAPS];
    for frame in 0..FRAMES {
        let (camera, light) = (camera(frame), light(frame));
        let view = camera.frustum()?;
        write_input(&mut file, &camera, light);
        // Every fourth frame knows the depths of the frame before.
        let tells = frame % 4 == 1;
        file.ints([tells.into()]);
        if tells {
            let before = self::camera(frame - 1);
            let depths = depths(&before);
            file.floats(depths.iter().copied());
            let counts = counts.first_chunk_mut().ok_or("too few counts")?;
            seen = Some(count(&before, light, &technique, &depths, counts)?);
        }
        let known: &Counts = counts.first_chunk().ok_or("too few counts")?;
        let grid = seen.map(|seen| seen.grid(known));
        let histogram = seen.map(|seen| seen.histogram(known));
        let input = FitInput {
            receivers: Some(list),
            casters: Some(list),
            demand: grid.as_slice(),
            histogram,
            ..FitInput::new(std::slice::from_ref(&view), light)
        };
        let maps = fitter.fit(&input, &technique, &mut Scratch::new(&mut storage))?;
        write_maps(&mut file, &maps, &technique, &view, &list, frame, &mut kept)?;
    }
    Ok(file)
}

fn write_input(file: &mut File, camera: &PerspectiveCamera, light: Vec3) {
    let PerspectiveCamera { eye, forward, up, fov_y, aspect, near, far } = *camera;
    file.doubles(eye.to_array());
    file.floats(forward.to_array().into_iter().chain(up.to_array()).chain([fov_y, aspect, near, far]));
    file.floats(light.to_array());
}

fn count(
    camera: &PerspectiveCamera,
    light: Vec3,
    technique: &Technique,
    depths: &[f32],
    counts: &mut Counts,
) -> Result<VisibleDemandSpace, shadowfit::FitError> {
    let (view, depth) = (camera.frustum()?, DepthConvention::Reversed);
    let space = VisibleDemandSpace::new(&view, light, technique.fit.up, technique.fit.max_distance)?;
    counts.fill(0);
    let clip_from_world = camera.clip_from_world(depth);
    space.count_rows(counts, &DepthRows { depths, width: SIZE[0], clip_from_world, depth, view: &view }, 3)?;
    Ok(space)
}

/// Writes everything that C must compute from a fit.
fn write_maps(
    file: &mut File,
    maps: &FittedMaps,
    technique: &Technique,
    view: &ViewFrustum,
    list: &Boxes,
    frame: u32,
    kept: &mut [Option<FittedMap>; MAX_MAPS],
) -> Result<(), shadowfit::FitError> {
    let origin = view.origin;
    file.ints([maps.len() as u32]);
    let volumes = maps.caster_volumes(std::slice::from_ref(view), technique)?;
    let mut read = Vec::new();
    for (index, map) in maps.iter().enumerate() {
        let moved = map.relative_to(origin);
        let fit = &moved.projection;
        for matrix in [fit.clip_from_world, fit.uv_from_world, fit.light_from_world] {
            file.floats(matrix.to_cols_array());
        }
        let bias = &moved.bias;
        file.floats([bias.constant_depth, bias.slope_depth, bias.normal_offset, bias.receiver_plane]);
        file.floats([fit.texel_size.x, fit.texel_size.y, fit.depth_range, moved.shader_end()]);
        let visible = volumes[index].cut_at_near_plane(&map.projection);
        let all = CasterVolume::of_map(&map.projection, technique.fit.casters);
        for volume in [visible, all] {
            let found: Vec<u32> = volume.casters_in(list).map(|index| index as u32).collect();
            file.ints([found.len() as u32]);
            file.ints(found);
        }
        let update = update(kept[index].as_ref(), map);
        file.ints([update.kind, update.offset[0], update.offset[1], update.rects.len() as u32]);
        file.ints(update.rects.iter().flatten().copied());
        let drawn = FittedMap { texel_offset: update.offset.into(), ..*map };
        kept[index] = Some(drawn);
        read.push(drawn);
        let caster = CasterUniform::new(&map.projection, origin);
        file.floats(caster.clip_from_world.into_iter().flatten());
    }
    let reader = Reader { origin, eye: view.origin, forward: view.forward };
    let uniform = ReceiverUniform::new(&read, &reader, &technique.reading());
    write_receiver(file, &uniform.with_fade(technique.fade_depths()).with_frame(frame));
    Ok(())
}

/// An update as C returns it.
struct Update {
    kind: u32,
    offset: [u32; 2],
    /// Column, row, width and height in the texture, and the corner of the viewport as unsigned numbers.
    rects: Vec<[u32; 6]>,
}

fn update(before: Option<&FittedMap>, now: &FittedMap) -> Update {
    let size = now.projection.resolution;
    let whole = || Update { kind: 2, offset: [0; 2], rects: vec![[0, 0, size.x, size.y, 0, 0]] };
    let Some(before) = before else { return whole() };
    let scroll = Scroll::between(before, now);
    if scroll.is_redraw() {
        return whole();
    }
    let offset = scroll.texel_offset(before.texel_offset, size);
    let pieces = scroll.exposed().flat_map(|strip: TexelRect| strip.stored(offset, size));
    let rects: Vec<[u32; 6]> = pieces
        .map(|piece| {
            let (stored, viewport) = (piece.stored, piece.viewport());
            let corner = [viewport.x.cast_unsigned(), viewport.y.cast_unsigned()];
            [stored.min.x, stored.min.y, stored.size.x, stored.size.y, corner[0], corner[1]]
        })
        .collect();
    Update { kind: u32::from(!rects.is_empty()), offset: offset.to_array(), rects }
}

/// Writes the bytes of the block, field by field.
fn write_receiver(file: &mut File, block: &ReceiverUniform) {
    file.floats(block.to_light);
    file.ints([block.map_count]);
    file.floats(block.view);
    file.floats([block.fade_near, block.fade_width, block.least_disc, block.greatest_disc, block.frame_shift]);
    file.ints([block.is_off, 0, 0]);
    for map in &block.maps {
        file.floats(map.uv_from_world.into_iter().flatten());
        file.floats(map.depth_per_texel_u.into_iter().chain([map.constant_depth]));
        file.floats(map.depth_per_texel_v.into_iter().chain([map.slope_depth]));
        file.floats(map.size.into_iter().chain([map.normal_offset, map.receiver_plane, map.far, map.blend_near]));
        file.ints([map.layer, 0]);
        file.floats(map.texel_offset.into_iter().chain(map.disc).chain(map.penumbra));
        file.ints([0, 0]);
    }
}

/// Returns the cameras, lights and matrices of the sample's cases.
fn xna() -> Result<File, Box<dyn std::error::Error>> {
    let cases: Value = serde_json::from_str(include_str!("../../../shadowfit/tests/data/xna_fit_cases.json"))?;
    let cases = cases["cases"].as_array().ok_or("no cases")?;
    let numbers =
        |value: &Value| -> Vec<f64> { value.as_array().into_iter().flatten().filter_map(Value::as_f64).collect() };
    let mut file = File::default();
    file.ints([cases.len() as u32]);
    for case in cases {
        let camera = &case["camera"];
        file.doubles(numbers(&camera["eye"]));
        file.doubles(numbers(&camera["forward"]));
        file.doubles(["fov_y", "aspect", "near", "far"].map(|key| camera[key].as_f64().unwrap_or_default()));
        file.doubles(numbers(&case["to_light"]));
        file.doubles(numbers(&case["light_view_projection"]));
    }
    Ok(file)
}
