//! Repairs of JSON that is valid glTF 2.0 but that the gltf crate rejects.

use gltf::json::Value;

/// Greatest whole number up to which all whole numbers are exact in f64.
const MAX_EXACT: f64 = 9_007_199_254_740_992.0;

/// Completes the JSON of a file:
///
/// - whole numbers with a fraction, such as `24.0`, become integers,
/// - scenes without nodes get an empty list of nodes,
/// - animation channels whose `KHR_animation_pointer` points at a node's transform or morph weights get that
///   node as target,
/// - other animation channels without a target node, which extensions define, are removed.
pub(super) fn complete(json: &mut Value) {
    make_whole(json);
    for scene in items(json, "scenes") {
        if let Some(scene) = scene.as_object_mut() {
            scene.entry("nodes").or_insert_with(|| Value::Array(Vec::new()));
        }
    }
    let nodes = items(json, "nodes").count();
    for animation in items(json, "animations") {
        if let Some(channels) = animation.get_mut("channels").and_then(Value::as_array_mut) {
            for channel in &mut *channels {
                if let Some((node, path)) = pointed_at(channel).filter(|(node, _)| *node < nodes) {
                    channel["target"]["node"] = node.into();
                    channel["target"]["path"] = path.into();
                }
            }
            channels.retain(|channel| channel["target"].get("node").is_some());
        }
    }
}

/// Returns the node and property that a channel points at, such as 3 and `scale` for `/nodes/3/scale`.
/// Returns `None` for any other pointer.
fn pointed_at(channel: &Value) -> Option<(usize, &'static str)> {
    let pointer = channel["target"]["extensions"]["KHR_animation_pointer"]["pointer"].as_str()?;
    let (node, property) = pointer.strip_prefix("/nodes/")?.split_once('/')?;
    let property = ["translation", "rotation", "scale", "weights"].into_iter().find(|known| *known == property)?;
    Some((node.parse().ok()?, property))
}

fn items<'a>(json: &'a mut Value, name: &str) -> impl Iterator<Item = &'a mut Value> {
    json.get_mut(name).and_then(Value::as_array_mut).into_iter().flatten()
}

/// Converts whole numbers to integers. Recursion is safe, because the parser limits the nesting depth.
fn make_whole(json: &mut Value) {
    match json {
        Value::Array(values) => values.iter_mut().for_each(make_whole),
        Value::Object(members) => members.values_mut().for_each(make_whole),
        Value::Number(number) if number.is_f64() => {
            let whole = number.as_f64().filter(|value| value.fract() == 0.0 && value.abs() <= MAX_EXACT);
            if let Some(whole) = whole {
                *json = Value::from(whole as i64);
            }
        }
        _ => {}
    }
}
