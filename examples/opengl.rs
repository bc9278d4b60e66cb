//! Draws the courtyard's shadows with OpenGL and the shaders in `crates/shadowfit-capi/shaders`, without a window. Rays
//! then count the wrong pixels. The argument `es` chooses OpenGL ES 3.0 instead of OpenGL 4.5.
//!
//! ```sh
//! cargo run --example opengl -- core
//! ```

#![expect(unsafe_code, reason = "every call of OpenGL is unsafe")]

#[path = "opengl/context.rs"]
mod context;
#[path = "opengl/courtyard.rs"]
mod courtyard;
#[path = "opengl/demand.rs"]
mod demand;
#[path = "opengl/rays.rs"]
mod rays;

use anyhow::{Context as _, Result, bail, ensure};
use bytemuck::{Pod, cast_slice};
use glow::{HasContext, PixelPackData};
use shadowfit::culling::Reader;
use shadowfit::glam::{Mat4, Vec3};
use shadowfit::uniform::{CasterUniform, ReceiverUniform};
use shadowfit::{DepthConvention, FittedMap, Technique};

use context::{Api, Headless};
use courtyard::Courtyard;

/// Clip depth of OpenGL without `glClipControl`, for maps and picture.
const DEPTH: DepthConvention = DepthConvention::NegativeOneToOne;

/// Size of the picture, in pixels.
const SIZE: [u32; 2] = [320, 180];

// The engine's shaders, around the generated ones.
const CASTER: [&str; 2] = [
    concat!(
        include_str!("../crates/shadowfit-capi/shaders/shadowfit_caster.glsl"),
        "
        layout(location = 0) in vec3 position;
        void main() { gl_Position = shadowfit_caster_position_gl(position); }
        "
    ),
    "void main() {}",
];
const RECEIVER: [&str; 2] = [
    "
    layout(location = 0) in vec3 position;
    layout(location = 1) in vec3 normal;
    uniform mat4 clip_from_world;
    out vec3 at;
    flat out vec3 side;
    void main() {
        gl_Position = clip_from_world * vec4(position, 1.0);
        at = position;
        side = normal;
    }
    ",
    concat!(
        include_str!("../crates/shadowfit-capi/shaders/shadowfit_lookup.glsl"),
        "
        in vec3 at;
        flat in vec3 side;
        out vec4 color;
        void main() {
            // Positions are relative to the eye.
            vec3 normal = dot(side, at) < 0.0 ? side : -side;
            color = vec4(shadowfit_factor_at(at, normal, gl_FragCoord.xy));
        }
        "
    ),
];

fn main() -> Result<()> {
    let api = match std::env::args().nth(1).as_deref() {
        None | Some("core") => Api::Core,
        Some("es") => Api::Es,
        Some(other) => bail!("{other} is neither `core` nor `es`"),
    };
    let context = Headless::new(api)?;
    let courtyard = Courtyard::new(SIZE);
    let mut technique = Technique::default();
    technique.fit.depth = DEPTH;
    let maps = courtyard.fit(&technique)?;
    // SAFETY: The context is current, and all objects are made from it.
    let factors = unsafe { draw(&context.gl, api, &courtyard, &technique, &maps)? };
    let version = context.version();
    // ES 3.0 has no compute shaders.
    if api == Api::Core {
        // SAFETY: As above. The target of the picture is bound.
        let moved = unsafe { demand::count(&context.gl, &courtyard, &technique, SIZE)? };
        println!("{moved:.3} % of the visible points are counted in other cells than by the CPU");
    }
    println!("{version}: {:.3} % of the pixels that face the sun are wrong", rays::wrong(&courtyard, SIZE, &factors));
    Ok(())
}

/// Draws the maps and then the picture. Returns the share of light at each pixel, in rows from the top.
unsafe fn draw(
    gl: &glow::Context,
    api: Api,
    courtyard: &Courtyard,
    technique: &Technique,
    maps: &[FittedMap],
) -> Result<Vec<f32>> {
    unsafe {
        let eye = courtyard.camera.eye;
        let count = upload(gl, courtyard)?;
        gl.enable(glow::DEPTH_TEST);

        // The maps: a depth texture with a layer for each.
        let size = technique.fit.resolution.as_ivec2();
        let texture = map_texture(gl, [size.x, size.y, i32::try_from(maps.len())?])?;
        let program = program(gl, api, CASTER)?;
        gl.bind_framebuffer(glow::FRAMEBUFFER, Some(gl.create_framebuffer().map_err(anyhow::Error::msg)?));
        gl.draw_buffers(&[glow::NONE]);
        gl.viewport(0, 0, size.x, size.y);
        // The look-up has the bias, so glPolygonOffset is not needed.
        for (layer, map) in (0..).zip(maps) {
            gl.framebuffer_texture_layer(glow::FRAMEBUFFER, glow::DEPTH_ATTACHMENT, Some(texture), 0, layer);
            gl.clear(glow::DEPTH_BUFFER_BIT);
            constants(gl, program, "shadowfit_CasterBlock", &CasterUniform::new(&map.projection, eye))?;
            gl.draw_arrays(glow::TRIANGLES, 0, count);
        }

        // The picture. The texture of the maps is in unit 0, which samplers read by default.
        let program = self::program(gl, api, RECEIVER)?;
        let [width, height] = SIZE.map(u32::cast_signed);
        picture_target(gl, [width, height])?;
        gl.viewport(0, 0, width, height);
        gl.clear_color(1.0, 1.0, 1.0, 1.0);
        gl.clear(glow::COLOR_BUFFER_BIT | glow::DEPTH_BUFFER_BIT);
        let reader = Reader::from_eye(eye, courtyard.camera.forward);
        let receiver = ReceiverUniform::new(maps, &reader, &technique.reading()).with_fade(technique.fade_depths());
        constants(gl, program, "shadowfit_ReceiverBlock", &receiver)?;
        let clip_from_world: Mat4 = courtyard.camera.clip_from_world(DEPTH);
        let place = gl.get_uniform_location(program, "clip_from_world").context("no uniform clip_from_world")?;
        gl.uniform_matrix_4_f32_slice(Some(&place), false, &clip_from_world.to_cols_array());
        gl.draw_arrays(glow::TRIANGLES, 0, count);
        read(gl, [width, height])
    }
}

/// Uploads the triangles with their normals, relative to the eye. Returns the number of vertices.
unsafe fn upload(gl: &glow::Context, courtyard: &Courtyard) -> Result<i32> {
    let eye = courtyard.camera.eye;
    let mut vertices: Vec<[Vec3; 2]> = Vec::new();
    for [a, b, c] in courtyard.objects.iter().flatten() {
        let normal = (*b - *a).cross(*c - *a).normalize_or(Vec3::Y);
        vertices.extend([a, b, c].map(|corner| [(corner.as_dvec3() - eye).as_vec3(), normal]));
    }
    let numbers: Vec<f32> = vertices.as_flattened().iter().flat_map(Vec3::to_array).collect();
    unsafe {
        gl.bind_vertex_array(Some(gl.create_vertex_array().map_err(anyhow::Error::msg)?));
        gl.bind_buffer(glow::ARRAY_BUFFER, Some(gl.create_buffer().map_err(anyhow::Error::msg)?));
        gl.buffer_data_u8_slice(glow::ARRAY_BUFFER, cast_slice(&numbers), glow::STATIC_DRAW);
        for (location, offset) in [(0, 0), (1, 12)] {
            gl.enable_vertex_attrib_array(location);
            gl.vertex_attrib_pointer_f32(location, 3, glow::FLOAT, false, 24, offset);
        }
    }
    Ok(i32::try_from(numbers.len() / 6)?)
}

/// Creates the texture of the maps (width, height, layers), with the sampler that the look-up needs.
unsafe fn map_texture(gl: &glow::Context, [width, height, layers]: [i32; 3]) -> Result<glow::Texture> {
    let target = glow::TEXTURE_2D_ARRAY;
    unsafe {
        let texture = gl.create_texture().map_err(anyhow::Error::msg)?;
        gl.bind_texture(target, Some(texture));
        gl.tex_storage_3d(target, 1, glow::DEPTH_COMPONENT32F, width, height, layers);
        for (parameter, value) in [
            (glow::TEXTURE_COMPARE_MODE, glow::COMPARE_REF_TO_TEXTURE),
            (glow::TEXTURE_COMPARE_FUNC, glow::LEQUAL),
            (glow::TEXTURE_MIN_FILTER, glow::LINEAR),
            (glow::TEXTURE_MAG_FILTER, glow::LINEAR),
            (glow::TEXTURE_WRAP_S, glow::REPEAT),
            (glow::TEXTURE_WRAP_T, glow::REPEAT),
        ] {
            gl.tex_parameter_i32(target, parameter, value.cast_signed());
        }
        Ok(texture)
    }
}

/// Sends a constant block to a program.
unsafe fn constants(gl: &glow::Context, program: glow::Program, name: &str, value: &impl Pod) -> Result<()> {
    unsafe {
        let buffer = gl.create_buffer().map_err(anyhow::Error::msg)?;
        gl.bind_buffer_base(glow::UNIFORM_BUFFER, 0, Some(buffer));
        gl.buffer_data_u8_slice(glow::UNIFORM_BUFFER, bytemuck::bytes_of(value), glow::STREAM_DRAW);
        let block = gl.get_uniform_block_index(program, name).with_context(|| format!("no uniform block {name}"))?;
        gl.uniform_block_binding(program, block, 0);
    }
    Ok(())
}

/// Compiles a vertex and a fragment shader, and uses them.
unsafe fn program(gl: &glow::Context, api: Api, sources: [&str; 2]) -> Result<glow::Program> {
    unsafe {
        let program = gl.create_program().map_err(anyhow::Error::msg)?;
        for (stage, source) in [glow::VERTEX_SHADER, glow::FRAGMENT_SHADER].into_iter().zip(sources) {
            attach(gl, program, stage, &[api.glsl_version(), source].concat())?;
        }
        link(gl, program)?;
        Ok(program)
    }
}

/// Compiles a shader and attaches it to a program.
unsafe fn attach(gl: &glow::Context, program: glow::Program, stage: u32, source: &str) -> Result<()> {
    unsafe {
        let shader = gl.create_shader(stage).map_err(anyhow::Error::msg)?;
        gl.shader_source(shader, source);
        gl.compile_shader(shader);
        ensure!(gl.get_shader_compile_status(shader), "a shader: {}", gl.get_shader_info_log(shader));
        gl.attach_shader(program, shader);
    }
    Ok(())
}

/// Links a program and uses it.
unsafe fn link(gl: &glow::Context, program: glow::Program) -> Result<()> {
    unsafe {
        gl.link_program(program);
        ensure!(gl.get_program_link_status(program), "a program: {}", gl.get_program_info_log(program));
        gl.use_program(Some(program));
    }
    Ok(())
}

/// Creates and binds the target of the picture: a byte per channel, and a depth texture.
unsafe fn picture_target(gl: &glow::Context, [width, height]: [i32; 2]) -> Result<()> {
    unsafe {
        gl.bind_framebuffer(glow::FRAMEBUFFER, Some(gl.create_framebuffer().map_err(anyhow::Error::msg)?));
        for (attachment, format) in
            [(glow::COLOR_ATTACHMENT0, glow::RGBA8), (glow::DEPTH_ATTACHMENT, glow::DEPTH_COMPONENT32F)]
        {
            let texture = gl.create_texture().map_err(anyhow::Error::msg)?;
            gl.bind_texture(glow::TEXTURE_2D, Some(texture));
            gl.tex_storage_2d(glow::TEXTURE_2D, 1, format, width, height);
            gl.tex_parameter_i32(glow::TEXTURE_2D, glow::TEXTURE_MIN_FILTER, glow::NEAREST.cast_signed());
            gl.framebuffer_texture_2d(glow::FRAMEBUFFER, attachment, glow::TEXTURE_2D, Some(texture), 0);
        }
    }
    Ok(())
}

/// Reads the picture. OpenGL's rows begin at the bottom.
unsafe fn read(gl: &glow::Context, [width, height]: [i32; 2]) -> Result<Vec<f32>> {
    let mut pixels = vec![0_u8; width as usize * height as usize * 4];
    let error = unsafe {
        gl.read_pixels(0, 0, width, height, glow::RGBA, glow::UNSIGNED_BYTE, PixelPackData::Slice(Some(&mut pixels)));
        gl.get_error()
    };
    ensure!(error == glow::NO_ERROR, "OpenGL reports the error {error:#x}");
    let rows = pixels.chunks_exact(width as usize * 4).rev();
    Ok(rows.flat_map(|row| row.chunks_exact(4)).map(|pixel| f32::from(pixel[0]) / 255.0).collect())
}
