//! Primitives: attributes, indices, morph targets and joint influences.

use glam::{Vec2, Vec3, Vec4};
use gltf::json::accessor::Accessor;
use gltf::json::mesh::{self, Mode, Semantic};
use gltf::json::validation::Checked;
use gltf::json::{Index, mesh::MorphTarget as JsonTarget};

use super::accessor::{Integers, Reader};
use super::influence;
use super::material::{Look, unit};
use super::notes::{Notes, Tally};
use super::surface;
use super::topology::{triangle_list, without_triangles};
use crate::error::Problem;
use crate::{MorphTarget, Primitive};

/// Greatest coordinate accepted, in metres: the product of three of them, as in a volume, is still
/// finite in f32.
pub(crate) const MAX_COORDINATE: f32 = 1e12;

/// Reads the attributes of one primitive.
struct Attributes<'a> {
    reader: &'a Reader<'a>,
    json: &'a mesh::Primitive,
    element: &'a str,
    /// Number of vertices; all attributes must agree.
    count: usize,
}

/// Loads a primitive with the look of its material; `None` where it has no triangles to draw.
pub(crate) fn load(
    reader: &Reader,
    json: &mesh::Primitive,
    element: &str,
    look: &Look,
    notes: &mut Notes,
) -> Result<Option<Primitive>, Problem> {
    let Checked::Valid(mode) = json.mode else {
        return Err(Problem::new(format!("{element}.mode"), "it is not a primitive mode"));
    };
    if let Some(kind) = without_triangles(mode) {
        notes.add(format!("{element}: {kind} skipped: only triangles are drawn"));
        return Ok(None);
    }
    let Some(&positions) = json.attributes.get(&Checked::Valid(Semantic::Positions)) else {
        notes.add(format!("{element}: skipped: it has no positions"));
        return Ok(None);
    };
    let count = reader.count(positions, &format!("{element}.attributes.POSITION"))?;
    let attributes = Attributes { reader, json, element, count };
    let mut primitive = Primitive {
        material: look.material,
        positions: attributes.positions(positions, &format!("{element}.attributes.POSITION"))?,
        normals: attributes.vectors(&Semantic::Normals, Vec3::from_array)?,
        tangents: attributes.vectors(&Semantic::Tangents, Vec4::from_array)?,
        uvs: attributes.uvs(look.uv_set, notes)?,
        colors: attributes.colors()?,
        indices: attributes.indices(mode)?,
        morphs: attributes.morphs()?,
        ..Primitive::default()
    };
    (primitive.joints, primitive.weights) = influence::load(reader, json, element, count)?;
    complete(&mut primitive, mode, look, notes);
    Ok(Some(primitive))
}

/// Repairs and computes what the file leaves open.
fn complete(primitive: &mut Primitive, mode: Mode, look: &Look, notes: &mut Notes) {
    if primitive.morphs.is_empty() && primitive.joints.is_empty() {
        let dropped = surface::drop_zero_area(primitive);
        // Strips join their parts by such triangles on purpose.
        if mode != Mode::TriangleStrip {
            notes.count(Tally::ZeroAreaTriangles, dropped);
        }
    }
    if primitive.normals.is_empty() {
        surface::flatten(primitive);
        notes.count(Tally::ComputedNormals, 1);
    } else {
        notes.count(Tally::RepairedNormals, surface::repair_normals(primitive));
    }
    let usable = |tangent: &Vec4| tangent.is_finite() && tangent.truncate().length_squared() > 0.25;
    match look.uv_from_texcoord {
        None => primitive.tangents.clear(),
        Some(_) if !primitive.tangents.is_empty() && primitive.tangents.iter().all(usable) => {}
        Some([u, v]) => {
            let uv = |vertex: usize| primitive.uvs.get(vertex).copied().unwrap_or(Vec2::ZERO).extend(1.0);
            let uvs = (0..primitive.positions.len()).map(uv);
            let uvs: Vec<Vec2> = uvs.map(|uv| Vec2::new(u.dot(uv), v.dot(uv))).collect();
            surface::compute_tangents(primitive, &uvs);
        }
    }
}

impl Attributes<'_> {
    fn find(&self, semantic: &Semantic) -> Option<(Index<Accessor>, String)> {
        let index = *self.json.attributes.get(&Checked::Valid(semantic.clone()))?;
        Some((index, format!("{}.attributes.{}", self.element, semantic.to_string())))
    }

    /// Elements of an accessor that must have one a vertex; the count is checked before any is read.
    fn elements<const N: usize>(
        &self,
        index: Index<Accessor>,
        element: &str,
        integers: Integers,
    ) -> Result<Vec<[f32; N]>, Problem> {
        self.reader.check_count(index, element, self.count)?;
        self.reader.floats(index, element, integers)
    }

    /// Positions or displacements: finite and not beyond what f32 can compute with.
    fn positions(&self, index: Index<Accessor>, element: &str) -> Result<Vec<Vec3>, Problem> {
        let values = self.elements(index, element, Integers::AsDeclared)?;
        let values: Vec<Vec3> = values.into_iter().map(Vec3::from_array).collect();
        let wrong = values.iter().position(|v| !v.is_finite() || v.abs().max_element() > MAX_COORDINATE);
        let Some(vertex) = wrong else { return Ok(values) };
        let name = format!("{element}, accessor {index}");
        let [x, y, z] = values[vertex].to_array();
        Err(if values[vertex].is_finite() {
            let reason = format!("vertex {vertex} at ({x:e}, {y:e}, {z:e}) is beyond {MAX_COORDINATE:e} m");
            Problem::new(name, reason).hint("Scale the scene down")
        } else {
            Problem::new(name, format!("vertex {vertex} is not finite: ({x}, {y}, {z})"))
        })
    }

    fn vectors<const N: usize, T>(&self, semantic: &Semantic, from: fn([f32; N]) -> T) -> Result<Vec<T>, Problem> {
        let Some((index, element)) = self.find(semantic) else { return Ok(Vec::new()) };
        let values = self.elements(index, &element, Integers::AsDeclared)?;
        Ok(values.into_iter().map(from).collect())
    }

    /// Texture coordinates of a set, none where it is absent.
    fn uvs(&self, set: u32, notes: &mut Notes) -> Result<Vec<Vec2>, Problem> {
        let mut uvs = self.vectors(&Semantic::TexCoords(set), Vec2::from_array)?;
        let broken = uvs.iter_mut().filter(|uv| !uv.is_finite());
        let repaired = broken.map(|uv| *uv = Vec2::ZERO).count();
        notes.count(Tally::RepairedUvs, repaired);
        Ok(uvs)
    }

    fn colors(&self) -> Result<Vec<Vec4>, Problem> {
        let Some((index, element)) = self.find(&Semantic::Colors(0)) else { return Ok(Vec::new()) };
        let mut colors: Vec<Vec4> = if self.reader.components(index) == 3 {
            let values = self.elements::<3>(index, &element, Integers::Normalized)?;
            values.into_iter().map(|rgb| Vec3::from_array(rgb).extend(1.0)).collect()
        } else {
            let values = self.elements::<4>(index, &element, Integers::Normalized)?;
            values.into_iter().map(Vec4::from_array).collect()
        };
        for color in &mut colors {
            *color = Vec4::from_array(color.to_array().map(unit));
        }
        Ok(colors)
    }

    /// Indices of a triangle list, all in range.
    fn indices(&self, mode: Mode) -> Result<Vec<u32>, Problem> {
        let Some(index) = self.json.indices else {
            let all: Vec<u32> = (0..self.count as u32).collect();
            return Ok(triangle_list(mode, &all));
        };
        let element = format!("{}.indices", self.element);
        let corners = self.reader.integers::<1>(index, &element)?;
        let corners: Vec<u32> = corners.into_iter().map(|[corner]| corner).collect();
        if let Some(at) = corners.iter().position(|&corner| corner as usize >= self.count) {
            let reason = format!("index {at} is {}, there are {} vertices", corners[at], self.count);
            return Err(Problem::new(format!("{element}, accessor {index}"), reason));
        }
        Ok(triangle_list(mode, &corners))
    }

    fn morphs(&self) -> Result<Vec<MorphTarget>, Problem> {
        let targets = self.json.targets.iter().flatten().enumerate();
        targets.map(|(i, target)| self.morph(&format!("{}.targets[{i}]", self.element), target)).collect()
    }

    fn morph(&self, element: &str, target: &JsonTarget) -> Result<MorphTarget, Problem> {
        let read = |index: Option<Index<Accessor>>, name: &str| match index {
            Some(index) => self.positions(index, &format!("{element}.{name}")),
            None => Ok(Vec::new()),
        };
        let mut positions = read(target.positions, "POSITION")?;
        positions.resize(self.count, Vec3::ZERO);
        Ok(MorphTarget { positions, normals: read(target.normals, "NORMAL")? })
    }
}
