//! Maps whose casters are found by a compute shader equal maps whose casters the CPU lists, texel by texel
//! and frame after frame, while the camera walks and turns, and casters move, shrink, vanish and come back.
//! The engine belongs to the example `gpu_casters`.

#[path = "../../../../examples/gpu_casters/engine.rs"]
mod engine;
#[path = "../../../../examples/gpu_casters/town.rs"]
mod town;

use shadowfit::cache::PassKind;
use shadowfit::glam::{DVec3, Vec3};
use shadowfit::{Aabb, Boxes, PerspectiveCamera, Technique};
use shadowfit_wgpu::{Casters, Culling, SunFrame, SunShadows};

use crate::differences::Compared;
use crate::engine::Engine;
use engine::GpuCasters;
use town::Town;

/// Width of a map in texels.
const SIDE: u32 = 256;

const SUNLIGHT: Vec3 = Vec3::new(0.45, -0.8, 0.3);

/// Two sets of the same maps.
struct Pair {
    gpu: Engine,
    by_shader: SunShadows,
    by_lists: SunShadows,
    casters: GpuCasters,
}

/// Results of a run.
#[derive(Debug, Default)]
struct Found {
    /// Texels that differ.
    unequal: usize,
    /// Passes of each kind.
    all: usize,
    fixed: usize,
    moving: usize,
    /// Passes after the first frame in which a map was cleared as a whole.
    cleared: usize,
    /// Frames in which a map wrapped around in its layer.
    wrapped: usize,
    /// Casters that the compute shader found, and casters that were listed.
    by_shader: usize,
    by_lists: usize,
}

impl Pair {
    fn new(town: &Town) -> Self {
        let gpu = Engine::shared();
        gpu.require_compute();
        let technique = Technique::default().with_resolution(SIDE, SIDE).with_max_distance(60.0);
        let maps = || SunShadows::new(&gpu.device, &gpu.queue, &technique.into()).expect("maps");
        let (by_shader, by_lists) = (maps(), maps());
        let casters = GpuCasters::new(&gpu.device, &by_shader, &town.blocks);
        Self { gpu, by_shader, by_lists, casters }
    }

    /// Draws all casters that the maps can store, so that both sets have the same content however much of it
    /// is kept.
    fn whole_maps(mut self) -> Self {
        for sun in [&mut self.by_shader, &mut self.by_lists] {
            sun.set_culling(Culling::WholeMap);
        }
        self
    }

    /// Draws a frame with both sets, with maps fitted to the coarse boxes, and compares them.
    fn draw(&mut self, town: &Town, frame: u32, found: &mut Found) {
        let views = [camera(frame).frustum().expect("a camera")];
        let coarse = Boxes::world(&town.cells);
        let casters = Casters { boxes: coarse, moves: &town.cells_move, keys: &[] };
        let of_shader = SunFrame::new(&views, SUNLIGHT, coarse, casters).with_origin(DVec3::ZERO);
        self.by_shader.update(&self.gpu.queue, &of_shader).expect("a good frame");
        assert!(self.by_shader.prove(&of_shader).expect("a good frame").is_proven());
        let boxes: Vec<Aabb> = town.blocks.iter().map(town::Block::aabb).collect();
        let moves: Vec<bool> = town.blocks.iter().map(|block| block.moves == 1).collect();
        let listed = Casters { boxes: Boxes::world(&boxes), moves: &moves, keys: &[] };
        let of_lists = SunFrame { casters: listed, ..of_shader };
        self.by_lists.prepare(&self.gpu.queue, &of_lists, self.by_shader.fitted()).expect("a good frame");
        self.gpu.queue.write_buffer(&self.casters.casters, 0, bytemuck::cast_slice(&town.blocks));
        found.by_shader += self.draw_by_shader();
        found.by_lists += self.draw_by_lists();
        let [a, b] = [&self.by_shader, &self.by_lists].map(|sun| self.gpu.unwrapped(sun));
        for (map, (a, b)) in a.iter().zip(&b).enumerate() {
            // Kept parts were drawn with a matrix that is rounded differently.
            let compared = Compared::new(&self.gpu, [a, b], SIDE);
            let differ = compared.differences();
            compared.assert_explained(&differ, format_args!("frame {frame}, map {map}"));
            found.unequal += differ.len();
            assert!(frame > 0 || map > 0 || a.iter().any(|depth| *depth < 1.0), "the map is empty");
        }
        for pass in self.by_shader.passes() {
            let of_content = match pass.content() {
                PassKind::All => &mut found.all,
                PassKind::Static => &mut found.fixed,
                PassKind::Moving => &mut found.moving,
            };
            *of_content += 1;
            found.cleared += usize::from(pass.is_cleared() && frame > 0);
        }
        found.wrapped += usize::from(self.by_shader.maps().iter().any(|map| map.texel_offset.max_element() > 0));
    }

    /// Draws the casters that the compute shader finds, and returns their number.
    fn draw_by_shader(&self) -> usize {
        let mut encoder = self.gpu.encoder();
        let draws = self.casters.cull(&mut encoder, &self.by_shader);
        self.by_shader.render(&mut encoder, 0, |pass, region| {
            let draws = draws.as_ref().expect("a frame with regions");
            self.casters.draw(pass, region, draws);
        });
        let Some(draws) = draws else {
            self.gpu.submit(encoder);
            return 0;
        };
        let arguments: Vec<[u32; 5]> = self.gpu.values(encoder, &draws.arguments);
        arguments.iter().map(|[_, instances, ..]| *instances as usize).sum()
    }

    /// Draws the listed casters, and returns their number.
    fn draw_by_lists(&self) -> usize {
        let mut drawn = 0;
        let mut encoder = self.gpu.encoder();
        self.by_lists.render(&mut encoder, 0, |pass, region| {
            let numbers = self.gpu.buffer(region.casters, wgpu::BufferUsages::VERTEX);
            self.casters.bind(pass, numbers.slice(..));
            pass.draw_indexed(0..36, 0, 0..region.casters.len() as u32);
            drawn += region.casters.len();
        });
        self.gpu.submit(encoder);
        drawn
    }
}

/// Returns the camera of a walk with turns, which oscillates about its direction.
fn camera(frame: u32) -> PerspectiveCamera {
    let angle = (frame as f32 * 0.7).to_radians() + 0.5 * (frame as f32 * 0.05).sin();
    PerspectiveCamera {
        eye: DVec3::new(f64::from(frame) * 0.21 - 10.0, 1.7, 30.0 - f64::from(frame) * 0.17),
        forward: Vec3::new(angle.sin(), -0.12, -angle.cos()).normalize(),
        up: Vec3::Y,
        fov_y: 0.9,
        aspect: 1.6,
        near: 0.1,
        far: 80.0,
    }
}

#[test]
fn gpu_casters_that_a_compute_shader_finds_make_the_maps_that_lists_make() {
    let mut town = Town::new(20);
    let mut pair = Pair::new(&town).whole_maps();
    let mut found = Found::default();
    for frame in 0..60 {
        town.bob(frame);
        let number = 1 + frame as usize * 97 % (town.blocks.len() - 1);
        // A static caster shrinks, vanishes or comes back within its coarse box.
        if frame % 5 == 3 && town.blocks[number].moves == 0 {
            let block = &mut town.blocks[number];
            let before = block.aabb();
            let by = if frame % 2 == 0 { 0.5 } else { -1.0 };
            block.half_size = block.half_size.map(|half| half * by);
            for changed in [before, block.aabb()] {
                pair.by_shader.invalidate(&changed, DVec3::ZERO);
            }
        }
        pair.draw(&town, frame, &mut found);
    }
    println!("{found:?}");
    assert!(found.fixed > 30 && found.moving > 100 && found.wrapped > 30, "{found:?}");
    assert!(found.cleared < 60, "maps are kept: {found:?}");
}

#[test]
fn gpu_a_box_around_all_that_moves_and_one_around_the_rest_are_enough() {
    let mut town = Town::new(20);
    let around = |town: &Town, moves: bool| {
        let cells = town.cells.iter().zip(&town.cells_move).filter(|(_, moving)| **moving == moves);
        cells.map(|(cell, _)| *cell).reduce(|a, b| Aabb::new(a.min.min(b.min), a.max.max(b.max))).expect("cells")
    };
    (town.cells, town.cells_move) = (vec![around(&town, false), around(&town, true)], vec![false, true]);
    let mut pair = Pair::new(&town).whole_maps();
    let mut found = Found::default();
    for frame in 0..20 {
        town.bob(frame);
        pair.draw(&town, frame, &mut found);
    }
    println!("{found:?}");
    assert!(found.moving > 40 && found.by_shader > 100, "{found:?}");
}

#[test]
fn gpu_maps_that_are_drawn_anew_get_all_casters_in_one_pass() {
    let mut town = Town::new(20);
    let mut pair = Pair::new(&town);
    for sun in [&mut pair.by_shader, &mut pair.by_lists] {
        sun.set_caching(false);
    }
    for (frame, culling) in (0..).zip([Culling::Swept, Culling::Swept, Culling::WholeMap, Culling::Off]) {
        let mut found = Found::default();
        town.bob(frame);
        for sun in [&mut pair.by_shader, &mut pair.by_lists] {
            sun.set_culling(culling);
        }
        pair.draw(&town, frame, &mut found);
        assert_eq!([found.all, found.fixed, found.moving, found.unequal], [4, 0, 0, 0]);
        let all = 4 * town.blocks.len();
        let is_right = if culling == Culling::Off { found.by_shader == all } else { found.by_shader < all };
        assert!(
            is_right && found.by_shader.abs_diff(found.by_lists) * 1000 <= found.by_lists,
            "{culling:?}: {found:?}"
        );
    }
}
