//! Two techniques side by side. The second one has its own maps, renderer and judge, and shares everything
//! else with the first.

use shadowfit::Technique;
use shadowfit_params::figures::JudgedFigures;
use shadowfit_params::tool::Settings;
use shadowfit_render::{Gpu, RenderTarget};
use shadowfit_study::PreparedScene;

use super::Stage;
use super::shot::Shot;
use super::side::Side;

/// Presets for the second technique. The first one that differs from the current technique is used.
const COMPARED: [&str; 2] = ["stable-4", "windows-4"];
/// Least share of the picture for either side.
const LEAST: f32 = 0.02;

/// The second technique.
#[derive(Debug)]
pub(super) struct Other {
    pub(super) technique: Technique,
    side: Side,
}

impl Other {
    pub(super) fn problem(&self) -> Option<&str> {
        self.side.problem.as_deref()
    }

    pub(super) fn read_picture(&mut self, gpu: &Gpu, target: &RenderTarget) {
        self.side.read_picture(gpu, target);
    }

    pub(super) fn cut(&mut self, is_frozen: bool) {
        self.side.cut(is_frozen);
    }
}

impl Stage {
    /// Returns whether two techniques are compared.
    pub fn is_comparing(&self) -> bool {
        self.other.is_some()
    }

    /// Returns the second technique of a comparison.
    pub fn other_technique(&self) -> Option<Technique> {
        self.other.as_ref().map(|other| other.technique)
    }

    /// Compares the technique of the settings with another one, or stops comparing.
    pub fn compare_with(&mut self, technique: Option<Technique>) {
        let Some(technique) = technique else {
            self.other = None;
            return;
        };
        if let Some(other) = &mut self.other {
            other.technique = technique;
            return;
        }
        match Side::new(&self.gpu, &technique, self.samples) {
            Ok(mut side) => {
                side.live.waits = self.side.live.waits;
                if self.reads_depths {
                    side.follow();
                }
                self.other = Some(Other { technique, side });
            }
            Err(error) => self.side.problem = Some(error.to_string()),
        }
    }

    /// Swaps both techniques.
    pub fn swap_sides(&mut self) {
        if let Some(other) = &mut self.other {
            std::mem::swap(&mut self.settings.technique, &mut other.technique);
            std::mem::swap(&mut self.side, &mut other.side);
        }
    }

    /// Moves the bar between both pictures.
    pub fn set_split(&mut self, share: f32) {
        if share.is_finite() {
            self.split = share.clamp(LEAST, 1.0 - LEAST);
        }
    }

    /// Returns the settings, and the second technique of a comparison, for editing.
    pub fn settings_and_other(&mut self) -> (&mut Settings, Option<&mut Technique>) {
        (&mut self.settings, self.other.as_mut().map(|other| &mut other.technique))
    }

    /// Draws the second technique's picture into a target, from the bar on.
    pub(super) fn draw_other(&mut self, target: &RenderTarget) {
        let scissor = right_part(self.split, target.size);
        let Some(mut other) = self.other.take() else { return };
        let settings = Settings { technique: other.technique, ..self.settings };
        let (_, shot) = self.shot(target.size);
        other.side.draw(&mut Shot { settings: &settings, scissor: Some(scissor), ..shot }, target);
        self.other = Some(other);
    }

    /// Returns a side and its technique.
    pub(super) fn side_at(&self, in_other: bool) -> Option<(&Side, Technique)> {
        if !in_other {
            return Some((&self.side, self.settings.technique));
        }
        self.other.as_ref().map(|other| (&other.side, other.technique))
    }

    /// Calls a function with a side.
    pub(super) fn with_side<T>(
        &mut self,
        in_other: bool,
        work: impl FnOnce(&mut Side, &Gpu, &mut PreparedScene) -> T,
    ) -> Option<T> {
        let Self { side, other, gpu, scene, .. } = self;
        let side = if in_other { &mut other.as_mut()?.side } else { side };
        Some(work(side, gpu, scene))
    }

    /// Returns the figures of the second technique's picture.
    pub(super) fn other_figures(&self) -> Option<JudgedFigures> {
        self.other.as_ref().and_then(|other| other.side.live.figures(self.clock))
    }

    /// Returns whether both current pictures have been judged.
    pub fn is_judged(&self) -> bool {
        self.side.live.is_up_to_date() && self.other.as_ref().is_none_or(|other| other.side.live.is_up_to_date())
    }

    /// Returns names of both techniques: of their presets, if they are presets.
    pub fn side_names(&self) -> [String; 2] {
        let other = self.other.as_ref().map_or(self.settings.technique, |other| other.technique);
        [self.settings.technique, other].map(|technique| {
            let is_same = |preset: &&shadowfit::Preset| {
                let [width, height] = technique.fit.resolution.to_array();
                preset.technique().with_lengths_of(&technique).with_resolution(width, height) == technique
            };
            let preset = shadowfit::PRESETS.iter().find(is_same);
            preset.map_or_else(|| format!("{} maps", technique.maps.count()), |preset| preset.name.to_owned())
        })
    }
}

/// Returns the column of the bar, in pixels.
fn column(split: f32, width: u32) -> u32 {
    ((split * width as f32).round() as u32).clamp(1, width.saturating_sub(1).max(1))
}

/// Returns the part of a picture left of the bar: x, y, width and height in pixels.
pub(super) fn left_part(split: f32, [width, height]: [u32; 2]) -> [u32; 4] {
    [0, 0, column(split, width), height]
}

/// Returns the part right of the bar, and a column of pixels under it.
pub(super) fn right_part(split: f32, [width, height]: [u32; 2]) -> [u32; 4] {
    let from = column(split, width).saturating_sub(1);
    [from, 0, width - from, height]
}

/// Returns the first technique to compare `now` with: a preset with the shadow distance, caster extension and
/// resolution of `now`.
pub(crate) fn compared_with(now: &Technique) -> Technique {
    let [width, height] = now.fit.resolution.to_array();
    let presets = COMPARED.iter().filter_map(|name| Technique::preset(name));
    let mut suited = presets.map(|preset| preset.with_lengths_of(now).with_resolution(width, height));
    suited.find(|technique| technique != now).unwrap_or(*now)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_parts_cover_the_picture_wherever_the_bar_stands() {
        for width in [1, 2, 37, 1280] {
            for split in [0.0, 0.02, 0.5, 0.98, 1.0] {
                let ([_, _, left, _], [from, _, right, _]) =
                    (left_part(split, [width, 9]), right_part(split, [width, 9]));
                assert!(left >= 1 && right >= 1 && from <= left && from + right == width, "{width} at {split}");
            }
        }
    }
}
