//! Sums over the frames on which a fit is measured; sums of frames can be merged.

use shadowfit_truth::Histogram;

/// Sums of points and maps, from which the columns of a table follow.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tally {
    /// Number of frames.
    pub frames: u64,
    /// Number of maps in all frames.
    pub maps: u64,
    /// Visible points that face the light.
    pub facing: u64,
    /// Those of them that no map covers.
    pub uncovered: u64,
    /// Points that a map covers and that have an occluder.
    pub shadowed: u64,
    /// Those of them whose occluders the renderer loses.
    pub lost: u64,
    /// Those of them whose occluders are not in the map's volume.
    pub lost_unclamped: u64,
    /// Pixels per texel along the worse axis, of covered points that are not grazing.
    pub pixels_per_texel: Histogram,
    /// Points in `pixels_per_texel` with more than one pixel per texel.
    pub undersampled: u64,
    /// Pixels per texel times the side, in texels, of a square map of as many texels: the side at which
    /// the point would have one pixel per texel.
    pub critical: Histogram,
    /// Sum over maps of the share of their area, 0..=1, that visible points need.
    pub used: f64,
    /// Crawl between frames.
    pub shimmer: Shimmer,
    /// Texels that are read again.
    pub kept: Kept,
    /// Sum over covered points of the metres along the light that depth 0..=1 spans.
    pub depth_range: f64,
}

/// How maps move between frames of a path.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Shimmer {
    /// Points that were compared with the frame before.
    pub points: u64,
    /// Sum of how far each moved in its map beyond whole texels, in texels.
    pub moved: f64,
    /// Points that moved by less than 0.02 texels and whose texels' size changed by less than 0.01%.
    pub still: u64,
    /// Sum of the relative changes of a texel's side.
    pub scaled: f64,
}

/// How many points read the same texels as in the frame before. Unlike [`Shimmer::still`] it counts points that
/// go from one map to another.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Kept {
    /// Points that were in the view of the frame before, and read some map then.
    pub points: u64,
    /// Those of them that read the map with the same index, moved by whole texels, with texels of the same
    /// size.
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

    /// Points that a map covers.
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
