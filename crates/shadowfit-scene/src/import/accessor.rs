//! Typed reads from buffers, every range checked before anything is allocated or read.

use std::cell::{Cell, RefCell};
use std::collections::HashMap;
use std::ops::Deref;
use std::rc::Rc;

use gltf::json::accessor::{Accessor, ComponentType, sparse::Sparse};
use gltf::json::validation::Checked;
use gltf::json::{Index, Root, buffer};

use super::extensions::{COMPRESSED, DECOMPRESS};
use super::uri::{Folder, MAX_FILE_BYTES, read_uri};
use crate::error::Problem;

/// Elements that one import may decode. Accessors may overlap, so the size of the file does not bound the
/// memory. 2^27 16-byte elements fit in 2 GiB. Data that several primitives share counts once.
const MAX_ELEMENTS: u64 = 1 << 27;

/// Elements of an accessor without data of its own (all zero, or sparse over zero). No buffer size bounds its
/// count.
const MAX_UNBACKED_ELEMENTS: usize = 1 << 20;

/// Conversion of integer components to floats.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Integers {
    /// By the accessor's `normalized`.
    AsDeclared,
    /// Always normalised, for attributes that must be.
    Normalized,
}

/// Reads accessors of one file.
pub(crate) struct Reader<'a> {
    root: &'a Root,
    buffers: Vec<Result<Vec<u8>, Problem>>,
    elements_left: Cell<u64>,
    /// For each accessor, whether primitives refer to it more than once.
    shared: Vec<bool>,
    /// Data of the shared sparse accessors read so far, by accessor index, with replaced elements applied.
    dense: RefCell<HashMap<usize, Rc<[u8]>>>,
}

/// Selection of an accessor's elements.
#[derive(Clone, Copy)]
pub(crate) enum Elements<'a> {
    /// All elements, in their order.
    All,
    /// Elements by index, in the order of the list. Each index is less than the accessor's count.
    Listed(&'a [u32]),
}

/// Checked location and layout of an accessor's data.
struct Layout<'a> {
    /// Bytes from the first element on, or `None` if all elements are zero.
    bytes: Option<&'a [u8]>,
    stride: usize,
    count: usize,
    component: ComponentType,
    normalized: bool,
}

/// The bytes of an accessor's elements.
enum Bytes<'a> {
    /// Bytes in their buffer.
    Plain(&'a [u8]),
    /// Assembled bytes of a sparse accessor.
    Dense(Rc<[u8]>),
}

impl Deref for Bytes<'_> {
    type Target = [u8];

    fn deref(&self) -> &[u8] {
        match self {
            Self::Plain(bytes) => bytes,
            Self::Dense(bytes) => bytes,
        }
    }
}

impl<'a> Reader<'a> {
    /// Loads the buffers. If one cannot be loaded, only reads from it fail.
    pub(crate) fn new(root: &'a Root, mut binary: Option<Vec<u8>>, folder: Folder<'_>) -> Self {
        let mut bytes_left = MAX_FILE_BYTES;
        let mut buffers = Vec::with_capacity(root.buffers.len());
        for (index, buffer) in root.buffers.iter().enumerate() {
            let loaded = load_buffer(index, buffer, &mut binary, folder, bytes_left);
            bytes_left -= loaded.as_ref().map_or(0, |bytes| bytes.len() as u64).min(bytes_left);
            buffers.push(loaded);
        }
        let elements_left = Cell::new(MAX_ELEMENTS);
        Self { root, buffers, elements_left, shared: shared(root), dense: RefCell::default() }
    }

    /// Returns the number of elements of an accessor with `components` components each. Fails if its data is
    /// missing.
    pub(crate) fn checked_count(
        &self,
        index: Index<Accessor>,
        element: &str,
        components: usize,
    ) -> Result<usize, Problem> {
        Ok(self.layout(self.accessor(index, element)?, components, &named(element, index))?.count)
    }

    /// Returns the number of elements that an accessor declares.
    pub(crate) fn count(&self, index: Index<Accessor>, element: &str) -> Result<usize, Problem> {
        let accessor = self.accessor(index, element)?;
        let too_many = |_| Problem::new(named(element, index), "its count is too large");
        usize::try_from(accessor.count.0).map_err(too_many)
    }

    /// Checks that an accessor has an element for each of `count` positions, without reading any.
    pub(crate) fn check_count(&self, index: Index<Accessor>, element: &str, count: usize) -> Result<(), Problem> {
        let has = self.count(index, element)?;
        if has == count {
            return Ok(());
        }
        Err(Problem::new(named(element, index), format!("it has {has} elements for {count} positions")))
    }

    /// Returns whether an accessor has data of its own.
    pub(crate) fn has_data(&self, index: Index<Accessor>) -> bool {
        let accessor = self.root.accessors.get(index.value());
        accessor.is_some_and(|accessor| accessor.buffer_view.is_some() || accessor.sparse.is_some())
    }

    /// Returns the number of components of an accessor's elements, 1 to 16, or 0 if its type is invalid.
    pub(crate) fn components(&self, index: Index<Accessor>) -> usize {
        match self.root.accessors.get(index.value()).map(|accessor| accessor.type_) {
            Some(Checked::Valid(kind)) => kind.multiplicity(),
            _ => 0,
        }
    }

    /// Returns all elements as floats.
    pub(crate) fn floats<const N: usize>(
        &self,
        index: Index<Accessor>,
        element: &str,
        integers: Integers,
    ) -> Result<Vec<[f32; N]>, Problem> {
        self.some_floats(index, element, integers, Elements::All)
    }

    /// Returns some elements as floats.
    pub(crate) fn some_floats<const N: usize>(
        &self,
        index: Index<Accessor>,
        element: &str,
        integers: Integers,
        elements: Elements<'_>,
    ) -> Result<Vec<[f32; N]>, Problem> {
        let always = integers == Integers::Normalized;
        let convert = |bytes: &[u8], component, normalized| float(bytes, component, normalized || always);
        self.read(index, element, elements, convert)
    }

    /// Returns some elements as unsigned integers.
    pub(crate) fn integers<const N: usize>(
        &self,
        index: Index<Accessor>,
        element: &str,
        elements: Elements<'_>,
    ) -> Result<Vec<[u32; N]>, Problem> {
        use ComponentType::{U8, U16, U32};
        let accessor = self.accessor(index, element)?;
        if !matches!(accessor.component_type, Checked::Valid(kind) if matches!(kind.0, U8 | U16 | U32)) {
            return Err(Problem::new(named(element, index), "its components are not unsigned integers"));
        }
        self.read(index, element, elements, |bytes, component, _| unsigned(bytes, component))
    }

    /// Returns the bytes of a buffer view.
    pub(crate) fn view(&self, index: Index<buffer::View>, element: &str) -> Result<&[u8], Problem> {
        let name = format!("{element}, bufferView {index}");
        let view = self.root.buffer_views.get(index.value());
        let view = view.ok_or_else(|| Problem::new(name.clone(), "there is no such buffer view"))?;
        let buffer = self.buffers.get(view.buffer.value());
        let buffer =
            buffer.ok_or_else(|| Problem::new(name.clone(), format!("its buffer {} does not exist", view.buffer)))?;
        let bytes = buffer.as_ref().map_err(Clone::clone)?;
        let offset = view.byte_offset.map_or(0, |offset| offset.0);
        range(bytes, offset, view.byte_length.0).ok_or_else(|| {
            let length = view.byte_length.0;
            let has = bytes.len();
            Problem::new(
                name,
                format!("{length} bytes from offset {offset} exceed buffer {}, which has {has}", view.buffer),
            )
        })
    }

    fn accessor(&self, index: Index<Accessor>, element: &str) -> Result<&'a Accessor, Problem> {
        let accessor = self.root.accessors.get(index.value());
        accessor.ok_or_else(|| Problem::new(named(element, index), "there is no such accessor"))
    }

    fn read<T: Copy + Default, const N: usize>(
        &self,
        index: Index<Accessor>,
        element: &str,
        elements: Elements<'_>,
        convert: impl Fn(&[u8], ComponentType, bool) -> T,
    ) -> Result<Vec<[T; N]>, Problem> {
        let name = named(element, index);
        let accessor = self.accessor(index, element)?;
        let layout = self.layout(accessor, N, &name)?;
        let count = match elements {
            Elements::All => layout.count,
            Elements::Listed(list) => list.len(),
        };
        // A sparse accessor is assembled as a whole, even to read a few of its elements.
        let is_made = accessor.sparse.is_some() && !self.dense.borrow().contains_key(&index.value());
        self.spend(if is_made { layout.count.max(count) } else { count }, &name)?;
        let size = layout.component.size();
        let data = self.data(accessor, index, &layout, size * N, &name)?;
        let Some((bytes, stride)) = data else { return Ok(vec![[T::default(); N]; count]) };
        let decode = |at: usize| -> [T; N] {
            let bytes = &bytes[at * stride..];
            std::array::from_fn(|c| convert(&bytes[c * size..], layout.component, layout.normalized))
        };
        Ok(match elements {
            Elements::All => (0..count).map(decode).collect(),
            Elements::Listed(list) => list.iter().map(|&at| decode(at as usize)).collect(),
        })
    }

    /// Returns the bytes of all elements, each of `size`, and the distance from one to the next. Returns
    /// `None` if all are zero. A sparse accessor that several primitives share is assembled once.
    fn data<'b>(
        &self,
        accessor: &Accessor,
        index: Index<Accessor>,
        layout: &Layout<'b>,
        size: usize,
        name: &str,
    ) -> Result<Option<(Bytes<'b>, usize)>, Problem> {
        let Some(sparse) = &accessor.sparse else {
            return Ok(layout.bytes.map(|bytes| (Bytes::Plain(bytes), layout.stride)));
        };
        if let Some(dense) = self.dense.borrow().get(&index.value()) {
            return Ok(Some((Bytes::Dense(Rc::clone(dense)), size)));
        }
        let mut dense = vec![0; layout.count * size];
        if let Some(bytes) = layout.bytes {
            for (element, at) in dense.chunks_exact_mut(size).zip((0..).step_by(layout.stride)) {
                element.copy_from_slice(&bytes[at..][..size]);
            }
        }
        self.overlay(sparse, &mut dense, size, name)?;
        let dense: Rc<[u8]> = dense.into();
        if self.shared[index.value()] {
            self.dense.borrow_mut().insert(index.value(), Rc::clone(&dense));
        }
        Ok(Some((Bytes::Dense(dense), size)))
    }

    fn layout(&self, accessor: &Accessor, components: usize, name: &str) -> Result<Layout<'_>, Problem> {
        let wrong = |reason: String| Problem::new(name, reason);
        let has = match accessor.type_ {
            Checked::Valid(kind) => kind.multiplicity(),
            Checked::Invalid => return Err(wrong("its type is unknown".to_owned())),
        };
        if has != components {
            return Err(wrong(format!("it has {has} components instead of {components}")));
        }
        let Checked::Valid(component) = accessor.component_type else {
            return Err(wrong("its component type is unknown".to_owned()));
        };
        let component = component.0;
        let size = component.size() * components;
        let count = usize::try_from(accessor.count.0).unwrap_or(usize::MAX);
        let normalized = accessor.normalized;
        let Some(view) = accessor.buffer_view else {
            if count > MAX_UNBACKED_ELEMENTS {
                return Err(wrong(format!("it declares {count} elements and has no data for them")));
            }
            return Ok(Layout { bytes: None, stride: size, count, component, normalized });
        };
        let bytes = self.view(view, name)?;
        let declared = self.root.buffer_views[view.value()].byte_stride;
        // Some exporters write 0 for elements without gaps.
        let stride = declared.map(|stride| stride.0).filter(|&stride| stride > 0).unwrap_or(size);
        if stride < size {
            return Err(wrong(format!("its stride of {stride} bytes is smaller than its elements of {size}")));
        }
        let offset = accessor.byte_offset.map_or(0, |offset| offset.0);
        let needed = (count as u128).saturating_sub(1) * stride as u128 + size as u128;
        let needed = if count == 0 { 0 } else { needed };
        let length = u64::try_from(needed).unwrap_or(u64::MAX);
        let bytes = range(bytes, offset, length).ok_or_else(|| {
            wrong(format!(
                "its {count} elements need {needed} bytes from offset {offset}, buffer view {view} has {}",
                bytes.len()
            ))
        })?;
        Ok(Layout { bytes: Some(bytes), stride, count, component, normalized })
    }

    /// Applies the replacements of a sparse accessor to elements of `size` bytes.
    fn overlay(&self, sparse: &Sparse, dense: &mut [u8], size: usize, name: &str) -> Result<(), Problem> {
        let name = format!("{name}, sparse");
        let wrong = |reason: &str| Problem::new(name.clone(), reason);
        let Checked::Valid(component) = sparse.indices.component_type else {
            return Err(wrong("the component type of its indices is unknown"));
        };
        let component = component.0;
        let count = sparse.count.0;
        if count > (dense.len() / size) as u64 {
            return Err(wrong("it replaces more elements than there are"));
        }
        let part = |view, offset: u64, size: usize| -> Result<&[u8], Problem> {
            let bytes = self.view(view, &name)?;
            range(bytes, offset, count * size as u64).ok_or_else(|| wrong("it exceeds its buffer view"))
        };
        let indices = part(sparse.indices.buffer_view, sparse.indices.byte_offset.0, component.size())?;
        let replacements = part(sparse.values.buffer_view, sparse.values.byte_offset.0, size)?;
        let indices = indices.chunks_exact(component.size());
        for (index, replacement) in indices.zip(replacements.chunks_exact(size)) {
            let index = unsigned(index, component) as usize;
            let element = dense.chunks_exact_mut(size).nth(index);
            element.ok_or_else(|| wrong("one of its indices is out of range"))?.copy_from_slice(replacement);
        }
        Ok(())
    }

    /// Counts elements that are decoded or copied. Fails if an import exceeds [`MAX_ELEMENTS`].
    pub(crate) fn spend(&self, count: usize, name: &str) -> Result<(), Problem> {
        let left = self.elements_left.get().checked_sub(count as u64).ok_or_else(|| {
            Problem::new(name, format!("the file decodes to more than {MAX_ELEMENTS} elements"))
                .hint("Split or simplify the scene")
        })?;
        self.elements_left.set(left);
        Ok(())
    }
}

/// Returns whether primitives refer to each accessor more than once.
fn shared(root: &Root) -> Vec<bool> {
    let mut uses = vec![0_u32; root.accessors.len()];
    for primitive in root.meshes.iter().flat_map(|mesh| &mesh.primitives) {
        let targets = primitive.targets.iter().flatten();
        let targets = targets.flat_map(|target| [target.positions, target.normals]).flatten();
        for index in primitive.attributes.values().copied().chain(primitive.indices).chain(targets) {
            if let Some(uses) = uses.get_mut(index.value()) {
                *uses += 1;
            }
        }
    }
    uses.into_iter().map(|uses| uses > 1).collect()
}

fn load_buffer(
    index: usize,
    buffer: &buffer::Buffer,
    binary: &mut Option<Vec<u8>>,
    folder: Folder<'_>,
    max_bytes: u64,
) -> Result<Vec<u8>, Problem> {
    const HINT: &str = "Keep the files that belong to the scene beside it, as they were exported";
    let wrong = |reason: String| Problem::new(format!("buffers[{index}]"), reason);
    let bytes = match &buffer.uri {
        Some(uri) => read_uri(folder, uri, max_bytes).map_err(|reason| wrong(reason).hint(HINT))?,
        None => binary.take().ok_or_else(|| {
            let problem = wrong("it has neither a URI nor a binary chunk".to_owned());
            let is_compressed = |name| buffer.extensions.as_ref().is_some_and(|own| own.others.contains_key(name));
            if COMPRESSED.into_iter().any(is_compressed) { problem.hint(DECOMPRESS) } else { problem }
        })?,
    };
    let claimed = buffer.byte_length.0;
    if claimed > bytes.len() as u64 {
        let reason = format!("it claims {claimed} bytes, its data has {}", bytes.len());
        return Err(wrong(reason).hint(HINT));
    }
    Ok(bytes)
}

/// Returns `bytes[offset..offset + length]`, or `None` if out of range.
fn range(bytes: &[u8], offset: u64, length: u64) -> Option<&[u8]> {
    let start = usize::try_from(offset).ok()?;
    let end = usize::try_from(offset.checked_add(length)?).ok()?;
    bytes.get(start..end)
}

fn named(element: &str, index: Index<Accessor>) -> String {
    format!("{element}, accessor {index}")
}

fn float(bytes: &[u8], component: ComponentType, normalized: bool) -> f32 {
    let (value, greatest) = match component {
        ComponentType::F32 => return f32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]),
        ComponentType::I8 => (f32::from(bytes[0].cast_signed()), 127.0),
        ComponentType::U8 => (f32::from(bytes[0]), 255.0),
        ComponentType::I16 => (f32::from(i16::from_le_bytes([bytes[0], bytes[1]])), 32_767.0),
        ComponentType::U16 => (f32::from(u16::from_le_bytes([bytes[0], bytes[1]])), 65_535.0),
        ComponentType::U32 => return unsigned(bytes, component) as f32,
    };
    if normalized { (value / greatest).max(-1.0) } else { value }
}

/// Returns a component as an unsigned integer. The caller has checked that its type is unsigned.
fn unsigned(bytes: &[u8], component: ComponentType) -> u32 {
    match component.size() {
        1 => u32::from(bytes[0]),
        2 => u32::from(u16::from_le_bytes([bytes[0], bytes[1]])),
        _ => u32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]),
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use gltf::json::deserialize;

    use super::*;

    #[test]
    fn a_sparse_accessor_counts_once_and_is_kept_only_where_primitives_share_it() {
        let sparse = r#"{"componentType":5126,"type":"VEC3","count":100,"sparse":{"count":0,
            "indices":{"bufferView":0,"componentType":5121},"values":{"bufferView":0}}}"#;
        let json = format!(
            r#"{{"asset":{{"version":"2.0"}},"buffers":[{{"byteLength":4,"uri":"data:;base64,AAAAAA=="}}],
            "bufferViews":[{{"buffer":0,"byteLength":4}}],"accessors":[{sparse},{sparse}],
            "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0,"NORMAL":1}}}},{{"attributes":{{"POSITION":1}}}}]}}]}}"#
        );
        let root: Root = deserialize::from_str(&json).unwrap();
        let files = BTreeMap::new();
        for (accessor, costs) in [(0, [100, 100, 100]), (1, [100, 1, 100])] {
            let reader = Reader::new(&root, None, Folder::Memory(&files));
            for (elements, cost) in [Elements::All, Elements::Listed(&[7]), Elements::All].into_iter().zip(costs) {
                let before = reader.elements_left.get();
                reader.some_floats::<3>(Index::new(accessor), "a", Integers::AsDeclared, elements).unwrap();
                assert_eq!(before - reader.elements_left.get(), cost, "accessor {accessor}");
            }
            assert_eq!(reader.dense.borrow().len(), accessor as usize);
        }
    }
}
