//! The surface at a pixel: the arithmetic of `edges.wgsl`.

use shadowfit::glam::{Vec2, Vec3, Vec4};
use shadowfit_wgpu::exact_edges::NormalEncoding;
use shadowfit_wgpu::uniforms::MapUniform;

use super::{
    BENT, FOUR, POSITION_ROUNDING, RAY_OFFSET, ROUNDINGS, SNAP, STORED_TILT, Twin, dot, texture_place, transformed,
};

pub(super) struct Surface {
    pub(super) position: Vec3,
    pub(super) w: f32,
    pub(super) depth: f32,
    pub(super) steps: Vec2,
    /// Greatest changes of depth that the surface may have, across and down.
    pub(super) most_steps: Vec2,
    pub(super) normal: Vec3,
    pub(super) is_known: bool,
    /// Whether the texture of normals contains the normal.
    pub(super) is_stored: bool,
    pub(super) is_single: bool,
    /// Distance along the line of sight within which the surface lies, in metres.
    pub(super) off: Vec3,
    /// Sine of the normal's angular error bound.
    pub(super) tilt: f32,
}

impl Twin {
    fn far_depth(&self) -> f32 {
        self.convention.far()
    }

    fn sample(&self, [x, y]: [i32; 2], sample: usize) -> f32 {
        let count = (self.size[0] * self.size[1]) as usize;
        self.depths[sample * count + (y * self.size[0] + x) as usize] - self.far_depth()
    }

    pub(super) fn depth_at(&self, [x, y]: [i32; 2]) -> f32 {
        if x < 0 || y < 0 || x >= self.size[0] || y >= self.size[1] { 0.0 } else { self.sample([x, y], 0) }
    }

    pub(super) fn rounding(&self, depth: f32) -> f32 {
        (depth + self.far_depth()).abs() * (1.0 / 8_388_608.0) + 1.0 / 1_073_741_824.0
    }

    pub(super) fn place(&self, sample: usize) -> Vec2 {
        if self.samples == 1 { Vec2::ZERO } else { FOUR[sample] }
    }

    fn change(&self, [x, y]: [i32; 2], [right, down]: [i32; 2], depth: f32) -> (f32, f32, bool) {
        let next = self.depth_at([x + right, y + down]);
        let previous = self.depth_at([x - right, y - down]);
        let (after, before) = (next - depth, depth - previous);
        let most = (BENT * (after + before).abs() + ROUNDINGS * self.rounding(depth)) * (1.0 + self.slack);
        let is_plane = next != 0.0 && previous != 0.0 && (after - before).abs() <= most;
        let takes_after = previous == 0.0 || (next != 0.0 && after.abs() <= before.abs());
        if is_plane {
            let mean = 0.5 * (after + before);
            (mean, mean.abs(), true)
        } else if next == 0.0 && previous == 0.0 {
            (0.0, 0.0, false)
        } else {
            let [one, other] =
                [(next, after), (previous, before)].map(|(end, step)| if end == 0.0 { 0.0 } else { step });
            (if takes_after { after } else { before }, one.abs().max(other.abs()), false)
        }
    }

    fn is_single(&self, pixel: [i32; 2], depth: f32, steps: Vec2) -> bool {
        (1..self.samples).all(|sample| {
            let offset = self.place(sample) - self.place(0);
            let expected = depth + (steps.x * offset.x + steps.y * offset.y);
            let most = BENT * (steps.x.abs() + steps.y.abs()) + ROUNDINGS * self.rounding(depth);
            (self.sample(pixel, sample) - expected).abs() <= most * (1.0 + self.slack)
        })
    }

    fn stored_normal(&self, [x, y]: [i32; 2]) -> Vec3 {
        let Some((normals, encoding)) = &self.normals else { return Vec3::ZERO };
        let [a, b, c, _] = normals[(y * self.size[0] + x) as usize];
        let stored = Vec3::new(a, b, c);
        match encoding {
            _ if stored == Vec3::ZERO => Vec3::ZERO,
            NormalEncoding::Signed => unit(stored),
            NormalEncoding::Unsigned => unit(stored * 2.0 - 1.0),
        }
    }

    pub(super) fn surface_of(&self, pixel: [i32; 2], depth: f32) -> Surface {
        let m = self.world_from_pixel;
        let place = Vec2::new(pixel[0] as f32, pixel[1] as f32) + self.place(0);
        let homogeneous = transformed(&m, Vec4::new(place.x, place.y, depth, 1.0));
        let w = homogeneous.w;
        let position = homogeneous.truncate() / w;
        let moved = |change: Vec4| (change.truncate() - position * change.w) / w;
        let ray = moved(m[2]);
        let away = if dot(ray, self.forward) > 0.0 { ray } else { -ray };
        let toward_eye = |normal: Vec3| if dot(normal, away) > 0.0 { -normal } else { normal };
        let stored = self.stored_normal(pixel);
        let is_stored = dot(stored, away).abs() > STORED_TILT * away.length();
        let (normal, steps, most_steps, is_known, tilt) = if is_stored {
            let normal = toward_eye(stored);
            let [across, down] = [m[0], m[1]].map(|change| dot(stored, moved(change)));
            let steps = -Vec2::new(across, down) / dot(stored, ray);
            (normal, steps, steps.abs(), true, STORED_TILT)
        } else {
            let (across, most_across, is_flat_across) = self.change(pixel, [1, 0], depth);
            let (down, most_down, is_flat_down) = self.change(pixel, [0, 1], depth);
            let (right, below) = (moved(m[0] + m[2] * across), moved(m[1] + m[2] * down));
            let normal = unit(right.cross(below));
            let is_known = is_flat_across && is_flat_down && normal != Vec3::ZERO;
            let rise = dot(ray, normal).abs() * self.rounding(depth);
            let tilt = BENT + rise * (1.0 / right.length() + 1.0 / below.length());
            (toward_eye(normal), Vec2::new(across, down), Vec2::new(most_across, most_down), is_known, tilt)
        };
        let is_single = self.is_single(pixel, depth, steps);
        let off = ray * (ROUNDINGS * self.rounding(depth) + SNAP * (most_steps.x + most_steps.y));
        Surface { position, w, depth, steps, most_steps, normal, is_known, is_stored, is_single, off, tilt }
    }

    /// Returns the change of a position per pixel or per depth, from the change of its homogeneous position.
    pub(super) fn moved(change: Vec4, surface: &Surface) -> Vec3 {
        (change.truncate() - surface.position * change.w) / surface.w
    }

    /// Returns the distance above the surface at which rays from a point start, in metres.
    pub(super) fn height_at(&self, position: Vec3) -> f32 {
        RAY_OFFSET.max(POSITION_ROUNDING * (position.length() + self.eye.length()))
    }

    /// Returns the distances in a map to the next pixel on the plane, in texels, across and down.
    pub(super) fn texels_per_pixel(&self, map: &MapUniform, surface: &Surface) -> [Vec2; 2] {
        let m = self.world_from_pixel;
        [m[0] + m[2] * surface.steps.x, m[1] + m[2] * surface.steps.y].map(|change| {
            texture_place(map, Self::moved(change, surface).extend(0.0)).truncate() * Vec2::from(map.size)
        })
    }
}

fn unit(v: Vec3) -> Vec3 {
    let squared = dot(v, v);
    if squared > 0.0 && squared < 3e38 { v * (1.0 / squared.sqrt()) } else { Vec3::ZERO }
}
