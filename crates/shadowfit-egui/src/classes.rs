//! The classes of judged pixels: their names, colours and shares.

use egui::Color32;
use shadowfit_params::figures::{ERROR_COLORS, JudgedFigures};

use crate::widgets::color;

/// Result of comparing a pixel with rays.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum PixelClass {
    /// Sky, surfaces that face away from the light, and surfaces beyond the shadow distance.
    NotJudged,
    /// The picture agrees with the rays.
    Right,
    /// Lit in truth and dark in the picture, away from edges: acne.
    FalseShadow,
    /// Dark in truth and lit in the picture, away from edges, though the caster is in the map.
    FalseLight,
    /// Dark in truth and lit in the picture, because the caster is not in the map.
    Hole,
    /// Wrong within the zone around true edges that the map's texels explain: aliasing.
    Edge,
}

impl PixelClass {
    /// The wrong classes, in the order of [`ERROR_COLORS`].
    pub const WRONG: [Self; 4] = [Self::FalseShadow, Self::FalseLight, Self::Hole, Self::Edge];

    /// Returns the name for people.
    pub const fn label(self) -> &'static str {
        match self {
            Self::NotJudged => "Not judged",
            Self::Right => "Right",
            Self::FalseShadow => "False shadow",
            Self::FalseLight => "False light",
            Self::Hole => "Hole",
            Self::Edge => "Edge",
        }
    }

    /// Returns the meaning, in a sentence.
    pub const fn help(self) -> &'static str {
        match self {
            Self::NotJudged => "Sky, surfaces that face away from the light, and surfaces beyond the shadow distance.",
            Self::Right => "The picture agrees with the rays.",
            Self::FalseShadow => "Lit in truth and dark in the picture, away from edges: acne.",
            Self::FalseLight => {
                "Dark in truth and lit in the picture, away from edges, though the caster is in the map: too much \
                 bias, or a leak."
            }
            Self::Hole => "Dark in truth and lit in the picture, because the caster is not in the map.",
            Self::Edge => "Wrong near a true edge, within the size of the texels: aliasing.",
        }
    }

    /// Returns the colour in pictures, as sRGB bytes; `None` for pixels that are not wrong.
    pub fn color(self) -> Option<[u8; 3]> {
        Self::WRONG.into_iter().zip(ERROR_COLORS).find_map(|(class, color)| (class == self).then_some(color))
    }
}

/// Returns the wrong classes with their colours and their shares of the judged pixels, in per cent.
pub(crate) fn shares(figures: &JudgedFigures) -> [(PixelClass, Color32, f32); 4] {
    let shares = [figures.false_shadow, figures.false_light, figures.hole, figures.edge];
    std::array::from_fn(|index| (PixelClass::WRONG[index], color(ERROR_COLORS[index]), shares[index]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wrong_classes_have_the_colours_of_pictures_and_others_have_none() {
        assert_eq!(PixelClass::Edge.color(), Some(ERROR_COLORS[3]));
        assert_eq!(PixelClass::Right.color(), None);
        let figures = JudgedFigures { hole: 2.0, ..JudgedFigures::default() };
        assert_eq!(shares(&figures)[2], (PixelClass::Hole, color(ERROR_COLORS[2]), 2.0));
    }
}
