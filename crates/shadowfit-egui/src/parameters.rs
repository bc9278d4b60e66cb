//! The controls of the settings: the most used ones, a search, and the groups.

use egui::{Align2, Margin, TextEdit, Ui, Vec2};
use shadowfit_params::tool::Settings;
use shadowfit_params::{Group, Parameter, parameter};

use crate::accessibility::rename;
use crate::icon::paint_icon;
use crate::rows;
use crate::widgets::{Icon, Section, caption, icon_button};

/// Ids of the parameters that are shown above all groups instead of in their own group.
const QUICK: [&str; 6] =
    ["fit.kind", "splits.count", "map.resolution", "fit.max_distance", "map.filter", "bias.constant"];

/// The groups of the tools, in display order.
pub(crate) const TOOL_GROUPS: [Group; 4] = [Group::Input, Group::Light, Group::Camera, Group::View];

/// Context of the rows.
pub(crate) struct Rows<'a> {
    /// Settings that resets restore.
    pub(crate) defaults: &'a Settings,
    /// Whether a parameter gets a row at all.
    pub(crate) has: &'a dyn Fn(&Parameter) -> bool,
}

impl Rows<'_> {
    /// Shows the field for the search.
    pub(crate) fn search_field(ui: &mut Ui, search: &mut String) {
        ui.horizontal(|ui| {
            let margin = Margin { left: 26, ..Margin::from(ui.spacing().button_padding) };
            let width = ui.available_width() - 30.0;
            let field =
                TextEdit::singleline(search).hint_text("Search all settings").margin(margin).align(Align2::LEFT_CENTER);
            let field = ui.add(field.desired_width(width));
            let at = field.rect.left_center() + Vec2::new(14.0, 0.0);
            paint_icon(ui, Icon::Search, at, ui.visuals().weak_text_color());
            rename(ui, &field, "Search all settings".to_owned());
            let is_empty = search.is_empty();
            if !is_empty && icon_button(ui, Icon::X, "Clear the search", "Shows all settings again.").clicked() {
                search.clear();
            }
        });
    }

    /// Shows the most used rows.
    pub(crate) fn quick(&self, ui: &mut Ui, settings: &mut Settings) {
        for parameter in QUICK.into_iter().filter_map(parameter).filter(|parameter| (self.has)(parameter)) {
            if rows::is_shown(parameter, settings) {
                let context = if parameter.group == Group::Bias { "bias" } else { "" };
                rows::show(ui, parameter, settings, self.defaults, context);
            }
        }
    }

    /// Shows a section for each group.
    pub(crate) fn groups(&self, ui: &mut Ui, groups: impl IntoIterator<Item = Group>, settings: &mut Settings) {
        for group in groups {
            let is_here = |parameter: &&Parameter| (self.has)(parameter) && !QUICK.contains(&parameter.id);
            let is_changed = |parameter: &&Parameter| !parameter.is_equal(settings, self.defaults);
            if !group.parameters().any(|parameter| is_here(&parameter)) {
                continue;
            }
            let changed = group.parameters().filter(is_here).filter(is_changed).count();
            let summary = if changed > 0 { format!("{changed} changed") } else { String::new() };
            Section { title: group.label(), help: group.help(), summary: &summary, is_open: false }.show(ui, |ui| {
                rows::show_all(ui, group.parameters().filter(is_here), settings, self.defaults);
            });
        }
    }

    /// Shows the rows of these groups that match a search. Returns their number.
    pub(crate) fn found(&self, ui: &mut Ui, search: &str, groups: &[Group], settings: &mut Settings) -> usize {
        let words = search.to_lowercase();
        let mut count = 0;
        for group in groups {
            let found = group.parameters().filter(|parameter| (self.has)(parameter) && matches(parameter, &words));
            let found: Vec<_> = found.filter(|parameter| rows::is_shown(parameter, settings)).collect();
            if !found.is_empty() {
                caption(ui, group.label()).on_hover_text(group.help());
                count += found.len();
                rows::show_all(ui, found, settings, self.defaults);
            }
        }
        count
    }
}

/// Returns the groups of the technique.
pub(crate) fn technique_groups() -> impl Iterator<Item = Group> {
    Group::ALL.into_iter().filter(|group| group.is_technique())
}

/// Returns whether every word of a search, in lower case, occurs in the name, id, group or help of a
/// parameter.
fn matches(parameter: &Parameter, words: &str) -> bool {
    let texts = [parameter.label, parameter.id, parameter.group.label(), parameter.help].map(str::to_lowercase);
    words.split_whitespace().all(|word| texts.iter().any(|text| text.contains(word)))
}

#[cfg(test)]
mod tests {
    use shadowfit_params::PARAMETERS;

    use super::*;

    #[test]
    fn the_quick_parameters_are_in_the_table_and_of_a_technique() {
        for id in QUICK {
            assert!(parameter(id).is_some_and(|parameter| parameter.group.is_technique()), "{id}");
        }
    }

    #[test]
    fn a_search_looks_at_names_ids_groups_and_help_word_by_word() {
        let found = |words: &str| -> Vec<&str> {
            PARAMETERS.iter().filter(|parameter| matches(parameter, words)).map(|parameter| parameter.id).collect()
        };
        assert!(found("slope").contains(&"bias.slope"));
        assert_eq!(found("bias.sl"), ["bias.slope"]);
        assert!(!found("texels bias").contains(&"light.azimuth"));
        assert!(found("peter-panning").contains(&"bias.slope"));
        assert_eq!(found("nonsense").len(), 0);
        assert_eq!(found("").len(), PARAMETERS.len());
    }

    #[test]
    fn every_group_is_shown_once() {
        assert!(technique_groups().chain(TOOL_GROUPS).eq(Group::ALL));
    }
}
