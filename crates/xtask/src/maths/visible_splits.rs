//! Splits from what is visible: a histogram of depth, and the splits that three schemes make of it.

use anyhow::Result;
use shadowfit::diagnostics::pixels_per_texel;
use shadowfit::glam::{DVec2, DVec3, UVec2, Vec3};
use shadowfit::histogram::{DepthHistogram, needed_texel};
use shadowfit::settings::{SplitScheme, Stabilise};
use shadowfit::{Aabb, DepthConvention, FitInput, FittedMaps, PerspectiveCamera};

use super::canvas::{BLUE, Canvas, Frame, GREY, INK, RED, SKY, Side, fill, stroke};
use super::scene::{Visible, boxes, plain_maps, visible};
use super::splits::{MAPS, cascades};

/// Where the sun travels.
const LIGHT: Vec3 = Vec3::new(0.42, -0.72, -0.3);

/// Size of the picture that is judged, in pixels.
const PICTURE: UVec2 = UVec2::new(1920, 1080);

/// Samples across and down the picture.
const SAMPLES: (u32, u32) = (96, 54);

/// Depth bins and classes of the histogram.
const BINS: usize = 40;
const CLASSES: usize = 4;

/// Depths of the histogram and of the plot, in metres.
const NEAR: f32 = 1.0;
const FAR: f32 = 120.0;

/// A square seen over a parapet: a terrace near by, nothing for a while, and houses far off.
const SQUARE: [Aabb; 6] = [
    Aabb::new(Vec3::new(-60.0, -0.5, -120.0), Vec3::new(60.0, 0.0, 0.0)),
    Aabb::new(Vec3::new(-8.0, 5.0, -5.0), Vec3::new(8.0, 6.6, -4.4)),
    Aabb::new(Vec3::new(-30.0, 0.0, -70.0), Vec3::new(-14.0, 13.0, -58.0)),
    Aabb::new(Vec3::new(-12.0, 0.0, -84.0), Vec3::new(4.0, 15.0, -72.0)),
    Aabb::new(Vec3::new(6.0, 0.0, -76.0), Vec3::new(22.0, 10.0, -62.0)),
    Aabb::new(Vec3::new(24.0, 0.0, -66.0), Vec3::new(40.0, 17.0, -52.0)),
];

/// A visible point that faces the light.
struct Sample {
    point: DVec3,
    normal: Vec3,
    depth: f32,
    class: f32,
}

pub(super) fn draw() -> Result<String> {
    let camera = PerspectiveCamera {
        eye: DVec3::new(0.0, 7.6, 0.0),
        forward: Vec3::new(0.0, -0.06, -1.0),
        up: Vec3::Y,
        fov_y: 0.7,
        aspect: 16.0 / 9.0,
        near: 0.3,
        far: FAR,
    };
    let samples = look_around(&camera)?;
    let mut counts = [0_u32; BINS * CLASSES];
    for sample in &samples {
        if let Some(bin) = DepthHistogram::bin(NEAR, FAR, BINS, CLASSES, sample.depth, sample.class) {
            counts[bin] += 1;
        }
    }
    let histogram = DepthHistogram { near: NEAR, far: FAR, bins: &counts, classes: CLASSES };
    let view = [camera.frustum()?];
    let receivers = Some(boxes(&SQUARE));
    let input = FitInput { receivers, histogram: Some(histogram), ..FitInput::new(&view, LIGHT) };
    let mut canvas = Canvas::new(520.0, "A histogram of visible depth, and the splits that three schemes make of it");
    bars(&mut canvas, &counts);
    let schemes = [
        ("Logarithmic", SplitScheme::Logarithmic),
        ("FromBoxes", SplitScheme::FromBoxes),
        ("FromHistogram", SplitScheme::FromHistogram),
    ];
    for (i, (name, splits)) in schemes.into_iter().enumerate() {
        let mut settings = plain_maps().with_splits(splits).with_stabilise(Stabilise::Off);
        settings.fit.max_distance = FAR;
        let maps = cascades(&input, &settings)?;
        let quantile = quantile(&camera, &samples, &maps)?;
        row(&mut canvas, &camera, &maps, 178.0 + 108.0 * i as f64, name, quantile);
    }
    let note = "black: pixels per texel of a surface head-on, from 1/16 to 16; dashed: one";
    canvas.label(DVec2::new(24.0, 504.0), Side::Right, note);
    Ok(canvas.finish())
}

/// What the camera sees of the boxes, sunny sides only.
fn look_around(camera: &PerspectiveCamera) -> Result<Vec<Sample>> {
    let light = LIGHT.normalize();
    let pixel = 2.0 * libm::tan(f64::from(camera.fov_y) * 0.5) / f64::from(PICTURE.y);
    let count = DVec2::new(f64::from(SAMPLES.0), f64::from(SAMPLES.1));
    let places = (0..SAMPLES.0 * SAMPLES.1)
        .map(|i| (DVec2::new(f64::from(i % SAMPLES.0), f64::from(i / SAMPLES.0)) + 0.5) / count);
    let lit = visible(camera, &SQUARE, places, PICTURE)?.into_iter().filter(|seen| seen.normal.dot(LIGHT) < 0.0);
    Ok(lit
        .map(|Visible { point, normal, depth, right, down }| {
            let texel = f64::from(needed_texel(right, down, light));
            let class = libm::log2(depth * pixel / texel) as f32;
            Sample { point: point.as_dvec3(), normal, depth: depth as f32, class }
        })
        .collect())
}

/// The 95% quantile of pixels per texel over the samples.
fn quantile(camera: &PerspectiveCamera, samples: &[Sample], maps: &FittedMaps) -> Result<f32> {
    let clip_from_world = camera.clip_from_world(DepthConvention::ZeroToOne);
    let mut errors = Vec::new();
    for sample in samples {
        let map = maps.iter().find(|map| sample.depth < map.far).unwrap_or(&maps[maps.len() - 1]);
        let point = sample.point.as_vec3();
        if let Some(pixels) = pixels_per_texel(&map.fit, &clip_from_world, PICTURE, point, sample.normal)? {
            errors.push(pixels.worse_axis);
        }
    }
    errors.sort_by(f32::total_cmp);
    Ok(errors[errors.len() * 95 / 100])
}

/// Takes log2 of depth and a height to a row of the page.
fn frame(top: f64, height: f64, low: f64, high: f64) -> Frame {
    let log = |depth: f32| libm::log2(f64::from(depth));
    let (min, max) = (DVec2::new(24.0, top), DVec2::new(564.0, top + height));
    Frame::stretched(DVec2::new(log(NEAR), low), DVec2::new(log(FAR), high), min, max)
}

/// The histogram, its classes on top of each other.
fn bars(canvas: &mut Canvas, counts: &[u32]) {
    let sums: Vec<u32> = (0..BINS).map(|bin| (0..CLASSES).map(|class| counts[class * BINS + bin]).sum()).collect();
    let most = f64::from(sums.into_iter().max().unwrap_or(1));
    let frame = frame(34.0, 100.0, 0.0, most);
    let step = libm::log2(f64::from(FAR / NEAR)) / BINS as f64;
    let shades = [(SKY, 0.55), (SKY, 1.0), (BLUE, 0.75), (INK, 0.9)];
    for bin in 0..BINS {
        let mut low = 0.0;
        for (class, (colour, opacity)) in shades.into_iter().enumerate() {
            let high = low + f64::from(counts[class * BINS + bin]);
            let (a, b) = (step * bin as f64 + 0.01, step * (bin + 1) as f64 - 0.01);
            if high > low {
                canvas.rectangle(frame.at(DVec2::new(a, low)), frame.at(DVec2::new(b, high)), fill(colour, opacity));
            }
            low = high;
        }
    }
    canvas.line(frame.at(DVec2::ZERO), frame.at(DVec2::new(step * BINS as f64, 0.0)), stroke(INK, 1.0));
    for depth in [1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0] {
        let at = frame.at(DVec2::new(libm::log2(depth), 0.0));
        canvas.small(at + DVec2::new(0.0, 16.0), Side::Middle, GREY, &format!("{depth} m"));
    }
    canvas.bold(DVec2::new(24.0, 24.0), Side::Right, INK, "Visible lit points by view depth");
    for (class, (colour, opacity)) in shades.into_iter().enumerate() {
        let y = 56.0 + 20.0 * class as f64;
        canvas.rectangle(DVec2::new(582.0, y - 11.0), DVec2::new(596.0, y + 3.0), fill(colour, opacity));
        let texel = ["1", "1/2", "1/4", "1/8, less"][class];
        canvas.small(DVec2::new(603.0, y + 1.0), Side::Right, INK, &format!("needs {texel}"));
    }
}

/// The slices between some splits, and the pixels per texel that a surface head-on would have in them.
fn row(canvas: &mut Canvas, camera: &PerspectiveCamera, maps: &FittedMaps, top: f64, name: &str, quantile: f32) {
    let frame = frame(top, 76.0, -4.0, 4.0);
    let pixel = 2.0 * libm::tan(f64::from(camera.fov_y) * 0.5) / f64::from(PICTURE.y);
    for (map, colour) in maps.iter().zip(MAPS) {
        let (near, far) = (f64::from(map.near.max(NEAR)), f64::from(map.far.min(FAR)));
        if near >= far {
            continue;
        }
        let (low, high) = (libm::log2(near), libm::log2(far));
        canvas.rectangle(frame.at(DVec2::new(low, -4.0)), frame.at(DVec2::new(high, 4.0)), fill(colour, 0.25));
        let texel = f64::from(map.fit.texel_size.max_element());
        let pixels = |depth: f64| libm::log2(texel / (depth * pixel)).clamp(-4.0, 4.0);
        let line = (0..=64).map(|i| {
            let log = low + (high - low) * f64::from(i) / 64.0;
            frame.at(DVec2::new(log, pixels(libm::exp2(log))))
        });
        canvas.path(line, stroke(INK, 2.2));
        let end = frame.at(DVec2::new(low, -4.0));
        canvas.line(end, end.with_y(top), stroke(colour, 2.0));
    }
    let one = |log: f64| frame.at(DVec2::new(log, 0.0));
    canvas.line(one(libm::log2(f64::from(NEAR))), one(libm::log2(f64::from(FAR))), stroke(RED, 1.2).dashed());
    canvas.small(DVec2::new(20.0, one(0.0).y + 4.0), Side::Left, RED, "1");
    canvas.bold(DVec2::new(576.0, top + 24.0), Side::Right, INK, name);
    canvas.label(DVec2::new(576.0, top + 44.0), Side::Right, "95% are below");
    canvas.bold(DVec2::new(576.0, top + 64.0), Side::Right, RED, &format!("{quantile:.2} px per texel"));
}
