//! The rows of the parameter table, in display order. A row holds everything that tools know about its
//! parameter.

mod bias;
mod fit;
mod input;
mod map;
mod softness;
mod splits;
mod stabilise;
mod tool;

use crate::tool::Settings;
use crate::{MIN_FAR_PER_NEAR, Parameter, Value};
pub use tool::view_option;

/// The rows by file.
const ROWS: [&[Parameter]; 8] =
    [fit::ROWS, splits::ROWS, stabilise::ROWS, map::ROWS, softness::ROWS, bias::ROWS, input::ROWS, tool::ROWS];

/// Number of all rows.
const COUNT: usize = {
    let (mut count, mut file) = (0, 0);
    while file < ROWS.len() {
        count += ROWS[file].len();
        file += 1;
    }
    count
};

/// Every parameter of [`Settings`].
pub static PARAMETERS: &[Parameter] = &{
    let mut all = [ROWS[0][0]; COUNT];
    let (mut next, mut file) = (0, 0);
    while file < ROWS.len() {
        let mut row = 0;
        while row < ROWS[file].len() {
            all[next] = ROWS[file][row];
            (next, row) = (next + 1, row + 1);
        }
        file += 1;
    }
    all
};

const fn always_active(_: &Settings) -> Option<&'static str> {
    None
}

/// Returns the value of a number whose greatest value means unset.
fn unless_greatest(number: f32) -> Value {
    if number < f32::MAX { Value::Number(f64::from(number)) } else { Value::Unset }
}

/// Returns the number of a value; the greatest f32 if unset.
fn or_greatest(value: Value) -> f32 {
    value.number().map_or(f32::MAX, |number| number as f32)
}

/// Keeps the near plane below a distance that has just been set.
fn pull_near(settings: &mut Settings, far: f32) {
    settings.camera.near = settings.camera.near.min(far / MIN_FAR_PER_NEAR);
}
