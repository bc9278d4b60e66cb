//! The formulas of shadow tests and shadings in WGSL against their Rust versions, on a table of cases. Each
//! function is cut out of its WGSL file.

use glam::{Mat4, Vec2, Vec3, Vec4};
use shadowfit::bias::acos_bias;
use shadowfit::spot::SpotBias;
use shadowfit_classics::headlight::real_shadow;
use shadowfit_classics::mapped::point::image_uv;
use shadowfit_classics::{comparison, lamp, terrain, xna};
use shadowfit_testing::renderer_gpu;

use crate::formulas_gpu::compute;

/// Number of cases: a multiple of a workgroup's size.
const CASES: u32 = 256;

/// Allowed difference. A result takes a few f32 operations on numbers of up to 3, and an arc cosine, whose
/// error WGSL bounds by 4096 units in the last place, below a tenth.
const TOLERANCE: f32 = 1e-4;

/// Input of a case: four rows of four numbers.
type Case = [[f32; 4]; 4];
/// Results of a case.
type Answer = [[f32; 4]; 6];

const ASK: &str = "
struct Case {
    base: vec4<f32>,
    numbers: vec4<f32>,
    more: vec4<f32>,
    clip: vec4<f32>,
}

@group(0) @binding(0) var<storage, read> cases: array<Case>;
@group(0) @binding(1) var<storage, read_write> answers: array<array<vec4<f32>, 6>>;

@compute @workgroup_size(64)
fn ask(@builtin(global_invocation_id) id: vec3<u32>) {
    let c = cases[id.x];
    let base = c.base.xyz;
    let uv = (c.clip.xyz / c.clip.w).xy * vec2<f32>(0.5, -0.5) + 0.5;
    let inside = select(0.0, 1.0, comparison_is_inside(uv, c.numbers.y));
    let matrix = mat4x4<f32>(c.base, c.numbers, c.more, c.clip);
    let to_light = c.clip.xyz + vec3<f32>(0.0, 0.0, 4.0);
    let gradient = lamp_gradient(matrix, c.numbers.zz, to_light, normalize(c.more.xwz - 0.5));
    answers[id.x] = array<vec4<f32>, 6>(
        vec4<f32>(xna_colour(base, c.more.x, c.more.y, c.more.z), xna_share(c.numbers.x, c.numbers.y, c.numbers.z)),
        vec4<f32>(headlight_colour(base, c.more.x, c.more.y, c.more.z, c.more.w),
            real_shadow_share(c.base.w, c.numbers.x, c.numbers.y, c.numbers.z)),
        vec4<f32>(comparison_colour(base, c.more.x, c.more.w, c.more.y, c.more.z),
            comparison_epsilon(c.numbers.z, c.more.x)),
        vec4<f32>(terrain_colour(base, c.more.x, c.more.y, c.more.z, c.more.w),
            terrain_share(c.numbers.x, c.numbers.y, c.numbers.z, c.numbers.w)),
        vec4<f32>(uv, inside, 0.0),
        vec4<f32>(gradient, lamp_compared_depth(c.numbers.x, 1.0 + c.base.x, c.numbers * 0.01, gradient), 0.0));
}
";

/// Functions and constants under test, by the WGSL file that contains them.
const PARTS: [(&str, &[&str]); 9] = [
    (include_str!("../../src/xna/test.wgsl"), &["fn xna_share("]),
    (include_str!("../../src/xna/shade.wgsl"), &["fn xna_colour("]),
    (include_str!("../../src/headlight/real_shadow/test.wgsl"), &["fn real_shadow_share("]),
    (include_str!("../../src/headlight/real_shadow/shade.wgsl"), &["fn headlight_colour("]),
    (
        include_str!("../../src/comparison/test.wgsl"),
        &["const LEAST_ANGLE", "const MOST_EPSILON", "fn comparison_epsilon(", "fn comparison_is_inside("],
    ),
    (include_str!("../../src/comparison/shade.wgsl"), &["const DIFFUSE", "const SPECULAR", "fn comparison_colour("]),
    (include_str!("../../src/terrain/test.wgsl"), &["fn terrain_share("]),
    (include_str!("../../src/terrain/shade.wgsl"), &["const IN_SHADOW", "fn terrain_colour("]),
    (include_str!("../../src/lamp/test.wgsl"), &["const MIN_COSINE", "fn lamp_gradient(", "fn lamp_compared_depth("]),
];

/// Returns a whole function or constant of a file.
fn cut(text: &str, start: &str) -> String {
    let from = text.find(start).unwrap_or_else(|| panic!("no {start} in {text}"));
    let end = if start.starts_with("const") { ";\n" } else { "\n}\n" };
    let length = text[from..].find(end).unwrap_or_else(|| panic!("{start} does not end")) + end.len();
    text[from..from + length].to_owned()
}

/// Returns numbers in 0..1 that fill the cube evenly.
fn evenly(index: u32, axis: i32) -> f32 {
    ((0.5 + (f64::from(index) + 1.0) * 1.105_250_7_f64.powi(-axis)).fract()) as f32
}

fn case(index: u32) -> Case {
    let number = |axis| evenly(index, axis);
    let around = |axis: i32, middle: f32, by: f32| middle + (evenly(index, axis) - 0.5) * by;
    let inside = if index.is_multiple_of(3) { 0.0 } else { 1.0 };
    let share = [0.0, 0.5, 1.0][(index % 3) as usize];
    [
        [number(1), number(2), number(3), inside],
        // Stored and compared depths close to each other, a bias, and the number from which the terrain
        // subtracts depth.
        [around(4, 0.5, 0.02), around(5, 0.5, 0.02), number(6) * 0.01, around(7, 0.98, 0.04)],
        [around(8, 0.0, 2.0), share, number(9), around(10, 0.0, 2.0)],
        [around(11, 0.0, 6.0), around(12, 0.0, 6.0), number(13), 0.5 + number(14) * 2.0],
    ]
}

fn twin([base, numbers, more, clip]: &Case) -> Answer {
    let color = Vec3::new(base[0], base[1], base[2]);
    let [stored, depth, bias, whole] = *numbers;
    let [n_l, share, third, fourth] = *more;
    let row = |color: Vec3, number: f32| color.extend(number).to_array();
    let uv = image_uv(Vec4::from(*clip));
    let inside = f32::from(u8::from(comparison::test::is_inside(uv, depth)));
    let epsilon = acos_bias(bias, n_l).expect("finite numbers");
    let matrix = Mat4::from_cols_array_2d(&[*base, *numbers, *more, *clip]);
    let to_light = Vec3::new(clip[0], clip[1], clip[2] + 4.0);
    let normal = (Vec3::new(n_l, fourth, third) - 0.5).normalize();
    let gradient = lamp::test::gradient(matrix, Vec2::splat(bias), to_light, normal);
    let [constant_depth, distance_depth, constant_offset, receiver_plane] = numbers.map(|number| number * 0.01);
    let lamp_bias = SpotBias { constant_depth, distance_depth, constant_offset, receiver_plane, ..SpotBias::default() };
    let compared = lamp::test::compared_depth(stored, 1.0 + base[0], &lamp_bias, gradient);
    [
        row(xna::shade::colour(color, n_l, share, third), xna::test::share(stored, depth, bias)),
        row(
            real_shadow::shade::colour(color, n_l, share, third, fourth),
            real_shadow::test::share(base[3], stored, depth, bias),
        ),
        row(comparison::shade::colour(color, n_l, fourth, share, third), epsilon),
        row(terrain::shade::colour(color, n_l, share, third, fourth), terrain::test::share(stored, depth, bias, whole)),
        [uv.x, uv.y, inside, 0.0],
        [gradient.x, gradient.y, compared, 0.0],
    ]
}

#[test]
fn tests_and_shadings_are_the_same_in_wgsl_and_rust() {
    let parts = PARTS.iter().flat_map(|(piece, starts)| starts.iter().map(|start| cut(piece, start)));
    let source = parts.collect::<Vec<_>>().join("\n") + ASK;
    let cases: Vec<Case> = (0..CASES).map(case).collect();
    let answers: Vec<Answer> = compute(&renderer_gpu(), &source, &cases);
    let mut shadowed = [0; 3];
    for (case, answer) in cases.iter().zip(&answers) {
        let expected = twin(case);
        let uv = Vec2::new(expected[4][0], expected[4][1]);
        // Rounding may move a depth or a point across its limit.
        let [stored, depth, bias, whole] = case[1];
        let is_close = (stored - depth + bias).abs() < 1e-6
            || (stored - bias - whole + depth).abs() < 1e-6
            || uv.min(1.0 - uv).abs().min_element() < 1e-5;
        for (found, expected) in answer.iter().flatten().zip(expected.iter().flatten()) {
            assert!(is_close || (found - expected).abs() <= TOLERANCE, "{case:?}: {answer:?}, not {expected:?}");
        }
        for (count, row) in shadowed.iter_mut().zip([0, 1, 3]) {
            *count += u32::from(expected[row][3] == 0.0);
        }
    }
    assert!(shadowed.iter().all(|count| (20..CASES - 20).contains(count)), "both sides are met: {shadowed:?}");
}
