//! A town of blocks, some of which bob up and down, and the coarse boxes for fitting the maps.

use glam::Vec3;
use shadowfit::Aabb;

/// Number of blocks along a side of the town.
const SIDE: u32 = 60;

/// Distance between neighbouring blocks, in metres.
const APART: f32 = 3.0;

/// Number of blocks along a side of a cell. The blocks of a cell share a coarse box.
const CELL: u32 = 6;

/// Amplitude of the bobbing, in metres up and down.
const BOB: f32 = 0.5;

/// A caster as the shaders read it: `Caster` in WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub(crate) struct Block {
    /// Relative to the origin of positions in the shaders, in metres.
    pub(crate) centre: [f32; 3],
    /// 1 if the caster moves, else 0.
    pub(crate) moves: u32,
    /// Half of its size along each axis, in metres. A negative size removes the caster.
    pub(crate) half_size: [f32; 3],
    /// Keeps the struct a multiple of 16 bytes.
    pub(crate) padding: u32,
}

impl Block {
    pub(crate) fn aabb(&self) -> Aabb {
        let [centre, half] = [self.centre, self.half_size].map(Vec3::from);
        Aabb::new(centre - half, centre + half)
    }
}

/// The casters, and two coarse boxes per cell: one around its static casters and one around its moving
/// casters.
#[derive(Debug)]
pub(crate) struct Town {
    pub(crate) blocks: Vec<Block>,
    heights: Vec<f32>,
    pub(crate) cells: Vec<Aabb>,
    pub(crate) cells_move: Vec<bool>,
}

impl Town {
    /// Creates thousands of blocks on a ground. Every `moving`-th block bobs, or none if `moving` is 0.
    pub(crate) fn new(moving: u32) -> Self {
        let mut blocks = vec![Block { centre: [0.0, -0.5, 0.0], moves: 0, half_size: [100.0, 0.5, 100.0], padding: 0 }];
        for i in 0..SIDE * SIDE {
            let place = |along: u32| (along as f32 + 0.5 - SIDE as f32 * 0.5) * APART;
            let half = [0.3 + (i % 7) as f32 * 0.1, 0.4 + (i % 11) as f32 * 0.3, 0.3 + (i % 5) as f32 * 0.15];
            let moves = moving > 0 && i % moving == 0;
            let centre = [place(i % SIDE), half[1], place(i / SIDE)];
            blocks.push(Block { centre, moves: moves.into(), half_size: half, padding: 0 });
        }
        let heights = blocks.iter().map(|block| block.centre[1]).collect();
        let mut town = Self { blocks, heights, cells: Vec::new(), cells_move: Vec::new() };
        town.make_cells();
        town
    }

    /// Makes the coarse boxes. They contain the blocks at every height of their bobbing.
    fn make_cells(&mut self) {
        let across = SIDE / CELL;
        let cells = (across * across) as usize;
        self.cells = vec![Aabb::EMPTY; 2 * cells];
        self.cells_move = (0..2 * cells).map(|cell| cell >= cells).collect();
        for (i, block) in (0..).zip(&self.blocks[1..]) {
            let cell = (i / SIDE / CELL * across + i % SIDE / CELL) as usize;
            let Aabb { mut min, mut max } = block.aabb();
            if block.moves == 1 {
                (min.y, max.y) = (min.y - BOB, max.y + BOB);
            }
            let coarse = &mut self.cells[cell + cells * block.moves as usize];
            *coarse = Aabb::new(coarse.min.min(min), coarse.max.max(max));
        }
        self.cells.push(self.blocks[0].aabb());
        self.cells_move.push(false);
    }

    /// Moves the bobbing blocks, with a period of one second at 60 frames per second.
    pub(crate) fn bob(&mut self, frame: u32) {
        for (number, (block, height)) in self.blocks.iter_mut().zip(&self.heights).enumerate() {
            if block.moves == 1 {
                let phase = frame as f32 / 60.0 + number as f32 * 0.37;
                block.centre[1] = height + BOB * (phase * core::f32::consts::TAU).sin();
            }
        }
    }
}
