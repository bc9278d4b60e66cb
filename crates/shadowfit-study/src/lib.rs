//! Comparison of techniques on the same frames, without a window. Each technique is fitted, drawn by the
//! viewer's renderer, and judged against rays.
//!
//! A [`PreparedScene`] is a scene that can be drawn, traced and fitted to. A [`View`] is a camera and a
//! light. A [`Technique`](shadowfit::Technique) holds all settings of the shadows. The public
//! [`ShadowFitter`](shadowfit::ShadowFitter) fits the maps of a view ([`PosedScene::fit_next`]). An
//! [`Evaluator`] draws them and judges the picture. A [`Comparison`] does this for several techniques, and
//! [`tune()`] searches for the best one. The viewer draws and judges through the same evaluator.

mod agreement;
mod background;
mod background_judge;
mod boxes;
mod check;
mod comparison;
mod evaluator;
mod file_camera;
mod fits;
mod frame;
mod judging;
mod live;
mod maps;
mod output;
mod picture;
mod posed_rays;
mod rays;
mod scene;
mod settings_file;
mod technique_file;
mod tune;
mod view;
#[cfg(not(target_family = "wasm"))]
mod whole_file;
mod why;

pub use agreement::Agreement;
pub use background::{in_background, in_background_async, next_turn};
pub use background_judge::{BackgroundJudge, JudgeResult};
pub use check::{check_device, check_device_async, unchecked};
pub use comparison::{Comparison, Outcome, ensure_judged};
pub use evaluator::Evaluator;
pub use file_camera::{camera_reaches, file_camera, near_of};
pub use fits::{RayUse, see_by_rays};
pub use frame::atmosphere;
pub use judging::{Judging, PicturePair, SharedTruth};
pub use live::LiveTruth;
pub use output::{print, tell};
pub use picture::{FrameBefore, JudgeJob};
pub use rays::SceneRays;
pub use scene::{PosedScene, PrepareError, PreparedScene};
pub use settings_file::{settings_from_toml, settings_to_toml, technique_to_toml};
pub use technique_file::NamedTechnique;
pub use tune::{Budget, Progress, Step, TuneScope, TuneSettings, Tuned, Weights, tune, tune_async};
pub use view::View;
#[cfg(not(target_family = "wasm"))]
pub use whole_file::{check_place, make_folder, write_whole};
pub use why::{StoredTexels, Why, WhyInput, why};
