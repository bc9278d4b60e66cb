//! The nodes of one scene, parents first, walked without recursion so that deep chains are harmless.

use gltf::json::{Index, Root, Value, scene};

use crate::error::{Problem, entry};
use crate::limits::MAX_MORPH_WEIGHT;
use crate::{Node, Transform};

/// Nodes that belong to the chosen scene.
pub(crate) struct Tree {
    /// Nodes, every parent before its children. Their meshes and skins are set later.
    pub(crate) nodes: Vec<Node>,
    /// Index in the file of each node.
    pub(crate) file_index: Vec<usize>,
    /// For each node of the file, its index in `nodes`, or `None` if it is not part of the scene.
    pub(crate) scene_index: Vec<Option<usize>>,
    /// For each node of `nodes`, whether `KHR_node_visibility` of the node or of an ancestor hides it.
    pub(crate) hidden: Vec<bool>,
}

/// Collects the nodes of a scene: the given scene, else the default scene, else the first. In a file without
/// scenes, collects all nodes without a parent and their descendants. `transforms` has the transform of each
/// node of the file.
pub(crate) fn collect(root: &Root, transforms: &[Transform], scene: Option<usize>) -> Result<Tree, Problem> {
    let (element, roots) = roots(root, scene)?;
    let scene_index = vec![None; root.nodes.len()];
    let mut tree = Tree { nodes: Vec::new(), file_index: Vec::new(), scene_index, hidden: Vec::new() };
    let mut pending: Vec<_> = roots.iter().rev().map(|&index| (index, None)).collect();
    while let Some((index, parent)) = pending.pop() {
        let parent_element = || match parent {
            Some(parent) => format!("nodes[{}].children", tree.file_index[parent]),
            None => element.clone(),
        };
        let json = entry(&root.nodes, index.value(), "node", &parent_element())?;
        if tree.scene_index[index.value()].is_some() {
            let reason = format!("node {index} is reached twice: it has two parents or is its own ancestor");
            return Err(Problem::new(parent_element(), reason));
        }
        let own = tree.nodes.len();
        tree.scene_index[index.value()] = Some(own);
        tree.file_index.push(index.value());
        tree.hidden.push(!is_visible(json) || parent.is_some_and(|parent| tree.hidden[parent]));
        let rest = transforms.get(index.value()).copied().unwrap_or_default();
        tree.nodes.push(node(index.value(), json, parent, rest)?);
        let children = json.children.iter().flatten().rev();
        pending.extend(children.map(|&child| (child, Some(own))));
    }
    Ok(tree)
}

type Roots = (String, Vec<Index<scene::Node>>);

/// Returns the root nodes and the name of the element that lists them.
fn roots(root: &Root, scene: Option<usize>) -> Result<Roots, Problem> {
    let default = root.scene.map(|index| index.value());
    if let Some(index) = scene.or(default).or((!root.scenes.is_empty()).then_some(0)) {
        let element = format!("scenes[{index}]");
        return match root.scenes.get(index) {
            Some(scene) => Ok((format!("{element}.nodes"), scene.nodes.clone())),
            None => Err(Problem::new(element, format!("the file has {} scenes", root.scenes.len()))
                .hint("Choose one of the file's scenes, counted from 0")),
        };
    }
    let mut is_child = vec![false; root.nodes.len()];
    for child in root.nodes.iter().flat_map(|node| node.children.iter().flatten()) {
        if let Some(flag) = is_child.get_mut(child.value()) {
            *flag = true;
        }
    }
    let all = (0..root.nodes.len() as u32).map(Index::new);
    Ok(("nodes".to_owned(), all.filter(|index| !is_child[index.value()]).collect()))
}

/// Returns whether the node itself is visible. `KHR_node_visibility` defaults to visible.
fn is_visible(json: &scene::Node) -> bool {
    let extension = json.extensions.as_ref().and_then(|own| own.others.get("KHR_node_visibility"));
    extension.and_then(|own| own.get("visible")).and_then(Value::as_bool).unwrap_or(true)
}

fn node(index: usize, json: &scene::Node, parent: Option<usize>, rest: Transform) -> Result<Node, Problem> {
    if !rest.matrix().as_mat4().is_finite() {
        return Err(Problem::new(format!("nodes[{index}]"), "its transform is not finite"));
    }
    let weights = json.weights.clone().unwrap_or_default();
    check_weights(&weights, &format!("nodes[{index}]"))?;
    let name = json.name.clone().unwrap_or_default();
    Ok(Node { name, parent, rest, mesh: None, skin: None, morph_weights: weights })
}

/// Refuses morph weights above [`MAX_MORPH_WEIGHT`] and weights that are not finite.
pub(super) fn check_weights(weights: &[f32], element: &str) -> Result<(), Problem> {
    let wrong = weights.iter().find(|weight| !weight.is_finite() || weight.abs() > MAX_MORPH_WEIGHT);
    let Some(weight) = wrong else { return Ok(()) };
    let reason = format!("a morph weight is {weight:e}, not between -{MAX_MORPH_WEIGHT:e} and {MAX_MORPH_WEIGHT:e}");
    Err(Problem::new(format!("{element}.weights"), reason))
}
