//! A town of blocks, some of which bob up and down, and the coarse boxes that the maps are fitted to.

use glam::Vec3;
use shadowfit::Aabb;

/// Blocks along a side of the town.
const SIDE: u32 = 60;

/// Metres from block to block.
const APART: f32 = 3.0;

/// Blocks along a side of a cell, whose blocks share a coarse box.
const CELL: u32 = 6;

/// Metres by which blocks bob, up and down.
const BOB: f32 = 0.5;

/// A caster as the shaders read it: `Caster` in WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub(crate) struct Block {
    /// Relative to the origin of positions in the shaders, in metres.
    pub(crate) centre: [f32; 3],
    /// 1 for one that moves.
    pub(crate) moves: u32,
    /// Half its size along each axis, in metres; a negative one is not there.
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

/// The casters, and a coarse box around those of each cell: those that stand still, and those that move.
#[derive(Debug)]
pub(crate) struct Town {
    pub(crate) blocks: Vec<Block>,
    heights: Vec<f32>,
    pub(crate) cells: Vec<Aabb>,
    pub(crate) cells_move: Vec<bool>,
}

impl Town {
    /// Thousands of blocks on a ground. Every `moving`-th bobs; with 0 none does.
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

    /// The boxes hold blocks wherever they bob.
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

    /// Moves what moves, once up and down in a second of 60 frames.
    pub(crate) fn bob(&mut self, frame: u32) {
        for (number, (block, height)) in self.blocks.iter_mut().zip(&self.heights).enumerate() {
            if block.moves == 1 {
                let phase = frame as f32 / 60.0 + number as f32 * 0.37;
                block.centre[1] = height + BOB * (phase * core::f32::consts::TAU).sin();
            }
        }
    }
}
