//! Command-line options for the inputs of fits.

use shadowfit_params::tool::Settings;
use shadowfit_params::{BoxSource, Inputs, ParameterError, set_from_str};

/// Inputs of fits, where they differ from the defaults of the technique's name.
#[derive(Clone, Debug, clap::Args)]
pub(crate) struct InputArgs {
    /// Boxes of the scene that fits get: clusters (of triangles) or objects [default: clusters]
    #[arg(long, value_name = "clusters|objects", value_parser = boxes)]
    boxes: Option<BoxSource>,
    /// Fit without the visible demand of the previous frame
    #[arg(long)]
    unseen: bool,
}

impl InputArgs {
    /// Returns a technique's inputs with the requested changes.
    pub(crate) fn changed(&self, inputs: Inputs) -> Inputs {
        Inputs { boxes: self.boxes.unwrap_or(inputs.boxes), visible_demand: inputs.visible_demand && !self.unseen }
    }
}

fn boxes(text: &str) -> Result<BoxSource, ParameterError> {
    let mut settings = Settings::default();
    set_from_str(&mut settings, "input.boxes", text)?;
    Ok(settings.inputs.boxes)
}
