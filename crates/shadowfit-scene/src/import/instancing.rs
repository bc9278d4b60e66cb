//! `EXT_mesh_gpu_instancing`: a node draws its mesh once for each transform of a table.
//!
//! Each instance becomes a child of the node and so follows its animation. The children come after all other
//! nodes.

use std::collections::HashMap;
use std::ops::Range;

use glam::{Quat, Vec3};
use gltf::json::accessor::Accessor;
use gltf::json::scene::Node as JsonNode;
use gltf::json::{Index, Root, Value};

use super::accessor::{Integers, Reader};
use super::drawn::Drawn;
use super::nodes::Tree;
use super::notes::Notes;
use super::transforms::rotation;
use crate::error::Problem;
use crate::{Animation, Channel, ChannelValues, Mesh, Node, Scene, Transform};

/// Attributes of a table that place its instances.
const TRANSFORMS: [&str; 3] = ["TRANSLATION", "ROTATION", "SCALE"];

/// Share of the element budget of a channel, in addition to its keys.
const CHANNEL_ELEMENTS: usize = 8;

/// Returns the number of instances that a node's table declares, or 1 if it has no valid table.
pub(super) fn declared(root: &Root, json: &JsonNode) -> u64 {
    let first = table(json).and_then(Value::as_object).and_then(|table| table.values().next());
    let accessor = first.and_then(Value::as_u64).and_then(|index| root.accessors.get(usize::try_from(index).ok()?));
    accessor.map_or(1, |accessor| accessor.count.0)
}

/// Returns the attributes of a node's table.
fn table(json: &JsonNode) -> Option<&Value> {
    json.extensions.as_ref()?.others.get("EXT_mesh_gpu_instancing")?.get("attributes")
}

/// Adds the instances of all nodes with a table and a mesh. Channels that animate the morph weights of such a
/// node then animate its instances.
pub(super) fn expand(
    root: &Root,
    reader: &Reader,
    tree: &mut Tree,
    scene: &mut Scene,
    drawn: &mut Drawn,
    notes: &mut Notes,
) -> Result<(), Problem> {
    let nodes = &mut scene.nodes;
    let mut rows = HashMap::new();
    for node in 0..tree.file_index.len() {
        let index = tree.file_index[node];
        let (Some(table), Some(mesh)) = (table(&root.nodes[index]), nodes[node].mesh) else { continue };
        let element = format!("nodes[{index}].extensions.EXT_mesh_gpu_instancing.attributes");
        if nodes[node].skin.is_some() && has_joints(&scene.meshes[mesh]) {
            note_joints(&element, declared(root, &root.nodes[index]), notes);
            continue;
        }
        if table.as_object().is_some_and(|table| table.keys().any(|name| !TRANSFORMS.contains(&name.as_str()))) {
            notes.add("EXT_mesh_gpu_instancing: attributes of instances other than their transforms are ignored");
        }
        let table = Table { reader, json: table, element: &element };
        let transforms = table.read(|rows| drawn.add_rows(&scene.meshes[mesh], rows, &element))?;
        // Without transforms, all instances coincide, so the node draws its mesh once.
        let Some(transforms) = transforms else { continue };
        let mut morph_weights = nodes[node].morph_weights.clone();
        morph_weights.truncate(scene.meshes[mesh].targets());
        let first = nodes.len();
        nodes[node].mesh = None;
        // Rows have no name, so that a long name is not copied a million times. Their parent keeps it.
        let instance = Node { mesh: Some(mesh), parent: Some(node), morph_weights, ..Node::default() };
        tree.file_index.extend(transforms.iter().map(|_| index));
        nodes.extend(transforms.into_iter().map(|rest| Node { rest, ..instance.clone() }));
        rows.insert(node, (first..nodes.len(), element));
    }
    scene.animations.iter_mut().try_for_each(|animation| move_weights(reader, animation, &rows))
}

fn has_joints(mesh: &Mesh) -> bool {
    mesh.primitives.iter().any(|primitive| !primitive.joints.is_empty())
}

/// Notes an ignored table. Joints place a skinned mesh, so all instances would coincide.
fn note_joints(element: &str, rows: u64, notes: &mut Notes) {
    notes.add(format!(
        "{element}: ignored: joints place the mesh, which is drawn once instead of {rows} times, also its parts without \
         joints"
    ));
}

/// Replaces each channel that animates the morph weights of a node with a table by one channel for each row.
/// `rows` has, for each such node, the nodes of its rows and the element that a failure names.
fn move_weights(
    reader: &Reader,
    animation: &mut Animation,
    rows: &HashMap<usize, (Range<usize>, String)>,
) -> Result<(), Problem> {
    let mut channels = Vec::with_capacity(animation.channels.len());
    for channel in std::mem::take(&mut animation.channels) {
        match (&channel.values, rows.get(&channel.node)) {
            (ChannelValues::MorphWeights(values), Some((rows, element))) => {
                let each = values.len() + channel.times.len() + CHANNEL_ELEMENTS;
                reader.spend(each.saturating_mul(rows.len()), element)?;
                channels.extend(rows.clone().map(|node| Channel { node, ..channel.clone() }));
            }
            _ => channels.push(channel),
        }
    }
    animation.channels = channels;
    Ok(())
}

/// A table of transforms.
struct Table<'a> {
    reader: &'a Reader<'a>,
    json: &'a Value,
    element: &'a str,
}

impl Table<'_> {
    /// Reads its transforms after `accept` accepted their number. Returns `None` if no attribute is a
    /// transform.
    fn read(&self, accept: impl FnOnce(usize) -> Result<(), Problem>) -> Result<Option<Vec<Transform>>, Problem> {
        let [translation, rotations, scale] = TRANSFORMS.map(|name| self.find(name));
        let [translation, rotations, scale] = [translation?, rotations?, scale?];
        let given = [translation, rotations, scale].into_iter().flatten();
        let Some(count) = self.count(given)? else { return Ok(None) };
        accept(count)?;
        let translations = self.values::<3>(translation, Integers::AsDeclared)?;
        let rotations = self.values::<4>(rotations, Integers::Normalized)?;
        let scales = self.values::<3>(scale, Integers::AsDeclared)?;
        let at = |index: usize| {
            let translation = translations.as_ref().map_or(Vec3::ZERO, |all| Vec3::from_array(all[index]));
            let turn = rotations.as_ref().map_or(Quat::IDENTITY, |all| Quat::from_array(all[index]));
            let scale = scales.as_ref().map_or(Vec3::ONE, |all| Vec3::from_array(all[index]));
            Transform { rotation: rotation(turn.as_dquat()), ..Transform::new(translation, Quat::IDENTITY, scale) }
        };
        Ok(Some((0..count).map(at).collect()))
    }

    /// Returns the accessor of an attribute, with the attribute's name.
    fn find(&self, name: &'static str) -> Result<Option<Attribute>, Problem> {
        let Some(value) = self.json.get(name) else { return Ok(None) };
        let index = value.as_u64().and_then(|index| u32::try_from(index).ok());
        let wrong =
            || Problem::new(format!("{}.{name}", self.element), format!("{value} is not the index of an accessor"));
        Ok(Some(Attribute { name, index: Index::new(index.ok_or_else(wrong)?) }))
    }

    /// Returns the number of elements, which must be equal in all attributes.
    fn count(&self, attributes: impl Iterator<Item = Attribute>) -> Result<Option<usize>, Problem> {
        let mut first: Option<(usize, &str)> = None;
        for attribute in attributes {
            let element = self.name(&attribute);
            let count = self.reader.count(attribute.index, &element)?;
            match first {
                Some((other, name)) if other != count => {
                    let reason = format!("it has {count} elements, {name} has {other}");
                    return Err(Problem::new(format!("{element}, accessor {}", attribute.index), reason));
                }
                _ => first = Some((count, attribute.name)),
            }
        }
        Ok(first.map(|(count, _)| count))
    }

    fn values<const N: usize>(
        &self,
        attribute: Option<Attribute>,
        integers: Integers,
    ) -> Result<Option<Vec<[f32; N]>>, Problem> {
        let Some(attribute) = attribute else { return Ok(None) };
        let element = self.name(&attribute);
        let values = self.reader.floats::<N>(attribute.index, &element, integers)?;
        match values.iter().position(|value| !value.iter().all(|component| component.is_finite())) {
            Some(at) => {
                let element = format!("{element}, accessor {}", attribute.index);
                Err(Problem::new(element, format!("element {at} is not finite")))
            }
            None => Ok(Some(values)),
        }
    }

    fn name(&self, attribute: &Attribute) -> String {
        format!("{}.{}", self.element, attribute.name)
    }
}

/// An attribute of a table.
#[derive(Clone, Copy)]
struct Attribute {
    name: &'static str,
    index: Index<Accessor>,
}
