//! Animations: keyframes of the nodes of the scene.

use glam::{Quat, Vec3};
use gltf::json::accessor::Accessor;
use gltf::json::animation::{self as json, Interpolation as JsonInterpolation, Property};
use gltf::json::validation::Checked;
use gltf::json::{Index, Root};

use super::accessor::{Integers, Reader};
use super::nodes::Tree;
use super::notes::Notes;
use crate::error::{Problem, entry};
use crate::{Animation, Channel, ChannelValues, Interpolation, Node};

/// Loads the animations of a scene.
pub(crate) struct Animations<'a> {
    pub(crate) root: &'a Root,
    pub(crate) reader: &'a Reader<'a>,
    pub(crate) tree: &'a Tree,
    /// Nodes with their mesh indices set.
    pub(crate) nodes: &'a [Node],
    /// Number of morph targets of each mesh.
    pub(crate) targets: &'a [usize],
}

impl Animations<'_> {
    /// Returns all animations that move a node of the scene.
    pub(crate) fn load(&self, notes: &mut Notes) -> Result<Vec<Animation>, Problem> {
        let mut animations = Vec::new();
        for (index, json) in self.root.animations.iter().enumerate() {
            let animation = self.animation(json, &format!("animations[{index}]"), notes)?;
            if !animation.channels.is_empty() {
                animations.push(animation);
            }
        }
        Ok(animations)
    }

    fn animation(&self, json: &json::Animation, element: &str, notes: &mut Notes) -> Result<Animation, Problem> {
        let mut channels = Vec::new();
        for (index, channel) in json.channels.iter().enumerate() {
            let element = format!("{element}.channels[{index}]");
            let Some((node, property)) = self.target(&channel.target, &element, notes)? else { continue };
            let sampler = entry(&json.samplers, channel.sampler.value(), "sampler", &format!("{element}.sampler"))?;
            channels.extend(self.channel(node, property, sampler, &element, notes)?);
        }
        let ends = channels.iter().filter_map(|channel| channel.times.last());
        let duration = ends.fold(0.0, |longest: f32, &end| longest.max(end));
        Ok(Animation { name: json.name.clone().unwrap_or_default(), duration, channels })
    }

    /// Returns the node and property that a channel moves, or `None` if it moves nothing in this scene.
    fn target(
        &self,
        json: &json::Target,
        element: &str,
        notes: &mut Notes,
    ) -> Result<Option<(usize, Property)>, Problem> {
        let node = entry(&self.tree.scene_index, json.node.value(), "node", &format!("{element}.target"))?;
        let Some(node) = *node else { return Ok(None) };
        let Checked::Valid(property) = json.path else {
            notes.add(format!("{element}: skipped: it moves a property that is not supported"));
            return Ok(None);
        };
        let moves_matrix = property != Property::MorphTargetWeights;
        if moves_matrix && self.nodes[node].rest.matrix.is_some() {
            notes.add(format!("{element}: skipped: its node is given as a matrix"));
            return Ok(None);
        }
        if property == Property::MorphTargetWeights && self.targets(node) == 0 {
            notes.add(format!("{element}: skipped: its node has no morph targets"));
            return Ok(None);
        }
        Ok(Some((node, property)))
    }

    /// Returns the number of morph targets of a node's mesh.
    fn targets(&self, node: usize) -> usize {
        self.nodes[node].mesh.map_or(0, |mesh| self.targets[mesh])
    }

    fn channel(
        &self,
        node: usize,
        property: Property,
        sampler: &json::Sampler,
        element: &str,
        notes: &mut Notes,
    ) -> Result<Option<Channel>, Problem> {
        let times = self.times(sampler.input, &format!("{element}, sampler input"))?;
        if times.is_empty() {
            notes.add(format!("{element}: skipped: it has no keys"));
            return Ok(None);
        }
        let Some(interpolation) = interpolation(sampler.interpolation) else {
            return Err(Problem::new(format!("{element}, sampler"), "its interpolation is unknown"));
        };
        let values_per_key = if interpolation == Interpolation::CubicSpline { 3 } else { 1 };
        let weights = if property == Property::MorphTargetWeights { self.targets(node) } else { 1 };
        let element = format!("{element}, sampler output");
        let (index, needed) = (sampler.output, times.len() * values_per_key * weights);
        let count = self.reader.count(index, &element)?;
        if count != needed {
            let reason = format!("it has {count} values for {} keys, which need {needed}", times.len());
            return Err(Problem::new(format!("{element}, accessor {index}"), reason));
        }
        let values = match property {
            Property::Translation => ChannelValues::Translation(self.vectors(index, &element)?),
            Property::Scale => ChannelValues::Scale(self.vectors(index, &element)?),
            Property::Rotation => ChannelValues::Rotation(self.rotations(index, &element, interpolation)?),
            Property::MorphTargetWeights => {
                let weights = self.finite::<1>(index, &element, Integers::Normalized)?;
                ChannelValues::MorphWeights(weights.into_iter().map(|[weight]| weight).collect())
            }
        };
        Ok(Some(Channel { node, times, interpolation, values }))
    }

    fn times(&self, index: Index<Accessor>, element: &str) -> Result<Vec<f32>, Problem> {
        let times = self.finite::<1>(index, element, Integers::AsDeclared)?;
        let times: Vec<f32> = times.into_iter().map(|[time]| time).collect();
        match times.windows(2).position(|pair| pair[0] > pair[1]) {
            Some(key) => {
                let reason = format!("key {} is earlier than key {key}", key + 1);
                Err(Problem::new(format!("{element}, accessor {index}"), reason))
            }
            None => Ok(times),
        }
    }

    fn vectors(&self, index: Index<Accessor>, element: &str) -> Result<Vec<Vec3>, Problem> {
        let values = self.finite(index, element, Integers::AsDeclared)?;
        Ok(values.into_iter().map(Vec3::from_array).collect())
    }

    fn rotations(&self, index: Index<Accessor>, element: &str, mode: Interpolation) -> Result<Vec<Quat>, Problem> {
        let values = self.finite(index, element, Integers::Normalized)?;
        let rotations = values.into_iter().map(Quat::from_array);
        if mode == Interpolation::CubicSpline {
            // Two of three values are tangents, whose length matters.
            return Ok(rotations.collect());
        }
        let unit = |q: Quat| if q.length() > 0.0 { q * (1.0 / q.length()) } else { Quat::IDENTITY };
        Ok(rotations.map(unit).collect())
    }

    fn finite<const N: usize>(
        &self,
        index: Index<Accessor>,
        element: &str,
        integers: Integers,
    ) -> Result<Vec<[f32; N]>, Problem> {
        let values = self.reader.floats::<N>(index, element, integers)?;
        match values.iter().position(|value| !value.iter().all(|v| v.is_finite())) {
            Some(at) => Err(Problem::new(format!("{element}, accessor {index}"), format!("value {at} is not finite"))),
            None => Ok(values),
        }
    }
}

fn interpolation(json: Checked<JsonInterpolation>) -> Option<Interpolation> {
    match json {
        Checked::Valid(JsonInterpolation::Linear) => Some(Interpolation::Linear),
        Checked::Valid(JsonInterpolation::Step) => Some(Interpolation::Step),
        Checked::Valid(JsonInterpolation::CubicSpline) => Some(Interpolation::CubicSpline),
        Checked::Invalid => None,
    }
}
