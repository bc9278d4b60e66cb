//! Where a map is stored in its layer: a map that wraps around is drawn part by part.
//!
//! ```text
//!   the map        its layer, wrap = (w, h)
//!   ┌───────┬───┐      ┌───┬───────┐
//!   │ A     │ B │      │ D │ C     │ h
//!   │       │   │      ├───┼───────┤
//!   ├───────┼───┤      │ B │ A     │
//!   │ C     │ D │      │   │       │
//!   └───────┴───┘      └───┴───────┘
//!                        w
//! ```

use shadowfit::glam::UVec2;

/// A part of a map that lies in one piece in its layer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StoredPart {
    /// Left and top of the whole map, as it would lie for this part to be in its place, in texels of the layer.
    pub origin: [i32; 2],
    /// Width and height of the whole map, in texels.
    pub size: [u32; 2],
    /// Left, top, width and height of the part, in texels of the layer.
    pub rectangle: [u32; 4],
}

impl StoredPart {
    /// The parts of a map of `size` texels whose texel t is stored at (t + wrap) mod size: one to four.
    pub fn all(size: UVec2, wrap: UVec2) -> impl Iterator<Item = Self> {
        // Per axis: where the map begins, and the first and last texel of the layer that are seen of it there.
        let pieces = |size: u32, wrap: u32| {
            let begin = wrap.cast_signed();
            [(begin, wrap, size), (begin - size.cast_signed(), 0, wrap)]
        };
        let (across, down) = (pieces(size.x, wrap.x), pieces(size.y, wrap.y));
        let pairs = (0..4).map(move |index| (across[index % 2], down[index / 2]));
        pairs.filter(|(x, y)| x.1 < x.2 && y.1 < y.2).map(move |(x, y)| Self {
            origin: [x.0, y.0],
            size: size.to_array(),
            rectangle: [x.1, y.1, x.2 - x.1, y.2 - y.1],
        })
    }

    /// Sets viewport and scissors of a pass, so that what is drawn goes into this part.
    pub fn set(&self, pass: &mut wgpu::RenderPass<'_>) {
        let ([left, top], [width, height]) = (self.origin, self.size);
        pass.set_viewport(left as f32, top as f32, width as f32, height as f32, 0.0, 1.0);
        let [left, top, width, height] = self.rectangle;
        pass.set_scissor_rect(left, top, width, height);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_texel_of_a_layer_belongs_to_one_part_that_holds_the_texel_stored_there() {
        for wrap in [[0, 0], [3, 0], [0, 5], [3, 5], [7, 9]].map(UVec2::from_array) {
            let size = UVec2::new(8, 10);
            let parts: Vec<StoredPart> = StoredPart::all(size, wrap).collect();
            assert_eq!(parts.len(), (1 + usize::from(wrap.x > 0)) * (1 + usize::from(wrap.y > 0)), "{wrap}");
            for y in 0..size.y {
                for x in 0..size.x {
                    let stored = (UVec2::new(x, y) + wrap) % size;
                    let holds = |part: &&StoredPart| {
                        let [left, top, width, height] = part.rectangle;
                        (left..left + width).contains(&stored.x) && (top..top + height).contains(&stored.y)
                    };
                    let holding: Vec<&StoredPart> = parts.iter().filter(holds).collect();
                    assert_eq!(holding.len(), 1, "{wrap}: {x}, {y}");
                    let origin = holding[0].origin;
                    let at = [x, y].map(u32::cast_signed);
                    assert_eq!([origin[0] + at[0], origin[1] + at[1]], stored.to_array().map(u32::cast_signed));
                }
            }
        }
    }
}
