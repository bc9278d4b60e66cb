//! Merges the changes of several viewers since their last common state, item by item.

use shadowfit_params::PARAMETERS;
use shadowfit_params::tool::Settings;

use super::Saved;

impl Saved {
    /// Merges this state into `theirs`, which other viewers wrote since the common state `known`. This
    /// viewer's changes since then override theirs.
    pub(crate) fn over(&self, known: &Self, theirs: Self) -> Self {
        let mut merged = theirs;
        if self.theme != known.theme {
            merged.theme = self.theme;
        }
        self.put_scene_over(known, &mut merged);
        // Newly opened files are at the front.
        let opened = self.recent.iter().take_while(|path| known.recent.first() != Some(path));
        let opened: Vec<_> = opened.collect();
        opened.into_iter().rev().for_each(|path| merged.remember(path));
        put_items_over(&mut merged.bookmarks, &known.bookmarks, &self.bookmarks, |a, b| {
            (a.key, &a.scene, a.scene_index) == (b.key, &b.scene, b.scene_index)
        });
        put_items_over(&mut merged.presets, &known.presets, &self.presets, |a, b| a.name == b.name);
        merged
    }

    /// Merges scene and camera, which are one item. If the scene changes, its settings replace the others.
    fn put_scene_over(&self, known: &Self, merged: &mut Self) {
        let is_other_scene = self.scene != merged.scene;
        let view = |saved: &Self| (saved.scene.clone(), saved.camera, saved.sample.clone());
        let is_moved = view(self) != view(known);
        if is_moved {
            (merged.scene, merged.camera, merged.sample) = view(self);
        }
        if is_moved && is_other_scene || merged.settings == known.settings {
            merged.settings = self.settings;
        } else {
            put_settings_over(&mut merged.settings, &known.settings, &self.settings);
        }
        if is_moved && is_other_scene || self.other != known.other {
            merged.other = self.other;
        }
    }
}

/// Merges settings in table order, so that a choice comes before the parameters that depend on it. The angles
/// of a sun that the file moves are not a user's change.
fn put_settings_over(merged: &mut Settings, known: &Settings, ours: &Settings) {
    let is_moved = |id| ours.light.file.is_some() && ["light.azimuth", "light.elevation"].contains(&id);
    for parameter in PARAMETERS {
        if !parameter.is_equal(known, ours) && !is_moved(parameter.id) {
            parameter.copy(merged, ours);
        }
    }
}

/// Adds, replaces and deletes the items that differ between `known` and `ours`.
fn put_items_over<T: Clone + PartialEq>(
    merged: &mut Vec<T>,
    known: &[T],
    ours: &[T],
    is_same: impl Fn(&T, &T) -> bool,
) {
    let find = |items: &[T], wanted: &T| items.iter().position(|item| is_same(item, wanted));
    merged.retain(|item| find(known, item).is_none() || find(ours, item).is_some());
    for item in ours {
        if find(known, item).is_some_and(|place| known[place] == *item) {
            continue;
        }
        match find(merged, item) {
            Some(place) => merged[place] = item.clone(),
            None => merged.push(item.clone()),
        }
    }
}
