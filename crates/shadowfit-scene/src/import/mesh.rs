//! Primitives: attributes, indices, morph targets and joint influences.

use std::collections::HashMap;
use std::sync::Arc;

use glam::{Vec2, Vec3, Vec4};
use gltf::json::accessor::Accessor;
use gltf::json::mesh::{self, Mode, Semantic};
use gltf::json::validation::Checked;
use gltf::json::{Index, mesh::MorphTarget as JsonTarget};

use super::accessor::{Elements, Integers, Reader};
use super::extensions::{COMPRESSED, DECOMPRESS};
use super::influence;
use super::material::{Look, unit};
use super::notes::{Notes, Tally};
use super::surface;
use super::topology::{UsedVertices, triangle_list, without_triangles};
use crate::error::Problem;
use crate::limits::MAX_COORDINATE;
use crate::{Geometry, MorphTarget, Primitive};

/// Indices that count as one element of the budget, by their memory.
const INDICES_PER_ELEMENT: usize = 4;

/// Loads each geometry once. Primitives share it.
pub(crate) struct Geometries<'a> {
    reader: &'a Reader<'a>,
    known: HashMap<Key, Arc<Geometry>>,
    used: UsedVertices,
}

/// Key of a primitive's geometry: its accessors, its set of texture coordinates and the transform of its
/// normal map.
#[derive(PartialEq, Eq, Hash)]
struct Key {
    mode: u32,
    indices: Option<usize>,
    attributes: Vec<(Checked<Semantic>, usize)>,
    /// Positions and normals of each morph target.
    targets: Vec<[Option<usize>; 2]>,
    uv_set: u32,
    /// Bits of the normal map's texture transform.
    tangents: Option<[[u32; 3]; 2]>,
}

impl Key {
    fn new(json: &mesh::Primitive, mode: Mode, look: &Look) -> Self {
        let number = |index: Option<Index<Accessor>>| index.map(|index| index.value());
        let targets = json.targets.iter().flatten();
        Self {
            mode: mode.as_gl_enum(),
            indices: number(json.indices),
            attributes: json.attributes.iter().map(|(name, index)| (name.clone(), index.value())).collect(),
            targets: targets.map(|target| [number(target.positions), number(target.normals)]).collect(),
            uv_set: look.uv_set,
            tangents: look.uv_from_texcoord.map(|rows| rows.map(|row| row.to_array().map(f32::to_bits))),
        }
    }
}

impl<'a> Geometries<'a> {
    /// Starts without geometries.
    pub(crate) fn new(reader: &'a Reader<'a>) -> Self {
        Self { reader, known: HashMap::new(), used: UsedVertices::default() }
    }

    /// Loads a primitive with the look of its material. Returns `None` if it has no triangles to draw.
    pub(crate) fn load(
        &mut self,
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
        let key = Key::new(json, mode, look);
        let geometry = if let Some(known) = self.known.get(&key) {
            Arc::clone(known)
        } else {
            let made = Arc::new(self.decode(json, element, mode, positions, look, notes)?);
            self.known.insert(key, Arc::clone(&made));
            made
        };
        Ok(Some(Primitive { material: look.material, geometry }))
    }

    fn decode(
        &mut self,
        json: &mesh::Primitive,
        element: &str,
        mode: Mode,
        positions: Index<Accessor>,
        look: &Look,
        notes: &mut Notes,
    ) -> Result<Geometry, Problem> {
        let reader = self.reader;
        let name = format!("{element}.attributes.POSITION");
        check_plain(reader, json, positions, element)?;
        let count = reader.checked_count(positions, &name, 3)?;
        let mut indices = indices(reader, json, element, mode, count)?;
        let used = self.used.compact(&mut indices, count);
        let vertices = used.as_deref().map_or(Elements::All, Elements::Listed);
        let attributes = Attributes { reader, json, element, count, vertices };
        let mut geometry = Geometry {
            positions: attributes.positions(positions, &name)?,
            normals: attributes.vectors(&Semantic::Normals, Vec3::from_array)?,
            tangents: attributes.vectors(&Semantic::Tangents, Vec4::from_array)?,
            uvs: attributes.uvs(look.uv_set, notes)?,
            colors: attributes.colors()?,
            indices,
            morphs: attributes.morphs()?,
            ..Geometry::default()
        };
        (geometry.joints, geometry.weights) = influence::load(reader, json, element, count, vertices)?;
        if geometry.normals.is_empty() {
            // Flat normals give each target a position and a normal at each corner.
            let copied = geometry.indices.len().saturating_mul(2).saturating_mul(geometry.morphs.len());
            reader.spend(copied, &format!("{element}.targets"))?;
        }
        complete(&mut geometry, mode, look, notes);
        Ok(geometry)
    }
}

/// Refuses a primitive whose vertices exist in compressed form only.
fn check_plain(
    reader: &Reader,
    json: &mesh::Primitive,
    positions: Index<Accessor>,
    element: &str,
) -> Result<(), Problem> {
    let is_compressed = |name: &&str| json.extensions.as_ref().is_some_and(|own| own.others.contains_key(*name));
    let Some(name) = COMPRESSED.into_iter().find(is_compressed).filter(|_| !reader.has_data(positions)) else {
        return Ok(());
    };
    Err(Problem::new(element, format!("it is compressed by {name} and has no plain copy")).hint(DECOMPRESS))
}

/// Returns the indices of a triangle list, all below `count`.
fn indices(
    reader: &Reader,
    json: &mesh::Primitive,
    element: &str,
    mode: Mode,
    count: usize,
) -> Result<Vec<u32>, Problem> {
    // Strips and fans have up to three indices for each corner.
    let spend = |corners: usize| {
        let made = if mode == Mode::Triangles { corners } else { corners.saturating_mul(3) };
        reader.spend(made / INDICES_PER_ELEMENT, element)
    };
    let Some(index) = json.indices else {
        spend(count)?;
        let all: Vec<u32> = (0..count as u32).collect();
        return Ok(triangle_list(mode, &all));
    };
    let name = format!("{element}.indices");
    let corners = reader.integers::<1>(index, &name, Elements::All)?;
    let corners: Vec<u32> = corners.into_iter().map(|[corner]| corner).collect();
    if let Some(at) = corners.iter().position(|&corner| corner as usize >= count) {
        let reason = format!("index {at} is {}, there are {count} vertices", corners[at]);
        return Err(Problem::new(format!("{name}, accessor {index}"), reason));
    }
    if mode != Mode::Triangles {
        spend(corners.len())?;
    }
    Ok(triangle_list(mode, &corners))
}

/// Reads the attributes of one primitive.
struct Attributes<'a> {
    reader: &'a Reader<'a>,
    json: &'a mesh::Primitive,
    element: &'a str,
    /// Number of vertices in the file. All attributes must have this length.
    count: usize,
    /// Vertices that the primitive's triangles use.
    vertices: Elements<'a>,
}

/// Repairs the geometry and computes missing parts.
fn complete(geometry: &mut Geometry, mode: Mode, look: &Look, notes: &mut Notes) {
    if geometry.morphs.is_empty() && geometry.joints.is_empty() {
        let dropped = surface::drop_zero_area(geometry);
        // Strips use such triangles to join their parts.
        if mode != Mode::TriangleStrip {
            notes.count(Tally::ZeroAreaTriangles, dropped);
        }
    }
    if geometry.normals.is_empty() {
        surface::flatten(geometry);
        notes.count(Tally::ComputedNormals, 1);
    } else {
        notes.count(Tally::RepairedNormals, surface::repair_normals(geometry));
    }
    let usable = |tangent: &Vec4| tangent.is_finite() && tangent.truncate().length_squared() > 0.25;
    match look.uv_from_texcoord {
        None => geometry.tangents.clear(),
        Some(_) if !geometry.tangents.is_empty() && geometry.tangents.iter().all(usable) => {}
        Some([u, v]) => {
            let uv = |vertex: usize| geometry.uvs.get(vertex).copied().unwrap_or(Vec2::ZERO).extend(1.0);
            let uvs = (0..geometry.positions.len()).map(uv);
            let uvs: Vec<Vec2> = uvs.map(|uv| Vec2::new(u.dot(uv), v.dot(uv))).collect();
            surface::compute_tangents(geometry, &uvs);
        }
    }
}

impl Attributes<'_> {
    fn find(&self, semantic: &Semantic) -> Option<(Index<Accessor>, String)> {
        let index = *self.json.attributes.get(&Checked::Valid(semantic.clone()))?;
        Some((index, format!("{}.attributes.{}", self.element, semantic.to_string())))
    }

    /// Reads the used vertices from an accessor. Before reading, checks that the accessor has an element for
    /// each vertex.
    fn elements<const N: usize>(
        &self,
        index: Index<Accessor>,
        element: &str,
        integers: Integers,
    ) -> Result<Vec<[f32; N]>, Problem> {
        self.reader.check_count(index, element, self.count)?;
        self.reader.some_floats(index, element, integers, self.vertices)
    }

    /// Returns positions or displacements. Fails if one is not finite or exceeds [`MAX_COORDINATE`].
    fn positions(&self, index: Index<Accessor>, element: &str) -> Result<Vec<Vec3>, Problem> {
        let values = self.elements(index, element, Integers::AsDeclared)?;
        let values: Vec<Vec3> = values.into_iter().map(Vec3::from_array).collect();
        let wrong = values.iter().position(|v| !v.is_finite() || v.abs().max_element() > MAX_COORDINATE);
        let Some(vertex) = wrong else { return Ok(values) };
        let name = format!("{element}, accessor {index}");
        let value = values[vertex];
        let [x, y, z] = value.to_array();
        let vertex = match self.vertices {
            Elements::All => vertex,
            Elements::Listed(list) => list[vertex] as usize,
        };
        Err(if value.is_finite() {
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

    /// Returns the texture coordinates of a set. Empty if the set is absent.
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

    /// Returns the number of vertices that the primitive's triangles use.
    fn used(&self) -> usize {
        match self.vertices {
            Elements::All => self.count,
            Elements::Listed(list) => list.len(),
        }
    }

    fn morphs(&self) -> Result<Vec<MorphTarget>, Problem> {
        let targets = || self.json.targets.iter().flatten();
        // Targets without positions get zeros.
        let absent = targets().filter(|target| target.positions.is_none()).count();
        self.reader.spend(absent.saturating_mul(self.used()), &format!("{}.targets", self.element))?;
        let targets = targets().enumerate();
        targets.map(|(i, target)| self.morph(&format!("{}.targets[{i}]", self.element), target)).collect()
    }

    fn morph(&self, element: &str, target: &JsonTarget) -> Result<MorphTarget, Problem> {
        let read = |index: Option<Index<Accessor>>, name: &str| match index {
            Some(index) => self.positions(index, &format!("{element}.{name}")),
            None => Ok(Vec::new()),
        };
        let mut positions = read(target.positions, "POSITION")?;
        positions.resize(self.used(), Vec3::ZERO);
        Ok(MorphTarget { positions, normals: read(target.normals, "NORMAL")? })
    }
}
