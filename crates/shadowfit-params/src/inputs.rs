//! What tools hand to a fit besides the views and the light. An engine hands in what it has; a tool says which of it.

use std::fmt;

use shadowfit::Technique;

/// Which of a scene's boxes a fit is given, and whether it is told what the last frame showed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Inputs {
    /// Which boxes of the receivers. Default: [`BoxSource::Clusters`].
    pub boxes: BoxSource,
    /// Whether fits are told what the last frame showed. Default: yes.
    pub visible_demand: bool,
}

impl Default for Inputs {
    fn default() -> Self {
        Self { boxes: BoxSource::Clusters, visible_demand: true }
    }
}

impl Inputs {
    /// Whether fits of a technique are told what the last frame showed, and go by it.
    pub const fn tell(self, technique: &Technique) -> bool {
        self.visible_demand && technique.maps.uses_visible_demand()
    }
}

impl fmt::Display for Inputs {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self.boxes {
            BoxSource::Objects => "given the objects' boxes",
            BoxSource::Clusters => "given the triangle clusters' boxes",
        })?;
        f.write_str(if self.visible_demand { " and what the frame before showed" } else { " alone" })
    }
}

/// Which boxes of the scene's receivers a fit is given.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum BoxSource {
    /// The boxes of its objects.
    Objects,
    /// The boxes of clusters of its triangles, with cones of their normals
    /// ([`Clusters`](shadowfit::Clusters)). The default.
    #[default]
    Clusters,
}

/// A name that stands for a preset with an input that is not the default one.
#[derive(Clone, Copy, Debug)]
pub struct NamedInputs {
    /// Stable name, for files, command lines and figures.
    pub name: &'static str,
    /// The preset that it means.
    pub preset: &'static str,
    /// What the preset is given.
    pub inputs: Inputs,
}

/// The names that stand for a preset with an input.
pub const NAMED_INPUTS: [NamedInputs; 4] = [
    NamedInputs {
        name: "clusters-1",
        preset: "focused-1",
        inputs: Inputs { boxes: BoxSource::Clusters, visible_demand: true },
    },
    NamedInputs {
        name: "clusters-4",
        preset: "focused-4",
        inputs: Inputs { boxes: BoxSource::Clusters, visible_demand: false },
    },
    NamedInputs {
        name: "histogram-4",
        preset: "focused-4",
        inputs: Inputs { boxes: BoxSource::Clusters, visible_demand: true },
    },
    NamedInputs {
        name: "windows-boxes-4",
        preset: "windows-4",
        inputs: Inputs { boxes: BoxSource::Clusters, visible_demand: false },
    },
];

impl NamedInputs {
    /// The names of this preset and input, of [`NAMED_INPUTS`].
    pub fn find(name: &str) -> Option<&'static Self> {
        NAMED_INPUTS.iter().find(|named| named.name == name)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_name_stands_for_a_preset_and_is_not_one_itself() {
        for named in &NAMED_INPUTS {
            assert!(Technique::preset(named.preset).is_some(), "{}", named.name);
            assert!(Technique::preset(named.name).is_none(), "{}", named.name);
        }
    }
}
