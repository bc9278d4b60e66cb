//! Inputs that tools give a fit besides the views and the light. An engine passes the data that it has; a
//! tool chooses.

use core::fmt;

use shadowfit::Technique;

/// Choice of a scene's boxes for a fit, and whether the fit gets the visible demand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Inputs {
    /// Boxes of the receivers. Default: [`BoxSource::Clusters`].
    pub boxes: BoxSource,
    /// Whether fits get the visible demand of the last frame. Default: yes.
    pub visible_demand: bool,
}

impl Default for Inputs {
    fn default() -> Self {
        Self { boxes: BoxSource::Clusters, visible_demand: true }
    }
}

impl Inputs {
    /// Returns whether fits of a technique get the visible demand and use it.
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

/// Kind of boxes of the scene's receivers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum BoxSource {
    /// One box per object.
    Objects,
    /// Boxes of clusters of triangles, with cones of their normals ([`Clusters`](shadowfit::Clusters)). The
    /// default.
    #[default]
    Clusters,
}

/// A name for a preset with inputs that differ from the default.
#[derive(Clone, Copy, Debug)]
pub struct NamedInputs {
    /// Stable name, for files, command lines and figures.
    pub name: &'static str,
    /// Name of the preset.
    pub preset: &'static str,
    /// Inputs of the preset.
    pub inputs: Inputs,
}

/// All names for presets with inputs.
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
    /// Returns the entry of [`NAMED_INPUTS`] with this name.
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
