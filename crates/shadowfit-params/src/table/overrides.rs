//! The rows of the overrides for single maps.

use glam::UVec2;

use super::always_there;
use super::map::SIDES;
use crate::tool::Settings;
use crate::{Choice, ChoiceOption, Group, Kind, Optional, Parameter};
use shadowfit::settings::{FitKind, MAX_MAPS};

/// The fits that a single map may have, in the order of their options: windows are the maps of a whole technique.
const KINDS: [FitKind; 5] =
    [FitKind::Focused, FitKind::Oriented, FitKind::Sphere, FitKind::FrustumAabb, FitKind::XnaSample];

/// The three rows of a map.
const fn rows<const MAP: usize>(ids: [&'static str; 3], labels: [&'static str; 3]) -> [Parameter; 3] {
    [kind::<MAP>(ids[0], labels[0]), width::<MAP>(ids[1], labels[1]), height::<MAP>(ids[2], labels[2])]
}

const fn kind<const MAP: usize>(id: &'static str, label: &'static str) -> Parameter {
    Parameter {
        id,
        group: Group::Override,
        label,
        unit: "",
        help: "The rule that decides where this map looks. The last map, which is the coarsest, may be calmer as a sphere.",
        kind: Kind::Choice(Choice {
            options: &[
                ChoiceOption { id: "same", label: "as the others", help: "The rule of all maps." },
                ChoiceOption { id: "focused", label: "Focused on the scene", help: "As under Fit." },
                ChoiceOption { id: "oriented", label: "Oriented rectangle", help: "As under Fit." },
                ChoiceOption { id: "sphere", label: "Stable sphere", help: "As under Fit." },
                ChoiceOption { id: "frustum_aabb", label: "Frustum box", help: "As under Fit." },
                ChoiceOption { id: "xna_sample", label: "XNA sample", help: "As under Fit." },
            ],
            read: |s| {
                let own = s.technique.overrides[MAP].kind;
                KINDS.iter().position(|kind| Some(*kind) == own).map_or(0, |index| index + 1)
            },
            write: |s, index| {
                s.technique.overrides[MAP].kind = index.checked_sub(1).and_then(|index| KINDS.get(index)).copied();
            },
        }),
        inert: |s| match s.technique.fit.kind {
            FitKind::Windows => Some("All maps are windows; choose another fit."),
            _ => no_such_map::<MAP>(s),
        },
    }
}

const fn width<const MAP: usize>(id: &'static str, label: &'static str) -> Parameter {
    Parameter {
        id,
        group: Group::Override,
        label,
        unit: "texels",
        help: "Width of this map, and its height where it is square. All maps are stored in layers of the same size, \
               so it must not exceed the resolution of the others.",
        kind: Kind::Optional(Optional {
            min: SIDES.0,
            max: SIDES.1,
            step: 256.0,
            logarithmic: true,
            decimals: 0,
            unset: Some(ChoiceOption { id: "same", label: "as the others", help: "The resolution of all maps." }),
            initial: 1024.0,
            present: always_there,
            read: |s| s.technique.overrides[MAP].resolution.map(|own| f64::from(own.x)),
            write: |s, value| {
                let own = &mut s.technique.overrides[MAP].resolution;
                *own = value.map(|value| {
                    let square = UVec2::splat(value as u32);
                    own.map_or(square, |own| if own.x == own.y { square } else { own.with_x(square.x) })
                });
            },
        }),
        inert: no_such_map::<MAP>,
    }
}

const fn height<const MAP: usize>(id: &'static str, label: &'static str) -> Parameter {
    Parameter {
        id,
        group: Group::Override,
        label,
        unit: "texels",
        help: "Height of this map, if it is not square.",
        kind: Kind::Optional(Optional {
            min: SIDES.0,
            max: SIDES.1,
            step: 256.0,
            logarithmic: true,
            decimals: 0,
            unset: Some(ChoiceOption { id: "square", label: "as the width", help: "This map is square." }),
            initial: 512.0,
            present: |s| s.technique.overrides[MAP].resolution.is_some(),
            read: |s| {
                let own = s.technique.overrides[MAP].resolution;
                own.filter(|own| own.x != own.y).map(|own| f64::from(own.y))
            },
            write: |s, value| {
                if let Some(own) = &mut s.technique.overrides[MAP].resolution {
                    own.y = value.map_or(own.x, |value| value as u32);
                }
            },
        }),
        inert: |s| match s.technique.overrides[MAP].resolution {
            Some(_) => no_such_map::<MAP>(s),
            None => Some(NO_RESOLUTION[MAP]),
        },
    }
}

fn no_such_map<const MAP: usize>(s: &Settings) -> Option<&'static str> {
    (MAP >= s.technique.count as usize).then_some("There is no such map; raise the number of maps.")
}

/// Why a map has no height of its own.
macro_rules! no_resolution {
    ($($number:literal),+) => {
        [$(concat!(
            "This map has no resolution of its own; set that first (override.map_",
            $number,
            "_resolution)."
        )),+]
    };
}

const NO_RESOLUTION: [&str; MAX_MAPS] = no_resolution!("1", "2", "3", "4", "5", "6", "7", "8");

/// Ids and labels of a map's rows.
macro_rules! own {
    ($map:literal, $number:literal) => {
        rows::<$map>(
            [
                concat!("override.map_", $number, "_kind"),
                concat!("override.map_", $number, "_resolution"),
                concat!("override.map_", $number, "_height"),
            ],
            [
                concat!("Map ", $number, ": fit"),
                concat!("Map ", $number, ": resolution"),
                concat!("Map ", $number, ": height"),
            ],
        )
    };
}

pub(super) const MAPS: [[Parameter; 3]; MAX_MAPS] =
    [own!(0, "1"), own!(1, "2"), own!(2, "3"), own!(3, "4"), own!(4, "5"), own!(5, "6"), own!(6, "7"), own!(7, "8")];
