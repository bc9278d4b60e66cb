//! Filters as lists of the texels that they read, simulated from their definitions.

use shadowfit::bias::FilterRadius;
use shadowfit::glam::DVec2;
use shadowfit::settings::{FilterKind, Softness};

/// The texels of one look-up of a filter.
#[derive(Clone, Copy)]
pub(crate) enum LookUp {
    /// The nearest texel.
    Nearest,
    /// The four nearest texels, without texels of zero weight.
    Bilinear,
}

impl LookUp {
    /// Returns the centres of the texels with a weight at a position, in texels.
    pub(crate) fn texels(self, at: DVec2) -> impl Iterator<Item = DVec2> {
        let first = match self {
            Self::Nearest => at.floor(),
            Self::Bilinear => (at - 0.5).floor(),
        };
        let weight = at - 0.5 - first;
        let corners = [DVec2::ZERO, DVec2::X, DVec2::Y, DVec2::ONE];
        corners
            .into_iter()
            .filter(move |c| match self {
                Self::Nearest => *c == DVec2::ZERO,
                Self::Bilinear => (c.x == 0.0 || weight.x > 0.0) && (c.y == 0.0 || weight.y > 0.0),
            })
            .map(move |c| first + c + 0.5)
    }
}

/// A filter: the offsets of its look-ups from the sampled point, in texels, and its reach.
pub(crate) struct Filter {
    pub(crate) name: &'static str,
    pub(crate) reach: FilterRadius,
    pub(crate) look_up: LookUp,
    pub(crate) offsets: Vec<DVec2>,
}

impl Filter {
    /// Returns the centres of all texels that it reads around a position, in texels.
    pub(crate) fn texels(&self, at: DVec2) -> impl Iterator<Item = DVec2> {
        self.offsets.iter().flat_map(move |offset| self.look_up.texels(at + *offset))
    }

    fn kernel(name: &'static str, taps: u32) -> Self {
        let side = || (0..taps).map(|i| f64::from(i) - f64::from(taps - 1) * 0.5);
        let offsets = side().flat_map(|x| side().map(move |y| DVec2::new(x, y))).collect();
        Self { name, reach: FilterRadius::kernel(taps), look_up: LookUp::Bilinear, offsets }
    }

    /// Returns look-ups spread evenly over a disc (H. Vogel, 1979), in all rotations that occur from pixel to
    /// pixel.
    fn vogel(name: &'static str, count: u8, radius: f32, turns: u8) -> Self {
        let turn = |turn: u8| {
            (0..count).map(move |i| {
                let angle = f64::from(i) * 2.399_963 + f64::from(turn) / f64::from(turns) * core::f64::consts::TAU;
                DVec2::from_angle(angle) * ((f64::from(i) + 0.5) / f64::from(count)).sqrt() * f64::from(radius)
            })
        };
        let offsets = (0..turns).flat_map(turn).collect();
        Self { name, reach: FilterRadius::HARDWARE_2X2.over_disc(radius), look_up: LookUp::Bilinear, offsets }
    }

    /// Returns a kind of filter with the widest disc that a softness allows.
    pub(crate) fn of_kind(kind: FilterKind, softness: &Softness) -> Self {
        let one = |look_up| Self { name: "one", reach: kind.into(), look_up, offsets: vec![DVec2::ZERO] };
        let vogel = |count| Self::vogel("Vogel", count, softness.ceiling, 32);
        match kind {
            FilterKind::Point => one(LookUp::Nearest),
            FilterKind::Hardware2x2 => one(LookUp::Bilinear),
            FilterKind::Pcf3x3 => Self::kernel("3x3", 3),
            FilterKind::Pcf5x5 => Self::kernel("5x5", 5),
            FilterKind::Pcf7x7 => Self::kernel("7x7", 7),
            FilterKind::Vogel8 => vogel(8),
            FilterKind::Vogel16 | FilterKind::Pcss => vogel(16),
            FilterKind::Vogel32 => vogel(32),
        }
    }

    /// Returns a disc: 32 look-ups on its rim and 32 inside.
    fn disc(name: &'static str, reach: FilterRadius, look_up: LookUp) -> Self {
        let radii = reach.disc.as_dvec2();
        let offsets = (0..64)
            .map(|i| {
                DVec2::from_angle(f64::from(i) * 2.399_963)
                    * if i % 2 == 0 { 1.0 } else { (f64::from(i) / 64.0).sqrt() }
            })
            .map(|offset| offset * radii)
            .collect();
        Self { name, reach, look_up, offsets }
    }
}

/// Returns every kind of filter, with reaches from half a texel to four.
pub(crate) fn filters() -> Vec<Filter> {
    let one = |name, reach, look_up| Filter { name, reach, look_up, offsets: vec![DVec2::ZERO] };
    let ellipse = FilterRadius { disc: shadowfit::glam::Vec2::new(3.5, 1.2), ..FilterRadius::POINT };
    vec![
        one("point", FilterRadius::POINT, LookUp::Nearest),
        one("2x2", FilterRadius::HARDWARE_2X2, LookUp::Bilinear),
        Filter::kernel("3x3", 3),
        Filter::kernel("5x5", 5),
        Filter::kernel("7x7", 7),
        Filter::disc("disc of nearest texels", FilterRadius::POINT.over_disc(2.5), LookUp::Nearest),
        Filter::disc("disc of 2x2", FilterRadius::HARDWARE_2X2.over_disc(2.5), LookUp::Bilinear),
        Filter::vogel("Vogel disc", 16, 2.5, 8),
        Filter::disc("ellipse of nearest texels", ellipse, LookUp::Nearest),
    ]
}
