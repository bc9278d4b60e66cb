//! Sums over the frames of a measured fit. Sums of frames can be merged.

use shadowfit_truth::Histogram;

/// Sums over points and maps. The columns of a table are computed from them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tally {
    /// Number of frames.
    pub frames: u64,
    /// Number of maps in all frames.
    pub maps: u64,
    /// Visible points that face the light.
    pub facing: u64,
    /// Facing points that no map covers.
    pub uncovered: u64,
    /// Points that a map covers and that have an occluder.
    pub shadowed: u64,
    /// Shadowed points whose occluders the renderer loses.
    pub lost: u64,
    /// Shadowed points whose occluders are outside the map's volume.
    pub lost_unclamped: u64,
    /// Pixels per texel along the worse axis, of covered points that are not grazing.
    pub pixels_per_texel: Histogram,
    /// Points in `pixels_per_texel` with more than one pixel per texel.
    pub undersampled: u64,
    /// Pixels per texel times the side of a square map with the same number of texels: the side, in texels,
    /// at which the point would have one pixel per texel.
    pub critical: Histogram,
    /// Sum over maps of the share of their area, 0..=1, that visible points need.
    pub used: f64,
    /// Crawl between frames.
    pub shimmer: Shimmer,
    /// Points that read the same texels as in the previous frame.
    pub kept: Kept,
    /// Sum over covered points of the depth range 0..=1 of their map, in metres along the light.
    pub depth_range: f64,
}

/// Movement of maps between the frames of a path.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Shimmer {
    /// Points that were compared with the previous frame.
    pub points: u64,
    /// Sum of the points' movements in their maps, without whole texels, in texels.
    pub moved: f64,
    /// Points that moved by less than 0.02 texels and whose texel size changed by less than 0.01%.
    pub still: u64,
    /// Sum of the relative changes of a texel's side.
    pub scaled: f64,
}

/// Number of points that read the same texels as in the previous frame. Unlike [`Shimmer::still`], it counts
/// points that change from one map to another as compared, but not as kept.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Kept {
    /// Points that were in the previous frame's view and read a map there.
    pub points: u64,
    /// Points that read the map with the same index in both frames, where it moved by whole texels and kept
    /// its texel size.
    pub kept: u64,
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
        self.pixels_per_texel.merge(&other.pixels_per_texel);
        self.undersampled += other.undersampled;
        self.critical.merge(&other.critical);
        self.used += other.used;
        self.shimmer.merge(other.shimmer);
        self.kept.points += other.kept.points;
        self.kept.kept += other.kept.kept;
        self.depth_range += other.depth_range;
    }

    /// Returns the number of points that a map covers.
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
