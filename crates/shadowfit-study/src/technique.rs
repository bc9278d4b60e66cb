//! Techniques: all that decides how a picture's shadows come out, by name or from a file.

use std::path::Path;

use anyhow::{Context, Result, ensure};
use glam::UVec2;
use serde::ser::Error as _;
use serde::{Deserialize, Serialize, Serializer};
use shadowfit::bias::reach;
use shadowfit::settings::{BiasSettings, FilterKind, MapFormat};
use shadowfit::{
    CascadeSettings, CasterPolicy, DepthConvention, FitKind, FitSettings, HoldSettings, SplitScheme, Stabilise,
};
use shadowfit_wgpu::{MAX_MAPS, RESOLUTIONS, ShadowMapDescriptor};

/// What a fit is told of the scene.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum ReceiverSource {
    /// The boxes of its objects.
    Objects,
    /// The boxes of clusters of its triangles.
    #[default]
    Clusters,
}

/// A fit with the filter and the biases that read its maps.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Technique {
    /// Name, for tables.
    #[serde(default)]
    pub name: String,
    /// What it is, in a few words.
    #[serde(default)]
    pub what: String,
    /// What the fit is told of the scene.
    #[serde(default)]
    pub receivers: ReceiverSource,
    /// The maps and how they are fitted.
    #[serde(default, serialize_with = "without_overrides")]
    pub maps: CascadeSettings,
    /// Biases of the look-up.
    #[serde(default)]
    pub bias: BiasSettings,
    /// Filter of the look-up.
    #[serde(default)]
    pub filter: FilterKind,
    /// Storage of the maps.
    #[serde(default)]
    pub format: MapFormat,
}

/// All fields but the overrides of single maps, which TOML has no way to leave out one by one.
#[derive(Serialize)]
struct PlainMaps {
    count: u32,
    overlap: f32,
    stabilise: Stabilise,
    splits: SplitScheme,
    fit: FitSettings,
    hold: HoldSettings,
}

fn without_overrides<S: Serializer>(maps: &CascadeSettings, serializer: S) -> Result<S::Ok, S::Error> {
    let CascadeSettings { fit, count, splits, overlap, stabilise, hold, overrides } = *maps;
    if overrides.iter().any(Option::is_some) {
        return Err(S::Error::custom("maps.overrides cannot be written to a file"));
    }
    PlainMaps { count, overlap, stabilise, splits, fit, hold }.serialize(serializer)
}

/// A technique by name.
struct Named {
    name: &'static str,
    what: &'static str,
    receivers: ReceiverSource,
    maps: fn() -> CascadeSettings,
}

/// Name of the technique that is best, all in all.
pub const DEFAULT_TECHNIQUE: &str = "histogram-4";

const NAMED: [Named; 10] = [
    Named {
        name: "xna-1",
        what: "one map by the XNA sample's rule",
        receivers: ReceiverSource::Objects,
        maps: || single(FitKind::XnaSample),
    },
    Named {
        name: "aabb-1",
        what: "one map, box of the frustum in the light's axes",
        receivers: ReceiverSource::Objects,
        maps: || single(FitKind::FrustumAabb),
    },
    Named {
        name: "oriented-1",
        what: "one map, least rectangle around the frustum",
        receivers: ReceiverSource::Objects,
        maps: || single(FitKind::Oriented),
    },
    Named {
        name: "focused-1",
        what: "one map, least rectangle around the objects' boxes in view",
        receivers: ReceiverSource::Objects,
        maps: || single(FitKind::Focused),
    },
    Named {
        name: "clusters-1",
        what: "one map, least rectangle around the triangle clusters' boxes in view",
        receivers: ReceiverSource::Clusters,
        maps: || single(FitKind::Focused),
    },
    Named {
        name: "stable-4",
        what: "4 maps around spheres on a fixed grid of texels, splits from the clusters' boxes and held",
        receivers: ReceiverSource::Clusters,
        maps: || {
            let settings = several(FitKind::Sphere, SplitScheme::FromBoxes, Stabilise::Snap);
            settings.with_hold(HoldSettings::default().with_waste(4.0))
        },
    },
    Named {
        name: "focused-4",
        what: "4 maps, least rectangles around the objects' boxes in view, splits from the boxes",
        receivers: ReceiverSource::Objects,
        maps: || several(FitKind::Focused, SplitScheme::FromBoxes, Stabilise::Off),
    },
    Named {
        name: "clusters-4",
        what: "4 maps, least rectangles around the triangle clusters' boxes in view, splits from the boxes",
        receivers: ReceiverSource::Clusters,
        maps: || several(FitKind::Focused, SplitScheme::FromBoxes, Stabilise::Off),
    },
    Named {
        name: "histogram-4",
        what: "as clusters-4, splits from a histogram of the visible depth of the frame before",
        receivers: ReceiverSource::Clusters,
        maps: || several(FitKind::Focused, SplitScheme::FromHistogram, Stabilise::Off),
    },
    Named {
        name: "calm-4",
        what: "as histogram-4, maps held while they serve and moved by whole texels",
        receivers: ReceiverSource::Clusters,
        maps: || several(FitKind::Focused, SplitScheme::FromHistogram, Stabilise::Hysteresis),
    },
];

fn single(kind: FitKind) -> CascadeSettings {
    CascadeSettings { count: 1, ..several(kind, SplitScheme::Logarithmic, Stabilise::Off) }
}

fn several(kind: FitKind, splits: SplitScheme, stabilise: Stabilise) -> CascadeSettings {
    let fit = FitSettings { kind, casters: CasterPolicy::List, max_distance: f32::MAX, ..FitSettings::default() };
    CascadeSettings { fit, splits, stabilise, ..CascadeSettings::default() }
}

impl Default for Technique {
    fn default() -> Self {
        Self::named(DEFAULT_TECHNIQUE).unwrap_or_else(|| Self::of(&NAMED[0]))
    }
}

impl Technique {
    /// Names of all techniques that can be asked for, and what they are.
    pub fn names() -> impl Iterator<Item = (&'static str, &'static str)> {
        NAMED.iter().map(|named| (named.name, named.what))
    }

    /// The technique of a name, with the filter and the bias that measure best.
    pub fn named(name: &str) -> Option<Self> {
        NAMED.iter().find(|named| named.name == name).map(Self::of)
    }

    fn of(named: &Named) -> Self {
        let technique = Self {
            name: named.name.to_owned(),
            what: named.what.to_owned(),
            receivers: named.receivers,
            maps: (named.maps)(),
            bias: BiasSettings::default(),
            filter: FilterKind::default(),
            format: MapFormat::default(),
        };
        let filter = FilterKind::Pcf5x5;
        technique.with_look_up(filter, BiasSettings::automatic(filter))
    }

    /// This technique with another filter and bias, and room at the maps' borders for what the filter reads there.
    #[must_use]
    pub fn with_look_up(mut self, filter: FilterKind, bias: BiasSettings) -> Self {
        (self.filter, self.bias) = (filter, bias);
        self.maps.fit.kernel_margin = reach(filter);
        self
    }

    /// This technique with maps of another width and height, in texels.
    #[must_use]
    pub fn with_resolution(mut self, texels: u32) -> Self {
        self.maps.fit.resolution = UVec2::splat(texels);
        self
    }

    /// The technique of a name, or of a TOML file where the text ends in `.toml`.
    ///
    /// # Errors
    ///
    /// When there is no such name, or the file cannot be read or makes no sense.
    pub fn find(text: &str) -> Result<Self> {
        let file = Path::new(text);
        if file.extension().is_some_and(|extension| extension == "toml") {
            return Self::read(file);
        }
        let names: Vec<&str> = Self::names().map(|(name, _)| name).collect();
        let known = names.join(", ");
        Self::named(text)
            .with_context(|| format!("there is no technique \"{text}\"; give a .toml file or one of {known}"))
    }

    /// Reads a technique from a TOML file; one without a name gets the file's.
    ///
    /// # Errors
    ///
    /// When it cannot be read or makes no sense.
    pub fn read(file: &Path) -> Result<Self> {
        let at = || file.display().to_string();
        let text = std::fs::read_to_string(file).with_context(at)?;
        let mut technique: Self = toml::from_str(&text).with_context(at)?;
        if technique.name.is_empty() {
            technique.name = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        }
        technique.check().with_context(at)?;
        Ok(technique)
    }

    /// The technique as [`Self::read`] reads it.
    ///
    /// # Errors
    ///
    /// When a number cannot be written, such as one that is not finite.
    pub fn to_toml(&self) -> Result<String> {
        Ok(toml::to_string(self)?)
    }

    /// Refuses what no renderer can draw.
    fn check(&self) -> Result<()> {
        let resolution = self.maps.fit.resolution;
        for side in resolution.to_array() {
            ensure!(
                RESOLUTIONS.contains(&side),
                "maps.fit.resolution: {side} texels; give {} to {}",
                RESOLUTIONS.start(),
                RESOLUTIONS.end()
            );
        }
        ensure!(
            (1..=MAX_MAPS as u32).contains(&self.maps.count),
            "maps.count: {}; give 1 to {MAX_MAPS}",
            self.maps.count
        );
        ensure!(
            self.maps.fit.depth != DepthConvention::NegativeOneToOne,
            "maps.fit.depth: -1 to 1 is OpenGL's; give ZeroToOne or Reversed"
        );
        let BiasSettings { constant, slope, normal_offset, receiver_plane } = self.bias;
        for (name, value) in [
            ("constant", constant),
            ("slope", slope),
            ("normal_offset", normal_offset),
            ("receiver_plane", receiver_plane),
        ] {
            ensure!(value.is_finite(), "bias.{name}: {value} is not finite");
        }
        Ok(())
    }

    /// The shadow map that this technique draws.
    pub fn descriptor(&self) -> ShadowMapDescriptor {
        ShadowMapDescriptor {
            resolution: self.maps.fit.resolution.to_array(),
            maps: self.maps.count,
            format: self.format,
            filter: self.filter,
            depth: self.maps.fit.depth,
            // The XNA sample's fit has no caster policy.
            depth_clamp: self.maps.fit.casters == CasterPolicy::DepthClamp && self.maps.fit.kind != FitKind::XnaSample,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_named_technique_is_written_and_read_back_the_same() {
        let folder = std::env::temp_dir().join(format!("shadowfit-techniques-{}", std::process::id()));
        std::fs::create_dir_all(&folder).expect("a folder");
        for (name, _) in Technique::names() {
            let technique = Technique::named(name).expect("a known name");
            let file = folder.join(format!("{name}.toml"));
            std::fs::write(&file, technique.to_toml().expect("text")).expect("written");
            assert_eq!(Technique::find(&file.to_string_lossy()).expect("read back"), technique);
        }
        std::fs::remove_dir_all(&folder).expect("removed");
    }

    #[test]
    fn files_that_make_no_sense_are_refused_by_name_and_reason() {
        let folder = std::env::temp_dir().join(format!("shadowfit-bad-techniques-{}", std::process::id()));
        std::fs::create_dir_all(&folder).expect("a folder");
        let refused = |text: &str| {
            let file = folder.join("bad.toml");
            std::fs::write(&file, text).expect("written");
            format!("{:#}", Technique::find(&file.to_string_lossy()).expect_err(text))
        };
        for (text, reason) in [
            ("maps = 3", "maps"),
            ("[maps]\ncount = 9", "maps.count: 9; give 1 to 8"),
            ("[maps]\ncount = -1", "count"),
            ("[maps.fit]\nresolution = [64, 64]", "maps.fit.resolution: 64 texels"),
            ("[bias]\nslope = nan", "bias.slope: NaN is not finite"),
            ("filter = \"Blur\"", "Blur"),
            ("colour = 1", "colour"),
            ("[maps", "bad.toml"),
        ] {
            let error = refused(text);
            assert!(error.contains(reason) && error.contains("bad.toml"), "{text}: {error}");
        }
        std::fs::remove_dir_all(&folder).expect("removed");
        assert!(format!("{:#}", Technique::find("none").expect_err("unknown")).contains("histogram-4"));
        assert!(Technique::find("/nowhere/x.toml").is_err());
    }
}
