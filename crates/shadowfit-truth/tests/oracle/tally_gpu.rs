//! The GPU's sums, compared with its own texture of classes and with the CPU's sums.

use glam::{DVec3, Vec3};
use shadowfit_testing::{TestGpu, test_gpu};
use shadowfit_truth::gpu::{GpuBefore, GpuJudge, GpuJudgeInput, GpuPixel, GpuTally, GpuTracer, GpuTruthError};
use shadowfit_truth::{
    Class, Judged, MapReading, MapsBefore, MeasuredMap, PictureMaps, PictureTally, Tracer, Truth, crawl, judge,
};

use super::agreement_gpu::{Picture, boxes, seen_texture, sun};
use super::scenes::{PlainMap, map_around};

/// Width of a bin of pixels per texel, in octaves.
const BIN: f64 = 1.0 / 32.0;

/// A device with a scene and a judge.
struct Bench {
    device: wgpu::Device,
    queue: wgpu::Queue,
    tracer: GpuTracer,
    judge: GpuJudge,
    seen: wgpu::TextureView,
}

/// A picture that both the CPU and the GPU have judged.
struct Both {
    truth: Truth,
    judged: Judged,
    factors: Vec<f32>,
    pixels: Vec<GpuPixel>,
    tally: GpuTally,
}

/// The maps of the previous frame, and their factors.
struct Before<'a> {
    maps: &'a [MeasuredMap],
    eye: DVec3,
    forward: DVec3,
    factors: Vec<f32>,
}

impl Bench {
    fn new(picture: &Picture, seen: &[Option<u32>], factors: &[f32]) -> Self {
        let TestGpu { device, queue, .. } = test_gpu();
        let tracer = GpuTracer::new(&device, &queue, &picture.tracer, picture.origin).expect("a scene that fits");
        let texture = seen_texture(&device, &queue, picture.camera.size, seen, factors);
        let seen = texture.create_view(&wgpu::TextureViewDescriptor::default());
        let judge = GpuJudge::new(&device);
        Self { device, queue, tracer, judge, seen }
    }

    /// Creates a bench whose picture shows only the scene, lit everywhere.
    fn lit(picture: &Picture) -> Self {
        let seen = Truth::seen_by_rays(&picture.tracer, &picture.camera);
        let lit = vec![1.0; seen.len()];
        Self::new(picture, &seen, &lit)
    }

    fn record(
        &mut self,
        picture: &Picture,
        maps: &PictureMaps,
        before: Option<GpuBefore>,
    ) -> Result<wgpu::CommandBuffer, GpuTruthError> {
        let mut encoder = self.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let input = GpuJudgeInput {
            camera: &picture.camera,
            settings: &picture.settings,
            maps,
            before,
            timestamp_writes: None,
        };
        self.judge.judge(&self.device, &self.queue, &mut encoder, &self.tracer, &self.seen, &input)?;
        Ok(encoder.finish())
    }

    fn finish(&self) {
        self.device.poll(wgpu::PollType::wait_indefinitely()).expect("a device that answers");
    }

    fn take(&mut self) -> Option<GpuTally> {
        self.judge.take(&self.device).expect("a device that is there")
    }

    /// Returns the picture's number, if its sums have come back.
    fn take_number(&mut self) -> Option<u64> {
        self.take().map(|tally| tally.picture)
    }
}

impl Both {
    fn new(picture: &Picture, before: Option<&Before>) -> Self {
        let measured = picture.measured();
        let maps = picture.picture_maps(&measured);
        let seen = Truth::seen_by_rays(&picture.tracer, &picture.camera);
        let truth = Truth::trace(&picture.tracer, &picture.camera, &picture.settings, &seen);
        let factors = uneven(&picture.factors(&maps, &truth));
        let mut judged = judge(&picture.tracer, &truth, &maps, &factors, |_| true);
        let mut bench = Bench::new(picture, &seen, &factors);
        let texture = before.map(|before| {
            let texture = seen_texture(&bench.device, &bench.queue, picture.camera.size, &seen, &before.factors);
            texture.create_view(&wgpu::TextureViewDescriptor::default())
        });
        let maps_before = before.map(|before| picture.picture_maps(before.maps));
        let gpu_before = before
            .zip(maps_before.as_ref())
            .zip(texture.as_ref())
            .map(|((before, maps), seen)| GpuBefore { maps, eye: before.eye, forward: before.forward, seen });
        let commands = bench.record(picture, &maps, gpu_before).expect("a picture that the GPU can judge");
        bench.queue.submit([commands]);
        let pixels = bench.judge.read(&bench.device, &bench.queue).expect("the classes");
        let tally = bench.take().expect("the device was waited for");
        if let Some((before, maps)) = before.zip(maps_before) {
            let Before { eye, forward, factors: factors_before, .. } = before;
            let before = MapsBefore { maps, eye: *eye, forward: *forward, factors: factors_before };
            judged.tally.add_crawl(&crawl(&truth, &judged, &factors, &before));
        }
        Self { truth, judged, factors, pixels, tally }
    }

    /// Returns the pixels that the GPU judged.
    fn facing(&self) -> impl Iterator<Item = usize> {
        (0..self.pixels.len()).filter(|pixel| self.pixels[*pixel].class != Class::NotJudged)
    }

    fn count(&self, is_counted: impl Fn(&GpuPixel) -> bool) -> u64 {
        self.facing().filter(|pixel| is_counted(&self.pixels[*pixel])).count() as u64
    }

    /// Asserts that the tally matches the texture of classes, exactly where the texture holds all of the
    /// information.
    fn assert_sums_of_texture(&self, name: &str) {
        let tally = &self.tally;
        let of = |class: Class| self.count(|pixel| pixel.class == class);
        let wrong = [Class::FalseShadow, Class::FalseLight, Class::Hole, Class::Edge].map(of);
        let found = [tally.all.false_shadow, tally.all.false_light, tally.all.hole, tally.all.edge];
        assert_eq!(found, wrong, "{name}");
        assert_eq!((tally.all.facing, tally.all.wrong), (self.count(|_| true), wrong.iter().sum()), "{name}");
        assert_eq!(tally.lit, self.count(|pixel| pixel.is_lit), "{name}");
        assert_eq!(tally.edge_zone, self.count(|pixel| pixel.is_in_edge_zone), "{name}");
        assert_eq!(tally.uncovered, self.count(|pixel| pixel.map_index.is_none()), "{name}");
        let error: f64 = self
            .facing()
            .map(|pixel| {
                let lit = f64::from(u8::from(self.pixels[pixel].is_lit));
                let factor = if self.factors[pixel].is_nan() { 0.0 } else { self.factors[pixel].clamp(0.0, 1.0) };
                (f64::from(factor) - lit).abs()
            })
            .sum();
        assert!((tally.error - error).abs() <= 1e-5 * tally.all.facing as f64, "{name}: {} {error}", tally.error);
        // The cosines come from the truth on the CPU, which may find another surface at a few pixels.
        let light = |weight: &dyn Fn(usize) -> f64| -> f64 {
            let facing = |pixel: usize| self.truth.points[pixel].map_or(0.0, |point| point.facing);
            self.facing().map(|pixel| facing(pixel) * weight(pixel)).sum()
        };
        let error_of = |pixel: usize| {
            let factor = if self.factors[pixel].is_nan() { 0.0 } else { self.factors[pixel].clamp(0.0, 1.0) };
            (f64::from(factor) - f64::from(u8::from(self.pixels[pixel].is_lit))).abs()
        };
        let sums = [(tally.light, light(&|_| 1.0)), (tally.light_error, light(&error_of))];
        for (found, wanted) in sums {
            assert!((found - wanted).abs() <= 1e-4 * tally.all.facing as f64, "{name}: light {found}, not {wanted}");
        }
        self.assert_texels_of_texture(name);
    }

    /// Asserts the same for pixels per texel, of the pixels that are not grazing on the CPU.
    fn assert_texels_of_texture(&self, name: &str) {
        let is_grazing = |pixel: usize| self.truth.points[pixel].is_some_and(|point| point.facing < 0.05);
        let mut bins = vec![0u64; 1024];
        let mut undersampled = [0, 0];
        let grazing = self.facing().filter(|pixel| is_grazing(*pixel)).count() as u64;
        for pixel in self.facing().filter(|pixel| !is_grazing(*pixel)) {
            let pixels_per_texel = f64::from(self.pixels[pixel].pixels_per_texel);
            if self.pixels[pixel].map_index.is_some() {
                // Bins begin half a step early, where the texture's values round to the same step.
                let bin = ((pixels_per_texel.log2() + 1e-4) / BIN).floor() + 512.0;
                bins[bin.clamp(0.0, 1023.0) as usize] += 1;
                // The texture has one step for the values on either side of 1.
                undersampled[0] += u64::from(pixels_per_texel > 1.001);
                undersampled[1] += u64::from(pixels_per_texel > 0.999);
            }
        }
        assert_eq!((self.tally.grazing.facing, &self.tally.pixels_per_texel), (grazing, &bins), "{name}");
        let found = self.tally.undersampled;
        assert!((undersampled[0]..=undersampled[1]).contains(&found), "{name}: {found} {undersampled:?}");
    }

    /// Asserts that all figures match the CPU's to 0.5% of the pixels, within which the two agree about
    /// classes.
    fn assert_figures_of_cpu(&self, name: &str) {
        let tally: &PictureTally = &self.judged.tally;
        let (found, wanted) = (self.tally.figures().expect("figures"), tally.figures().expect("figures"));
        println!("{name}: {found:?}\n{wanted:?}");
        let shares = [
            (found.wrong, wanted.wrong),
            (found.false_shadow, wanted.false_shadow),
            (found.false_light, wanted.false_light),
            (found.hole, wanted.hole),
            (found.edge, wanted.edge),
            (found.edge_zone, wanted.edge_zone),
            (found.uncovered, wanted.uncovered),
            (found.mean_error, wanted.mean_error),
            (found.light_error, wanted.light_error),
            (found.grazing, wanted.grazing),
            (found.grazing_wrong, wanted.grazing_wrong),
            (found.undersampled.unwrap_or(-1.0), wanted.undersampled.unwrap_or(-1.0)),
        ];
        for (number, (found, wanted)) in shares.into_iter().enumerate() {
            assert!((found - wanted).abs() <= 0.5, "{name}, share {number}: {found}, not {wanted}");
        }
        let quantiles = found.pixels_per_texel.zip(wanted.pixels_per_texel).expect("pixels in maps");
        for (found, wanted) in quantiles.0.into_iter().zip(quantiles.1) {
            assert!((found.log2() - wanted.log2()).abs() <= BIN, "{name}: {found}, not {wanted}");
        }
        assert_eq!(found.edge_distance, None);
    }
}

/// Factors between 0 and 1 with the same verdicts, and some that are out of range or NaN.
fn uneven(factors: &[f32]) -> Vec<f32> {
    let odd = |(pixel, factor): (usize, &f32)| match pixel % 11 {
        0 if *factor == 0.0 => f32::NAN,
        1 if *factor == 0.0 => -3.5,
        2 if *factor == 1.0 => f32::INFINITY,
        step => 0.05 * step as f32 * (1.0 - 2.0 * factor) * 0.9 + factor,
    };
    factors.iter().enumerate().map(odd).collect()
}

fn picture() -> Picture {
    Picture::new(boxes(), DVec3::new(-4.0, 3.0, 5.0), sun())
}

/// Returns the picture at another size.
fn sized(size: [u32; 2]) -> Picture {
    let mut picture = picture();
    picture.camera.size = size;
    picture
}

#[test]
fn the_tally_is_the_sum_of_the_classes_and_has_the_cpu_s_figures() {
    let grazing = DVec3::new(1.0, 0.04, 0.4).normalize();
    let pictures = [
        ("by view depth", picture()),
        ("by coverage", Picture::with_crossing_maps(8.0)),
        ("grazing", Picture::new(boxes(), DVec3::new(-4.0, 3.0, 5.0), grazing)),
    ];
    for (name, picture) in pictures {
        let both = Both::new(&picture, None);
        assert!(both.tally.all.facing > 5000, "{name}: {:?}", both.tally.all);
        both.assert_sums_of_texture(name);
        both.assert_figures_of_cpu(name);
        let crawl = (both.tally.crawl_compared, both.tally.figures().expect("figures").crawl);
        assert_eq!((both.tally.picture, crawl), (1, (0, None)), "{name}");
    }
}

#[test]
fn all_of_the_classes_are_in_the_sums_of_pictures_of_any_size() {
    // Sizes below, at and above the squares of 32 pixels that a workgroup sums, and one pixel that shows the
    // ground.
    for size in [[37, 23], [1, 1], [32, 32], [65, 1], [1, 65], [320, 180]] {
        let both = Both::new(&sized(size), None);
        both.assert_sums_of_texture(&format!("{size:?}"));
        assert!(both.tally.all.facing > 0, "{size:?}");
    }
}

#[test]
fn grazing_and_uncovered_pixels_have_no_texels_and_are_listed_apart() {
    let mut picture = Picture::new(boxes(), DVec3::new(-4.0, 3.0, 5.0), DVec3::new(1.0, 0.04, 0.4).normalize());
    picture.maps.clear();
    let tally = Both::new(&picture, None).tally;
    let figures = tally.figures().expect("figures");
    assert_eq!((tally.uncovered, figures.uncovered), (tally.all.facing, 100.0));
    assert!(tally.grazing.facing > 100 && figures.grazing > 1.0, "{tally:?}");
    assert_eq!((figures.pixels_per_texel, figures.undersampled), (None, None));
}

#[test]
fn a_picture_in_which_nothing_is_judged_has_no_figures() {
    let mut empty = picture();
    empty.tracer = Tracer::new(Vec::<[Vec3; 3]>::new());
    let tally = Both::new(&empty, None).tally;
    assert_eq!((tally.picture, tally.all.facing, tally.figures()), (1, 0, None));
}

/// Returns the picture with maps that are moved by half a metre and have other widths and splits.
fn before_of(seen: &Picture) -> Picture {
    let mut before = picture();
    before.reading = seen.reading;
    let moved = |(width, split_far): (f64, f64)| PlainMap {
        split_far,
        ..map_around(DVec3::new(0.5, 0.0, 0.1), sun(), width, 6.0, 300)
    };
    before.maps = [(6.0, 5.0), (20.0, 7.5), (5.0, 7.5), (7.0, 7.5)].map(moved).to_vec();
    before
}

#[test]
fn crawl_is_counted_as_on_the_cpu_at_points_that_both_frames_maps_hold() {
    for (reading, seen) in [("by view depth", picture()), ("by coverage", Picture::with_crossing_maps(8.0))] {
        let before = before_of(&seen);
        let measured = before.measured();
        let rays = Truth::seen_by_rays(&seen.tracer, &seen.camera);
        let truth = Truth::trace(&seen.tracer, &seen.camera, &seen.settings, &rays);
        let forward = (seen.camera.forward + DVec3::Y * 0.3).normalize();
        let before = Before {
            maps: &measured,
            eye: seen.camera.eye - seen.camera.forward * 0.7,
            forward,
            factors: uneven(&before.factors(&before.picture_maps(&measured), &truth)),
        };
        let both = Both::new(&seen, Some(&before));
        let [found, wanted] = [
            [both.tally.crawl_compared, both.tally.crawl_different],
            [both.judged.tally.crawl_compared, both.judged.tally.crawl_different],
        ];
        println!("{reading}: {found:?}, {wanted:?}");
        assert!(wanted[0] > 1000 && wanted[1] > 50 && wanted[0] < both.judged.tally.edge_zone, "{reading}: {wanted:?}");
        for (found, wanted) in found.into_iter().zip(wanted) {
            assert!(found.abs_diff(wanted) as f64 <= 0.005 * wanted as f64 + 1.0, "{reading}: {found}, not {wanted}");
        }
        let crawl = both.tally.figures().and_then(|figures| figures.crawl).expect("compared");
        assert_eq!(crawl, 100.0 * (found[1] as f64 / found[0] as f64));
        both.assert_sums_of_texture(reading);
    }
}

#[test]
fn nothing_is_compared_where_the_maps_before_hold_nothing() {
    let seen = picture();
    let away = [map_around(DVec3::X * 500.0, sun(), 6.0, 4.0, 64).measured(sun())];
    let (eye, forward) = (seen.camera.eye, seen.camera.forward);
    for maps in [&away[..], &[]] {
        let factors = vec![1.0; seen.camera.pixels()];
        let tally = Both::new(&seen, Some(&Before { maps, eye, forward, factors })).tally;
        assert_eq!((tally.crawl_compared, tally.crawl_different), (0, 0));
        assert!(tally.edge_zone > 0);
    }
}

#[test]
fn pictures_that_nobody_takes_hold_up_nothing_and_the_newest_can_be_taken() {
    let picture = picture();
    let measured = picture.measured();
    let maps = picture.picture_maps(&measured);
    let mut bench = Bench::lit(&picture);
    assert_eq!((bench.judge.pictures(), bench.take()), (0, None));
    for number in 1..=10 {
        let commands = bench.record(&picture, &maps, None).expect("a picture");
        assert_eq!(bench.judge.pictures(), number);
        bench.queue.submit([commands]);
        bench.finish();
    }
    assert_eq!([bench.take_number(), bench.take_number()], [Some(10), None]);
}

#[test]
fn pictures_that_come_faster_than_their_sums_are_judged_and_not_summed() {
    let picture = picture();
    let measured = picture.measured();
    let maps = picture.picture_maps(&measured);
    let mut bench = Bench::lit(&picture);
    // Nothing is submitted, so no picture is finished.
    let recorded: Vec<_> = (0..10).map(|_| bench.record(&picture, &maps, None).expect("a picture")).collect();
    assert_eq!((bench.judge.pictures(), bench.take()), (10, None));
    bench.queue.submit(recorded);
    bench.finish();
    assert_eq!([bench.take_number(), bench.take_number()], [Some(3), None]);
    // All buffers are free again.
    let next = bench.record(&picture, &maps, None).expect("a picture");
    bench.queue.submit([next]);
    bench.finish();
    assert_eq!(bench.take_number(), Some(11));
}

#[test]
fn commands_that_are_never_submitted_keep_no_buffer() {
    let picture = picture();
    let measured = picture.measured();
    let maps = picture.picture_maps(&measured);
    let mut bench = Bench::lit(&picture);
    for _ in 0..5 {
        drop(bench.record(&picture, &maps, None).expect("a picture"));
    }
    let commands = bench.record(&picture, &maps, None).expect("a picture");
    bench.queue.submit([commands]);
    bench.finish();
    assert_eq!(bench.take_number(), Some(6));
}

#[test]
fn sums_are_named_by_their_picture_and_come_in_order() {
    let pictures = [picture(), sized([203, 117])];
    let measured = pictures[0].measured();
    let near = [measured[0]];
    let mut bench = Bench::lit(&pictures[0]);
    let mut sums: Vec<(u64, u64)> = Vec::new();
    for number in 1..=20u64 {
        // Every second picture has one map less, and more pixels without one.
        let maps = pictures[0].picture_maps(if number % 2 == 0 { &measured } else { &near });
        let commands = bench.record(&pictures[(number % 2) as usize], &maps, None).expect("a picture");
        bench.queue.submit([commands]);
        if number % 5 == 0 {
            bench.finish();
        }
        sums.extend(bench.take().map(|tally| (tally.picture, tally.uncovered)));
    }
    assert!(sums.len() >= 4 && sums.is_sorted_by(|a, b| a.0 < b.0), "{sums:?}");
    let uncovered = |parity: u64| sums.iter().filter(move |sum| sum.0 % 2 == parity).map(|sum| sum.1);
    let (few, many) = (uncovered(0).max().unwrap_or(0), uncovered(1).min().unwrap_or(u64::MAX));
    assert!(few < many, "{sums:?}");
}

#[test]
fn a_picture_that_is_refused_has_no_number() {
    let picture = picture();
    let measured = picture.measured();
    let maps = picture.picture_maps(&measured);
    let mut bench = Bench::lit(&picture);
    let many = vec![measured[0]; 9];
    let (eye, forward) = (picture.camera.eye, picture.camera.forward);
    let small = seen_texture(&bench.device, &bench.queue, [8, 8], &[None; 64], &[1.0; 64])
        .create_view(&wgpu::TextureViewDescriptor::default());
    let same = bench.seen.clone();
    let mut refused = |maps_before: &[MeasuredMap], seen: &wgpu::TextureView| {
        let maps_before = PictureMaps { reading: MapReading::ViewDepth, ..picture.picture_maps(maps_before) };
        let before = GpuBefore { maps: &maps_before, eye, forward, seen };
        bench.record(&picture, &maps, Some(before)).err()
    };
    let size = GpuTruthError::BeforeSize { before: [8, 8], camera: [203, 117] };
    assert_eq!(refused(&measured, &small), Some(size));
    assert_eq!(refused(&many, &same), Some(GpuTruthError::TooManyMaps(9)));
    assert_eq!(bench.judge.pictures(), 0);
}
