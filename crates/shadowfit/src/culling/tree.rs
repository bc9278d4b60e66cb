//! Culls the boxes of a tree against several volumes at once.

use super::batch::MAX_VOLUMES;
use super::shapes::Shape;
use super::volume::CasterVolume;
use crate::base::Aabb;
use crate::content::tree::StaticBoxes;

/// The volumes that a box of the hierarchy may touch, and the volumes that hold all of it, one bit each.
#[derive(Clone, Copy)]
struct Touched {
    touched: u8,
    held: u8,
}

impl StaticBoxes {
    /// Tests the boxes against up to eight volumes. Calls `visit` with the number and the mask of each box
    /// that may cast a shadow into one of the maps, in no particular order. Bit i of the mask is map i. Masks
    /// are equal to the results of [`cull`](super::cull). Volumes past the eighth are ignored.
    ///
    /// The time depends on the number of boxes in the volumes, not on the total.
    pub fn cull(&self, volumes: &[CasterVolume], mut visit: impl FnMut(u32, u8)) {
        let mut relative = [CasterVolume::everywhere(self.origin()); MAX_VOLUMES];
        let count = volumes.len().min(MAX_VOLUMES);
        relative.iter_mut().zip(volumes).for_each(|(to, volume)| *to = volume.relative_to(self.origin()));
        let all = Touched { touched: (0..count).fold(0, |bits, i| bits | 1 << i), held: 0 };
        let enter = |(): &mut (), around: Touched, aabb: &Aabb| {
            let mut of = around;
            for (i, volume) in relative[..count].iter().enumerate() {
                let bit = 1 << i;
                if around.touched & bit != 0 && around.held & bit == 0 {
                    of.touched &= if volume.intersects(aabb) { u8::MAX } else { !bit };
                    of.held |= if holds(volume, aabb) { bit } else { 0 };
                }
            }
            (of.touched != 0).then_some(of)
        };
        self.visit(all, &mut (), enter, |(), of, number, _| visit(number, of.touched));
    }
}

/// Returns whether a volume holds all of a box. Then everything in the box touches the volume, because
/// rounding is monotonic: no part of a box is farther outside than the box's own corner.
fn holds(volume: &CasterVolume, aabb: &Aabb) -> bool {
    volume.active_planes().iter().all(|plane| plane.w - aabb.support(-plane.truncate()) >= 0.0)
}
