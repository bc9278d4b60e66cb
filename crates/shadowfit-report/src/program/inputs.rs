//! The options of a command line for what fits are given.

use shadowfit_params::tool::Settings;
use shadowfit_params::{BoxSource, Inputs, ParameterError, set_from_str};

/// What fits are given, where it is not what the technique's name says.
#[derive(Clone, Debug, clap::Args)]
pub(crate) struct InputArgs {
    /// Which boxes of the scene fits are given: clusters (of triangles) or objects [default: clusters]
    #[arg(long, value_name = "clusters|objects", value_parser = boxes)]
    boxes: Option<BoxSource>,
    /// Do not tell fits what the frame before showed
    #[arg(long)]
    unseen: bool,
}

impl InputArgs {
    /// The inputs of a technique with what is asked for changed.
    pub(crate) fn changed(&self, inputs: Inputs) -> Inputs {
        Inputs { boxes: self.boxes.unwrap_or(inputs.boxes), visible_demand: inputs.visible_demand && !self.unseen }
    }
}

fn boxes(text: &str) -> Result<BoxSource, ParameterError> {
    let mut settings = Settings::default();
    set_from_str(&mut settings, "input.boxes", text)?;
    Ok(settings.inputs.boxes)
}
