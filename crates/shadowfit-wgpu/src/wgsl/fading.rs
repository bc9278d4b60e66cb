//! The look-up that goes over from one set of maps to another: the same text, of which a part stands twice.

/// Functions that read what a set of maps has for itself.
const OF_SET: [&str; 6] = ["project", "free", "select", "entry", "read", "turned"];

/// The look-up into two sets of maps, from that into one.
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

/// Views of the present maps, from those of the only ones.
pub(super) fn stored(stored: &str) -> String {
    let now = stored.replace("fn shadowfit_stored(", "fn shadowfit_stored_now(");
    [&of_now(&now), include_str!("fading_stored.wgsl")].concat()
}

/// A text that reads the present maps.
fn of_now(text: &str) -> String {
    text.replace("shadowfit_receiver", "shadowfit_fading.now")
}

/// A function of a text, up to the brace that closes it.
fn function<'a>(text: &'a str, name: &str) -> &'a str {
    let begin = text.find(&format!("fn shadowfit_{name}(")).unwrap_or(text.len());
    let length = text[begin..].find("\n}\n").map_or(0, |end| end + 3);
    &text[begin..begin + length]
}
