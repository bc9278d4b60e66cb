//! The renderer's WGSL: every file is used, every module is valid and has its passes' entry points, and
//! WebGL2 can draw with its modules.

use std::sync::LazyLock;

use naga::ShaderStage::{self, Fragment, Vertex};
use naga::valid::Capabilities;
use shadowfit::DepthConvention;
use shadowfit::settings::{FilterKind, MapFormat, MapSelection};
use shadowfit_render::passes::Numbering;
use shadowfit_render::{Overlay, shaders};
use shadowfit_testing::package_folder;
use shadowfit_testing::pairs::{all_pairs, full_product};
use shadowfit_testing::wgsl::{Shader, assert_every_file_is_used};
use shadowfit_wgpu::ShadowMapDescriptor;

use super::layout;

/// A module and its requirements.
pub(crate) struct Module {
    pub(crate) shader: Shader,
    stages: &'static [ShaderStage],
    needed: Capabilities,
    /// Whether WebGL2 draws with it. WebGL2 has neither primitive indices nor depths as numbers. It uses
    /// other modules than other backends for loading pixels or texels.
    is_for_webgl2: bool,
}

impl Module {
    fn new(name: impl Into<String>, source: String) -> Self {
        let shader = Shader::new(name, source);
        Self { shader, stages: &[Vertex, Fragment], needed: Capabilities::empty(), is_for_webgl2: true }
    }

    /// Checks everything that the tests below require of a module.
    fn check(&self) {
        self.shader.assert_valid(self.needed);
        self.shader.assert_has_stages(self.stages);
        if self.is_for_webgl2 {
            self.shader.assert_translates_to_webgl2();
        }
        layout::assert_uniforms_are_compared(&self.shader);
    }
}

/// Modules that look up shadow maps.
#[derive(Clone, Copy, Debug)]
enum Kind {
    Scene,
    Probe(Numbering),
    Surfaces,
    Inset(wgpu::Backend),
    Block(wgpu::Backend),
    Overlay(Overlay),
}

impl Kind {
    fn all() -> Vec<Self> {
        use wgpu::Backend::{Gl, Vulkan};
        let mut all =
            vec![Self::Scene, Self::Probe(Numbering::Primitives), Self::Probe(Numbering::Vertices), Self::Surfaces];
        all.extend([Vulkan, Gl].map(Self::Inset));
        all.extend([Vulkan, Gl].map(Self::Block));
        all.extend(Overlay::ALL.map(Self::Overlay));
        all
    }

    fn module(self, map: &ShadowMapDescriptor) -> Module {
        let ShadowMapDescriptor { format, filter, depth, selection, cross_fades, .. } = *map;
        let source = match self {
            Self::Scene => shaders::scene(map),
            Self::Probe(numbering) => shaders::probe(map, numbering),
            Self::Surfaces => shaders::surfaces(map),
            Self::Inset(backend) => shaders::inset(map, backend),
            Self::Block(backend) => shaders::block(map, backend),
            Self::Overlay(overlay) => shaders::overlay(map, overlay),
        };
        let name = format!("{self:?}, {format:?} {filter:?} {depth:?} {selection:?}, cross fades {cross_fades}");
        let plain = Module::new(name, source);
        let reads_depth = format.is_depth() && filter == FilterKind::Pcss;
        match self {
            Self::Probe(Numbering::Primitives) => {
                Module { needed: Capabilities::PRIMITIVE_INDEX, is_for_webgl2: false, ..plain }
            }
            Self::Inset(wgpu::Backend::Vulkan) | Self::Block(wgpu::Backend::Vulkan) => {
                Module { is_for_webgl2: false, ..plain }
            }
            _ => Module { is_for_webgl2: !reads_depth, ..plain },
        }
    }
}

/// Values of a shadow map that change its WGSL.
const DEPTHS: [DepthConvention; 2] = [DepthConvention::ZeroToOne, DepthConvention::Reversed];
const SELECTIONS: [fn() -> MapSelection; 2] = [MapSelection::default, || MapSelection::ViewDepth { overlap: 0.0 }];

/// Returns the numbers of kinds of modules, formats, filters, depths, selections, and of cross fades.
fn counts() -> [usize; 6] {
    [Kind::all().len(), MapFormat::ALL.len(), FilterKind::ALL.len(), DEPTHS.len(), SELECTIONS.len(), 2]
}

/// Returns the module of a combination of values, each by its index.
fn looked_up(row: &[usize]) -> Module {
    let &[kind, format, filter, depth, selection, cross_fades] = row else { panic!("six values") };
    let map = ShadowMapDescriptor {
        format: MapFormat::ALL[format],
        filter: FilterKind::ALL[filter],
        depth: DEPTHS[depth],
        selection: SELECTIONS[selection](),
        cross_fades: cross_fades == 1,
        ..Default::default()
    };
    Kind::all()[kind].module(&map)
}

/// Returns the modules that look up no shadow map.
fn others() -> Vec<Module> {
    let mut all: Vec<Module> = [
        ("sky", shaders::sky()),
        ("lines", shaders::lines()),
        ("encode", shaders::encode()),
        ("mip", shaders::mip()),
        ("quads", shaders::quads()),
        ("mark rows", shaders::mark_rows(1)),
        ("marks", shaders::marks()),
    ]
    .map(|(name, source)| Module::new(name, source))
    .into();
    all.push(Module { stages: &[Vertex], ..Module::new("clear", shaders::clear()) });
    let multisampled = Module::new("mark rows of four samples", shaders::mark_rows(4));
    all.push(Module { is_for_webgl2: false, ..multisampled });
    let caster = |format| shaders::caster(&ShadowMapDescriptor { format, ..Default::default() });
    all.extend(MapFormat::ALL.map(|format| Module::new(format!("caster, {format:?}"), caster(format))));
    all
}

/// Every module of the renderer, with every pair of values that change the look-up's WGSL.
static MODULES: LazyLock<Vec<Module>> = LazyLock::new(|| {
    let looked_up = all_pairs(&counts()).into_iter().map(|row| looked_up(&row));
    others().into_iter().chain(looked_up).collect()
});

#[test]
fn every_wgsl_file_stands_whole_in_some_module() {
    let folder = package_folder(env!("CARGO_MANIFEST_DIR")).join("src/shaders");
    let texts: Vec<&str> = MODULES.iter().map(|module| module.shader.source.as_str()).collect();
    assert_every_file_is_used(&folder, &texts, |file| {
        let in_group = |group: &str| file.replace("MATERIAL_GROUP", group).replace("GROUP", group);
        ["0", "1", "2", "3"].map(in_group).into()
    });
}

#[test]
fn every_module_is_valid_and_probes_alone_need_an_optional_capability() {
    for module in &*MODULES {
        module.shader.assert_valid(module.needed);
    }
}

#[test]
fn every_module_has_the_entry_points_of_its_passes() {
    for module in &*MODULES {
        module.shader.assert_has_stages(module.stages);
    }
}

#[test]
fn modules_that_draw_can_be_translated_for_webgl2_and_their_uniforms_are_whole_vectors() {
    let drawn: Vec<&Module> = MODULES.iter().filter(|module| module.is_for_webgl2).collect();
    assert!(drawn.len() > MODULES.len() / 2, "{} of {} modules", drawn.len(), MODULES.len());
    for module in drawn {
        module.shader.assert_translates_to_webgl2();
    }
}

#[test]
fn every_uniform_of_every_module_is_one_whose_layout_is_compared() {
    for module in &*MODULES {
        layout::assert_uniforms_are_compared(&module.shader);
    }
}

#[test]
#[ignore = "the full product of descriptors: cargo xtask test --all"]
fn modules_of_the_full_product_of_descriptors_are_valid_and_can_be_translated_for_webgl2() {
    for row in full_product(&counts()) {
        looked_up(&row).check();
    }
}
