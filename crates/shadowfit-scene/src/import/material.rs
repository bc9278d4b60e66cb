//! Materials and the textures they use.

use std::collections::HashMap;

use glam::{Vec3, Vec4};
use gltf::json::extensions::texture::TextureTransform;
use gltf::json::material::{self as json, AlphaMode as JsonAlpha};
use gltf::json::texture::{self, MagFilter, WrappingMode};
use gltf::json::validation::Checked;
use gltf::json::{Index, Root, deserialize};

use super::accessor::Reader;
use super::image::Images;
use super::notes::Notes;
use crate::error::{Problem, entry};
use crate::{AlphaMode, Image, Material, Texture, Wrap};

/// Greatest emitted radiance. Sums of greater values would overflow half floats.
const MAX_EMISSIVE: f32 = 65_504.0;

/// Properties of a material that its primitives need.
#[derive(Clone, Copy, Default)]
pub(crate) struct Look {
    /// Index into the scene's materials.
    pub(crate) material: usize,
    /// Set of texture coordinates that the textures read.
    pub(crate) uv_set: u32,
    /// Texture transform of the normal map, if the material has one.
    pub(crate) uv_from_texcoord: Option<[Vec3; 2]>,
    /// Whether the material cuts out all of its surface.
    pub(crate) is_hidden: bool,
}

/// Loads each material that a primitive uses, once.
pub(crate) struct Materials<'a> {
    root: &'a Root,
    reader: &'a Reader<'a>,
    images: Images<'a>,
    looks: HashMap<usize, Look>,
    loaded: Vec<Material>,
    /// Number of blended materials.
    blended: usize,
}

/// A reference to a texture from a material.
struct Use<'a> {
    element: String,
    texture: Index<texture::Texture>,
    uv_set: u32,
    transform: Option<&'a TextureTransform>,
}

impl<'a> Materials<'a> {
    /// Starts with the default material only.
    pub(crate) fn new(root: &'a Root, reader: &'a Reader<'a>, images: Images<'a>) -> Self {
        Self { root, reader, images, looks: HashMap::new(), loaded: vec![Material::default()], blended: 0 }
    }

    /// Returns the look of a primitive's material. Loads the material on first use.
    pub(crate) fn look(
        &mut self,
        material: Option<Index<json::Material>>,
        element: &str,
        notes: &mut Notes,
    ) -> Result<Look, Problem> {
        let Some(index) = material else { return Ok(Look::default()) };
        if let Some(&look) = self.looks.get(&index.value()) {
            return Ok(look);
        }
        let json = entry(&self.root.materials, index.value(), "material", &format!("{element}.material"))?;
        let look = self.load(json, &format!("materials[{index}]"), notes)?;
        self.looks.insert(index.value(), look);
        Ok(look)
    }

    /// Returns the materials and images for the scene.
    pub(crate) fn finish(self, notes: &mut Notes) -> (Vec<Material>, Vec<Image>) {
        if self.blended > 0 {
            notes.add(format!(
                "blended materials cast where their alpha, with texture and vertex colour, is at least 0.5: {}",
                self.blended
            ));
        }
        (self.loaded, self.images.finish())
    }

    fn load(&mut self, json: &json::Material, element: &str, notes: &mut Notes) -> Result<Look, Problem> {
        let gloss = SpecularGlossiness::of(json, element)?;
        let base = match &gloss {
            Some(gloss) => gloss.texture(element),
            None => base_color_use(json, element),
        };
        let transform = json.normal_texture.as_ref().and_then(normal_transform);
        let normal = json.normal_texture.as_ref().map(|info| Use {
            element: format!("{element}.normalTexture"),
            texture: info.index,
            uv_set: transform.as_ref().and_then(|t| t.tex_coord).unwrap_or(info.tex_coord),
            transform: transform.as_ref(),
        });
        let uv_set = base.as_ref().or(normal.as_ref()).map_or(0, |used| used.uv_set);
        let base_color_texture = match &base {
            Some(used) => Some(self.texture(used, notes)?.unwrap_or_else(|| self.blank())),
            None => None,
        };
        let mut normal_texture = match &normal {
            Some(used) => self.texture(used, notes)?,
            None => None,
        };
        if normal.is_some_and(|used| used.uv_set != uv_set) {
            notes.add(format!(
                "{element}.normalTexture: left out: it uses other texture coordinates than the base colour"
            ));
            normal_texture = None;
        }
        let mut material = plain(json, element, notes);
        if let Some(gloss) = &gloss {
            gloss.apply(&mut material, notes);
        }
        material.base_color_texture = base_color_texture;
        material.normal_texture = normal_texture;
        self.blended += usize::from(material.alpha == AlphaMode::Blend);
        self.loaded.push(material);
        let uv_from_texcoord = normal_texture.map(|texture| texture.uv_from_texcoord);
        Ok(Look { material: self.loaded.len() - 1, uv_set, uv_from_texcoord, is_hidden: is_hidden(json) })
    }

    /// Returns a texture, or `None` if it has no usable image.
    fn texture(&mut self, used: &Use, notes: &mut Notes) -> Result<Option<Texture>, Problem> {
        let texture = entry(&self.root.textures, used.texture.value(), "texture", &used.element)?;
        let element = format!("textures[{}]", used.texture);
        let sources = sources(texture, self.root.images.len(), &element)?;
        let image = self.image(&sources, &element, notes);
        let Some(image) = image else { return Ok(None) };
        let mut loaded = Texture { image, ..blank() };
        if let Some(index) = texture.sampler {
            let sampler = entry(&self.root.samplers, index.value(), "sampler", &element)?;
            loaded.wrap = [wrap(sampler.wrap_s), wrap(sampler.wrap_t)];
            loaded.nearest = matches!(sampler.mag_filter, Some(Checked::Valid(MagFilter::Nearest)));
        }
        if let Some(transform) = used.transform {
            loaded.uv_from_texcoord = rows(transform);
        }
        Ok(Some(loaded))
    }

    /// Returns the first usable image of a texture. Adds notes about the unusable images before it.
    fn image(&mut self, sources: &[usize], element: &str, notes: &mut Notes) -> Option<usize> {
        if sources.is_empty() {
            notes.add(format!("{element}: replaced by a placeholder: it has no PNG, JPEG or WebP image"));
        }
        for (index, &source) in sources.iter().enumerate() {
            match self.images.load(source, self.reader) {
                Ok(image) => return Some(image),
                Err(reason) => {
                    let next = sources.get(index + 1);
                    let instead = next.map_or("a placeholder".to_owned(), |next| format!("images[{next}]"));
                    notes.add(format!("images[{source}]: replaced by {instead}: {reason}"));
                }
            }
        }
        None
    }

    fn blank(&mut self) -> Texture {
        Texture { image: self.images.placeholder(), ..blank() }
    }
}

/// Returns the textures that import reads of a material: base or diffuse colour and normal map.
pub(super) fn textures(json: &json::Material) -> impl Iterator<Item = Index<texture::Texture>> {
    let base = match SpecularGlossiness::of(json, "") {
        Ok(Some(gloss)) => gloss.diffuse_texture.map(|info| info.index),
        _ => json.pbr_metallic_roughness.base_color_texture.as_ref().map(|info| info.index),
    };
    base.into_iter().chain(json.normal_texture.as_ref().map(|info| info.index))
}

/// Returns whether at least one of a texture's images does not declare a format that import cannot decode.
pub(super) fn has_plain_image(root: &Root, texture: &texture::Texture) -> bool {
    // Names of the types in `mimeType` and data URIs, and ends of file names.
    const UNREAD: [&str; 3] = ["ktx2", "avif", "dds"];
    let is_plain = |image: &gltf::json::Image| {
        let kind = image.mime_type.as_ref().map(|kind| kind.0.as_str());
        let kind = kind.or_else(|| image.uri.as_ref()?.strip_prefix("data:")?.split([';', ',']).next());
        let kind = kind.or_else(|| image.uri.as_ref()?.rsplit('.').next()).unwrap_or_default().to_ascii_lowercase();
        !UNREAD.iter().any(|unread| kind.ends_with(unread))
    };
    sources(texture, root.images.len(), "").is_ok_and(|all| all.iter().any(|&source| is_plain(&root.images[source])))
}

/// Returns the images of a texture by preference: first the image of `EXT_texture_webp`, then the image for
/// readers without it. All indices are below `count`, the number of images in the file.
fn sources(texture: &texture::Texture, count: usize, element: &str) -> Result<Vec<usize>, Problem> {
    // The gltf crate's value for a texture without an image of its own.
    let absent = u32::MAX as usize;
    let mut sources = Vec::new();
    sources.extend(webp_source(texture, element)?);
    sources.extend(Some(texture.source.value()).filter(|&source| source != absent));
    match sources.iter().find(|&&source| source >= count) {
        Some(source) => Err(Problem::new(element, format!("there is no image {source}"))),
        None => Ok(sources),
    }
}

/// Returns the image that `EXT_texture_webp` names. The gltf crate leaves this extension unparsed.
fn webp_source(texture: &texture::Texture, element: &str) -> Result<Option<usize>, Problem> {
    let extension = texture.extensions.as_ref().and_then(|extensions| extensions.others.get("EXT_texture_webp"));
    let Some(source) = extension.and_then(|extension| extension.get("source")) else { return Ok(None) };
    let index = source.as_u64().and_then(|source| usize::try_from(source).ok());
    let wrong = || {
        let element = format!("{element}.extensions.EXT_texture_webp.source");
        Problem::new(element, format!("{source} is not the index of an image"))
    };
    index.ok_or_else(wrong).map(Some)
}

fn base_color_use<'a>(json: &'a json::Material, element: &str) -> Option<Use<'a>> {
    let info = json.pbr_metallic_roughness.base_color_texture.as_ref()?;
    Some(texture_use(info, format!("{element}.pbrMetallicRoughness.baseColorTexture")))
}

fn texture_use(info: &texture::Info, element: String) -> Use<'_> {
    let transform = info.extensions.as_ref().and_then(|own| own.texture_transform.as_ref());
    let uv_set = transform.and_then(|transform| transform.tex_coord).unwrap_or(info.tex_coord);
    Use { element, texture: info.index, uv_set, transform }
}

/// Returns whether a mask cuts out all of a surface, because its cutoff is above 1.
fn is_hidden(json: &json::Material) -> bool {
    let is_masked = matches!(json.alpha_mode, Checked::Valid(JsonAlpha::Mask));
    is_masked && json.alpha_cutoff.is_some_and(|cutoff| cutoff.0 > 1.0)
}

/// Greatest component of a diffuse colour that counts as black. Metals have no diffuse colour.
const BLACK_DIFFUSE: f32 = 0.04;

/// Least component of a specular colour that makes a black surface a metal. Gems, the brightest non-metals, reflect 0.17.
const METAL_SPECULAR: f32 = 0.25;

/// `KHR_materials_pbrSpecularGlossiness`: base colour and alpha of materials from before metallic-roughness.
/// A black material with a bright specular colour is read as a metal, any other one as a non-metal.
#[derive(serde::Deserialize)]
#[serde(default, rename_all = "camelCase")]
struct SpecularGlossiness {
    diffuse_factor: [f32; 4],
    diffuse_texture: Option<texture::Info>,
    specular_factor: Option<[f32; 3]>,
    glossiness_factor: f32,
    #[serde(rename = "specularGlossinessTexture")]
    reflection_texture: Option<texture::Info>,
}

impl Default for SpecularGlossiness {
    fn default() -> Self {
        Self {
            diffuse_factor: [1.0; 4],
            diffuse_texture: None,
            specular_factor: None,
            glossiness_factor: 1.0,
            reflection_texture: None,
        }
    }
}

impl SpecularGlossiness {
    const NAME: &str = "KHR_materials_pbrSpecularGlossiness";

    fn of(json: &json::Material, element: &str) -> Result<Option<Self>, Problem> {
        let Some(value) = json.extensions.as_ref().and_then(|own| own.others.get(Self::NAME)) else { return Ok(None) };
        let wrong =
            |error: gltf::json::Error| Problem::new(format!("{element}.extensions.{}", Self::NAME), error.to_string());
        deserialize::from_value(value.clone()).map(Some).map_err(wrong)
    }

    fn texture(&self, element: &str) -> Option<Use<'_>> {
        let name = format!("{element}.extensions.{}.diffuseTexture", Self::NAME);
        self.diffuse_texture.as_ref().map(|info| texture_use(info, name))
    }

    fn apply(&self, material: &mut Material, notes: &mut Notes) {
        let name = Self::NAME;
        material.base_color = Vec4::from_array(self.diffuse_factor.map(unit));
        material.metallic = 0.0;
        material.roughness = 1.0 - unit(self.glossiness_factor);
        if self.reflection_texture.is_some() {
            notes.add(format!(
                "{name}: specularGlossinessTexture is not read: glossiness is uniform, and no surface is a metal"
            ));
        } else if let Some(metal) = self.metal() {
            material.base_color = metal.extend(material.base_color.w);
            material.metallic = 1.0;
        } else if self.specular_factor.is_some() {
            notes.add(format!(
                "{name}: specularFactor is read for black materials only: others reflect like non-metals"
            ));
        }
    }

    /// Returns the base colour of a metal. The extension's usual conversion gives metalness 1 and the specular colour
    /// where the diffuse colour is black.
    fn metal(&self) -> Option<Vec3> {
        let specular = Vec3::from_array(self.specular_factor.unwrap_or([1.0; 3]).map(unit));
        let diffuse = Vec4::from_array(self.diffuse_factor.map(unit)).truncate();
        let is_metal = diffuse.max_element() <= BLACK_DIFFUSE && specular.max_element() >= METAL_SPECULAR;
        (is_metal && self.diffuse_texture.is_none()).then_some(specular)
    }
}

/// Returns the texture transform of a normal texture, which the gltf crate leaves unparsed.
fn normal_transform(info: &json::NormalTexture) -> Option<TextureTransform> {
    let value = info.extensions.as_ref()?.others.get("KHR_texture_transform")?;
    deserialize::from_value(value.clone()).ok()
}

/// Returns the material without its textures.
fn plain(json: &json::Material, element: &str, notes: &mut Notes) -> Material {
    let pbr = &json.pbr_metallic_roughness;
    let mut metallic = unit(pbr.metallic_factor.0);
    if pbr.metallic_roughness_texture.is_some() {
        // The factors only scale that texture. 1, their default, would turn everything into a mirror.
        notes.add("metallic-roughness textures are not read: their materials count as not metallic");
        metallic = 0.0;
    }
    let strength = json.extensions.as_ref().and_then(|e| e.emissive_strength.as_ref());
    let strength = strength.map_or(1.0, |e| e.emissive_strength.0);
    let emissive = json.emissive_factor.0.map(|c| clamped(c * strength, MAX_EMISSIVE));
    let normal_scale = json.normal_texture.as_ref().map_or(1.0, |normal| normal.scale);
    Material {
        name: json.name.clone().unwrap_or_default(),
        base_color: Vec4::from_array(pbr.base_color_factor.0.map(unit)),
        normal_scale: if normal_scale.is_finite() { normal_scale } else { 1.0 },
        metallic,
        roughness: unit(pbr.roughness_factor.0),
        emissive: Vec3::from_array(emissive),
        alpha: alpha(json, element, notes),
        double_sided: json.double_sided,
        ..Material::default()
    }
}

fn alpha(json: &json::Material, element: &str, notes: &mut Notes) -> AlphaMode {
    match json.alpha_mode {
        Checked::Valid(JsonAlpha::Opaque) => AlphaMode::Opaque,
        Checked::Valid(JsonAlpha::Mask) => {
            AlphaMode::Mask { cutoff: json.alpha_cutoff.map_or(0.5, |cutoff| unit(cutoff.0)) }
        }
        Checked::Valid(JsonAlpha::Blend) => AlphaMode::Blend,
        Checked::Invalid => {
            notes.add(format!("{element}.alphaMode: unknown, taken as OPAQUE"));
            AlphaMode::Opaque
        }
    }
}

/// Clamps to 0..=1. NaN becomes 0.
pub(crate) fn unit(value: f32) -> f32 {
    clamped(value, 1.0)
}

/// Clamps to 0..=`max`. NaN becomes 0.
fn clamped(value: f32, max: f32) -> f32 {
    if value.is_nan() { 0.0 } else { value.clamp(0.0, max) }
}

/// Returns a texture that repeats, is filtered and has no transform.
fn blank() -> Texture {
    Texture { image: 0, wrap: [Wrap::Repeat; 2], nearest: false, uv_from_texcoord: [Vec3::X, Vec3::Y] }
}

fn wrap(mode: Checked<WrappingMode>) -> Wrap {
    match mode {
        Checked::Valid(WrappingMode::ClampToEdge) => Wrap::Clamp,
        Checked::Valid(WrappingMode::MirroredRepeat) => Wrap::Mirror,
        Checked::Valid(WrappingMode::Repeat) | Checked::Invalid => Wrap::Repeat,
    }
}

/// Returns the matrix translation * rotation * scale of `KHR_texture_transform`. Positive angles rotate
/// texture coordinates counter-clockwise in the image, whose v points down.
fn rows(transform: &TextureTransform) -> [Vec3; 2] {
    let ([x, y], [scale_u, scale_v]) = (transform.offset.0, transform.scale.0);
    let (sin, cos) = transform.rotation.0.sin_cos();
    let rows = [Vec3::new(cos * scale_u, sin * scale_v, x), Vec3::new(-sin * scale_u, cos * scale_v, y)];
    if rows.iter().all(|row| row.is_finite()) { rows } else { [Vec3::X, Vec3::Y] }
}
