//! What is summed up while fits are measured; sums of frames can be merged.

use super::quantiles::Histogram;

/// Sums of points and maps, from which the columns of a table follow.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tally {
    /// Frames.
    pub frames: u64,
    /// Maps of all frames.
    pub maps: u64,
    /// Visible points that face the light.
    pub facing: u64,
    /// Those of them that no map holds.
    pub uncovered: u64,
    /// Points that a map holds and that have an occluder.
    pub shadowed: u64,
    /// Those of them whose occluders the renderer loses.
    pub lost: u64,
    /// Those of them whose occluders are not in the map's volume.
    pub lost_unclamped: u64,
    /// Pixels per texel along the worse axis.
    pub error: Histogram,
    /// Points in `error` with more than one pixel per texel.
    pub under: u64,
    /// Pixels per texel times the map's side in texels.
    pub critical: Histogram,
    /// Sum over maps of the share of their area that is needed.
    pub used: f64,
    /// Crawl between frames.
    pub shimmer: Shimmer,
    /// Sum over covered points of the metres along the light that depth 0..=1 spans.
    pub depth_range: f64,
}

/// How maps move between frames of a path.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Shimmer {
    /// Points looked at.
    pub points: u64,
    /// Sum of their moves within a texel, in texels.
    pub moved: f64,
    /// Points that stand still and keep their texels' size.
    pub still: u64,
    /// Sum of relative changes of a texel's size.
    pub scaled: f64,
}

impl Tally {
    /// Adds the sums of `other`.
    pub fn merge(&mut self, other: &Self) {
        self.frames += other.frames;
        self.maps += other.maps;
        self.facing += other.facing;
        self.uncovered += other.uncovered;
        self.shadowed += other.shadowed;
        self.lost += other.lost;
        self.lost_unclamped += other.lost_unclamped;
        self.error.merge(&other.error);
        self.under += other.under;
        self.critical.merge(&other.critical);
        self.used += other.used;
        self.shimmer.merge(other.shimmer);
        self.depth_range += other.depth_range;
    }

    /// Points that a map holds.
    pub fn covered(&self) -> u64 {
        self.facing - self.uncovered
    }
}

impl Shimmer {
    fn merge(&mut self, other: Self) {
        self.points += other.points;
        self.moved += other.moved;
        self.still += other.still;
        self.scaled += other.scaled;
    }
}
