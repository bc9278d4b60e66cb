//! An OpenGL context without a window, made with EGL: on Mesa's surfaceless platform, or on the default display of
//! other drivers.

use std::ffi::c_void;

use anyhow::{Context as _, Result};
use khronos_egl as egl;

/// Value of `EGL_PLATFORM_SURFACELESS_MESA`, which khronos-egl does not have.
const SURFACELESS: egl::Enum = 0x31DD;

/// Version of OpenGL.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Api {
    /// OpenGL 4.5, core profile.
    Core,
    /// OpenGL ES 3.0.
    Es,
}

impl Api {
    /// Returns the first line of shaders.
    pub(crate) const fn glsl_version(self) -> &'static str {
        match self {
            Self::Core => "#version 450 core\n",
            Self::Es => "#version 300 es\nprecision highp float;\n",
        }
    }
}

/// The current context.
pub(crate) struct Headless {
    pub(crate) gl: glow::Context,
    /// Keeps the library loaded.
    _egl: egl::DynamicInstance<egl::EGL1_5>,
}

impl Headless {
    /// Creates a context and makes it current.
    pub(crate) fn new(api: Api) -> Result<Self> {
        // SAFETY: The library is the system's EGL.
        let egl = unsafe { egl::DynamicInstance::<egl::EGL1_5>::load_required() }.context("no libEGL.so.1")?;
        // SAFETY: Both platforms have a default display.
        let displays = unsafe {
            [
                egl.get_platform_display(SURFACELESS, egl::DEFAULT_DISPLAY, &[egl::ATTRIB_NONE]).ok(),
                egl.get_display(egl::DEFAULT_DISPLAY),
            ]
        };
        let mut displays = displays.into_iter().flatten();
        let display = displays.find(|display| egl.initialize(*display).is_ok()).context("no display for EGL")?;
        let (library, kind, [major, minor]) = match api {
            Api::Core => (egl::OPENGL_API, egl::OPENGL_BIT, [4, 5]),
            Api::Es => (egl::OPENGL_ES_API, egl::OPENGL_ES3_BIT, [3, 0]),
        };
        egl.bind_api(library)?;
        let wanted = [egl::SURFACE_TYPE, egl::PBUFFER_BIT, egl::RENDERABLE_TYPE, kind, egl::NONE];
        let config = egl.choose_first_config(display, &wanted)?.context("no configuration")?;
        let version = [egl::CONTEXT_MAJOR_VERSION, major, egl::CONTEXT_MINOR_VERSION, minor, egl::NONE];
        let context = egl.create_context(display, config, None, &version).context("no context of this version")?;
        egl.make_current(display, None, None, Some(context))?;
        let function = |name: &str| egl.get_proc_address(name).map_or(std::ptr::null(), |found| found as *const c_void);
        // SAFETY: The context is current.
        let gl = unsafe { glow::Context::from_loader_function(function) };
        Ok(Self { gl, _egl: egl })
    }

    /// Returns the version and the name of the renderer.
    pub(crate) fn version(&self) -> String {
        use glow::HasContext as _;
        // SAFETY: The context is current.
        let text = |name| unsafe { self.gl.get_parameter_string(name) };
        format!("{}, {}", text(glow::VERSION), text(glow::RENDERER))
    }
}
