//! A town of blocks, a walk through it, and two sets of the same maps: one keeps static casters, and the
//! other is drawn from scratch.

use shadowfit::cache::PassKind;
use shadowfit::glam::{DVec3, Vec3};
use shadowfit::{Aabb, Boxes, FitInput, FittedMap, PerspectiveCamera, Technique};
use shadowfit_wgpu::{ShadowPass, SunFrame, SunShadows};

use crate::engine::Engine;
use crate::engine::casters::{CasterShader, Casters, Shape};

/// Position of the town, far from the world's origin.
const PLACE: DVec3 = DVec3::new(12_000.0, 40.0, -7_000.0);

/// A block of the town.
#[derive(Clone, Copy, Debug)]
pub(super) struct Block {
    /// Centre in world space, in metres.
    pub(super) centre: DVec3,
    /// Half the size, in metres; negative for a block that is absent.
    pub(super) half: Vec3,
    /// Height of the centre at rest, in metres.
    height: f64,
    /// Identity of the block, independent of the order of the list.
    pub(super) id: u64,
    /// Share of its box that the block fills, along each axis.
    pub(super) fill: f32,
}

impl Block {
    /// Returns a key of the shape, independent of the position.
    fn key(&self) -> u64 {
        self.id << 32 | u64::from(self.fill.to_bits())
    }
}

/// The casters.
#[derive(Debug)]
pub(super) struct Town {
    pub(super) blocks: Vec<Block>,
    pub(super) moves: Vec<bool>,
    /// Whether casters have keys.
    pub(super) has_keys: bool,
}

impl Town {
    /// Returns a town in which every tenth block moves.
    pub(super) fn new() -> Self {
        let mut town = Self::still();
        town.moves = (0..town.blocks.len()).map(|number| number % 10 == 9).collect();
        town
    }

    /// Returns a town without moving blocks.
    pub(super) fn still() -> Self {
        let block = |x: f64, y: f64, z: f64, half: Vec3| Block {
            centre: PLACE + DVec3::new(x, y, z),
            half,
            height: PLACE.y + y,
            id: 0,
            fill: 1.0,
        };
        let mut blocks = vec![block(0.0, -0.5, 0.0, Vec3::new(80.0, 0.5, 80.0))];
        for i in 0..240_u32 {
            // Low-discrepancy positions.
            let place = |base: f64| (f64::from(i) * base).fract() * 120.0 - 60.0;
            let half = Vec3::new(0.3 + (i % 7) as f32 * 0.25, 0.4 + (i % 11) as f32 * 0.3, 0.3 + (i % 5) as f32 * 0.35);
            let block = block(place(0.754_877_67), f64::from(half.y), place(0.569_840_3), half);
            blocks.push(Block { id: u64::from(i) + 1, ..block });
        }
        Self { blocks, moves: Vec::new(), has_keys: false }
    }

    /// Moves the moving blocks up and down by half a metre, once per second.
    pub(super) fn bob(&mut self, frame: u32) {
        for (number, (block, moves)) in self.blocks.iter_mut().zip(&self.moves).enumerate() {
            if *moves {
                let phase = f64::from(frame) / 60.0 + number as f64 * 0.37;
                block.centre.y = block.height + 0.5 * (phase * core::f64::consts::TAU).sin();
            }
        }
    }

    fn keys(&self) -> Vec<u64> {
        self.blocks.iter().filter(|_| self.has_keys).map(Block::key).collect()
    }

    fn boxes(&self, origin: DVec3) -> Vec<Aabb> {
        let aabb = |block: &Block| {
            let centre = (block.centre - origin).as_vec3();
            Aabb::new(centre - block.half, centre + block.half)
        };
        self.blocks.iter().map(aabb).collect()
    }
}

/// A camera and a light.
#[derive(Debug)]
pub(super) struct Walk {
    pub(super) eye: DVec3,
    pub(super) forward: Vec3,
    pub(super) direction: Vec3,
}

impl Walk {
    pub(super) fn new() -> Self {
        let direction = Vec3::new(0.45, -0.8, 0.3).normalize();
        Self { eye: PLACE + DVec3::new(-20.0, 1.7, 25.0), forward: Vec3::NEG_Z, direction }
    }

    /// Moves on by one frame: 1.5 m and 10 degrees per second at 60 frames per second, and twice as fast in
    /// every fourth second.
    pub(super) fn go_on(&mut self, frame: u32) {
        let angle = (frame as f32 / 6.0).to_radians() + 0.4 * (frame as f32 * 0.05).sin();
        self.forward = Vec3::new(angle.sin(), -0.12, -angle.cos()).normalize();
        let speed = if frame / 60 % 4 == 3 { 3.0 } else { 1.5 };
        self.eye += (self.forward.with_y(0.0).normalize() * speed / 60.0).as_dvec3();
    }

    pub(super) fn camera(&self) -> PerspectiveCamera {
        PerspectiveCamera {
            eye: self.eye,
            forward: self.forward,
            up: Vec3::Y,
            fov_y: 0.9,
            aspect: 16.0 / 9.0,
            near: 0.1,
            far: 150.0,
        }
    }
}

/// Results of drawing one set of maps.
#[derive(Debug, Default)]
pub(super) struct Drawn {
    pub(super) passes: usize,
    pub(super) cleared: usize,
    pub(super) texels: u64,
}

/// Content of one set of maps.
#[derive(Debug)]
pub(super) struct Stored {
    /// Depths of each map, as the look-up reads them.
    pub(super) depths: Vec<Vec<f32>>,
    pub(super) maps: Vec<FittedMap>,
}

impl Stored {
    /// Returns whether a point of the ground is lit, by one look-up in the finest map that contains it with a
    /// border.
    fn is_lit(&self, point: DVec3) -> bool {
        let holds =
            |(_, map): &(usize, &FittedMap)| map.projection.texels_to_edge(point).is_some_and(|free| free > 4.0);
        let texel = |map: &FittedMap| map.projection.texel_size.x;
        let maps = self.maps.iter().enumerate().filter(holds);
        let Some((index, map)) = maps.min_by(|a, b| texel(a.1).total_cmp(&texel(b.1))) else { return true };
        let uvz = map.projection.uv_from_world.transform_point3((point - map.projection.origin).as_vec3());
        let at = (uvz.truncate() * map.projection.resolution.as_vec2()).as_uvec2();
        // The ground is the lowest surface. A texel more than half a metre above it belongs to a block.
        uvz.z - 0.5 / map.projection.depth_range
            < self.depths[index][(at.y * map.projection.resolution.x + at.x) as usize]
    }
}

impl Walk {
    /// Returns points of the ground in view.
    pub(super) fn ground(&self) -> impl Iterator<Item = DVec3> {
        let forward = self.forward.with_y(0.0).normalize().as_dvec3();
        let right = forward.cross(DVec3::Y);
        let eye = self.eye.with_y(PLACE.y);
        let at = move |far: u32, across: u32| {
            let far = 4.0 + f64::from(far) * 0.7;
            eye + forward * far + right * (far * (f64::from(across) / 60.0 - 0.5) * 0.9)
        };
        (0..60).flat_map(move |far| (0..60).map(move |across| at(far, across)))
    }
}

/// Returns the share of points in view whose verdict differs between the two sets.
pub(super) fn lit_otherwise([a, b]: &[Stored; 2], walk: &Walk) -> f64 {
    let [count, differ] = walk
        .ground()
        .fold([0, 0], |[count, differ], point| [count + 1, differ + u32::from(a.is_lit(point) != b.is_lit(point))]);
    f64::from(differ) / f64::from(count)
}

/// Two sets of the same maps.
pub(super) struct Pair {
    pub(super) engine: Engine,
    pub(super) kept: SunShadows,
    pub(super) anew: SunShadows,
    pipeline: wgpu::RenderPipeline,
}

impl Pair {
    pub(super) fn new(technique: &Technique) -> Self {
        let engine = Engine::shared();
        let maps = || SunShadows::new(&engine.device, &engine.queue, &(*technique).into()).expect("maps");
        let (kept, anew) = (maps(), maps());
        let pipeline = CasterShader::new(kept.map(), Shape::Boxes).pipeline(&engine);
        Self { engine, kept, anew, pipeline }
    }

    /// Draws a frame with both sets.
    pub(super) fn draw(&mut self, town: &Town, walk: &Walk) -> [Drawn; 2] {
        let views = [walk.camera().frustum().expect("a camera")];
        // Boxes are relative to the moving eye, as in engines, so that their rounding differs in each frame.
        let boxes = town.boxes(walk.eye);
        let boxes = Boxes { origin: walk.eye, boxes: &boxes };
        let keys = town.keys();
        let casters = shadowfit_wgpu::Casters { boxes, moves: &town.moves, keys: &keys };
        let frame = SunFrame::new(&views, walk.direction, boxes, casters);
        let input = FitInput { receivers: Some(boxes), casters: Some(boxes), ..FitInput::new(&views, walk.direction) };
        let maps = *self.kept.fit(&input).expect("maps");
        let corners = |block: &Block| {
            let (centre, half) = ((block.centre - walk.eye).as_vec3(), block.half * block.fill);
            [centre - half, centre + half]
        };
        let corners: Vec<[Vec3; 2]> = town.blocks.iter().map(corners).collect();
        let casters = Casters::boxes(&self.engine, &corners);
        let Self { engine, kept, anew, pipeline } = self;
        [kept, anew].map(|target| {
            target.prepare(&engine.queue, &frame, &maps).expect("a good frame");
            let mut encoder = engine.encoder();
            casters.draw_sun(&mut encoder, pipeline, target);
            engine.submit(encoder);
            Drawn {
                passes: target.passes().len(),
                cleared: target.passes().filter(ShadowPass::is_cleared).count(),
                texels: target
                    .passes()
                    .filter(|pass| pass.content() != PassKind::Moving)
                    .flat_map(|pass| pass.regions().map(|region| u64::from(region.scissor[2] * region.scissor[3])))
                    .sum(),
            }
        })
    }

    /// Returns the content of both sets after the last frame.
    pub(super) fn stored(&self) -> [Stored; 2] {
        [&self.kept, &self.anew].map(|sun| Stored { depths: self.engine.unwrapped(sun), maps: sun.maps().to_vec() })
    }

    /// Asserts that every map that is read is complete, including maps that wait.
    pub(super) fn assert_proven(&self, town: &Town, walk: &Walk) {
        let views = [walk.camera().frustum().expect("a camera")];
        let boxes = town.boxes(walk.eye);
        let boxes = Boxes { origin: walk.eye, boxes: &boxes };
        let casters = shadowfit_wgpu::Casters { moves: &town.moves, ..shadowfit_wgpu::Casters::fixed(boxes) };
        let frame = SunFrame::new(&views, walk.direction, boxes, casters);
        let proof = self.kept.prove(&frame).expect("a good frame");
        assert!(proof.is_proven(), "{proof:?}");
    }
}
