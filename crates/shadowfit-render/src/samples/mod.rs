//! The classic techniques as samples: they compute in the display's own values, as their sources did.

mod occlusion;
mod sky_box;

pub use occlusion::formula as occlusion_formula;
pub use occlusion::{
    OcclusionFrame, OcclusionLight, OcclusionMethod, OcclusionPasses, OcclusionSettings, OcclusionUniform,
    OcclusionView,
};
pub use sky_box::{SkyBox, SkyBoxUniform, SkyPicture, direction_of, face_of};
