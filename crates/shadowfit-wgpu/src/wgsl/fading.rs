//! WGSL of the look-up that fades from one set of maps to another. It contains the functions that read a set
//! twice.

/// Functions that depend on the set of maps.
const OF_SET: [&str; 6] = ["project", "free", "select", "entry", "read", "turned"];

/// Converts a look-up into one set of maps to a look-up into two sets.
pub(super) fn two_sets(look_up: &str) -> String {
    let before = OF_SET.iter().map(|name| function(look_up, name)).collect::<String>();
    let before = OF_SET.iter().fold(before.replace("shadowfit_receiver", "shadowfit_fading.before"), |text, name| {
        text.replace(&format!("shadowfit_{name}("), &format!("shadowfit_{name}_before("))
    });
    let now = look_up
        .replace("shadowfit_receiver: shadowfit_Receiver;", "shadowfit_fading: shadowfit_Fading;")
        .replace("fn shadowfit_turned(", "fn shadowfit_turned_now(")
        .replace("fn shadowfit_map_index(", "fn shadowfit_map_index_now(");
    [&of_now(&now), include_str!("fading.wgsl"), "\n", &before].concat()
}

/// Converts the WGSL for debug views of one set of maps to WGSL for the present set of two.
pub(super) fn stored(stored: &str) -> String {
    let now = stored.replace("fn shadowfit_stored(", "fn shadowfit_stored_now(");
    [&of_now(&now), include_str!("fading_stored.wgsl")].concat()
}

/// Makes a text read the present maps.
fn of_now(text: &str) -> String {
    text.replace("shadowfit_receiver", "shadowfit_fading.now")
}

/// Returns a function of a text, up to its closing brace.
fn function<'a>(text: &'a str, name: &str) -> &'a str {
    let begin = text.find(&format!("fn shadowfit_{name}(")).unwrap_or(text.len());
    let length = text[begin..].find("\n}\n").map_or(0, |end| end + 3);
    &text[begin..begin + length]
}
