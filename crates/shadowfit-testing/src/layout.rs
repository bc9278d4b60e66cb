//! Compares the layout of Rust structs (size and offsets of all fields by name) with naga's reflection of the
//! WGSL.

use naga::{Binding, Module, StructMember, TypeInner};

/// A Rust struct: its name in WGSL, its size, and its fields' names and offsets, in bytes.
#[derive(Debug)]
pub struct Layout {
    /// Name in WGSL.
    pub wgsl: &'static str,
    /// Size, in bytes.
    pub size: usize,
    /// Names and offsets of the fields, in bytes.
    pub fields: Vec<(&'static str, usize)>,
}

/// Returns the [`Layout`](crate::layout::Layout) of a struct. A list that lacks a field does not compile.
#[macro_export]
macro_rules! layout {
    ($wgsl:literal = $rust:ident { $($field:ident),+ $(,)? }) => {{
        // A pattern without `..` has to name every field.
        let _ = |value: $rust| { let $rust { $($field: _),+ } = value; };
        $crate::layout::Layout {
            wgsl: $wgsl,
            size: ::core::mem::size_of::<$rust>(),
            fields: vec![$((stringify!($field), ::core::mem::offset_of!($rust, $field))),+],
        }
    }};
}

/// Returns the members and the size of a struct of a module.
///
/// # Panics
///
/// If the module has no such struct.
pub fn reflected<'a>(module: &'a Module, name: &str) -> (&'a [StructMember], u32) {
    let found = module.types.iter().find(|(_, ty)| ty.name.as_deref() == Some(name));
    let Some((_, ty)) = found else { panic!("no type `{name}`") };
    let TypeInner::Struct { members, span } = &ty.inner else { panic!("`{name}` is not a struct") };
    (members, *span)
}

/// Compares a struct with the reflection of a module that reads it. The Rust struct may end with padding
/// fields that are unnamed in WGSL.
///
/// # Panics
///
/// If they differ.
pub fn assert_same(module: &Module, layout: &Layout) {
    let Layout { wgsl, size, fields } = layout;
    let (members, span) = reflected(module, wgsl);
    assert_eq!(*size, span as usize, "size of {wgsl}");
    let reflected: Vec<(&str, usize)> =
        members.iter().map(|member| (member.name.as_deref().unwrap_or(""), member.offset as usize)).collect();
    let (named, unnamed) = fields.split_at(reflected.len().min(fields.len()));
    assert_eq!(named, reflected, "fields of {wgsl}");
    assert!(unnamed.iter().all(|(name, _)| name.starts_with("padding")), "{wgsl} lacks {unnamed:?}");
}

/// Returns the members of a vertex shader's input at the given locations of vertex buffers, in that order.
///
/// # Panics
///
/// If the input lacks a location.
pub fn at_locations<'a>(module: &'a Module, input: &str, locations: &[u32]) -> Vec<&'a StructMember> {
    let (members, _) = reflected(module, input);
    let at = |wanted: u32| {
        let is_it = |member: &&StructMember| matches!(member.binding, Some(Binding::Location { location, .. }) if location == wanted);
        members.iter().find(is_it).unwrap_or_else(|| panic!("{input} has no location {wanted}"))
    };
    locations.iter().map(|location| at(*location)).collect()
}

/// Returns the offsets of packed attributes and the end of the last one, in bytes.
pub fn packed(module: &Module, members: &[&StructMember]) -> Vec<usize> {
    let mut offsets = vec![0];
    for member in members {
        let size = module.types[member.ty].inner.size(module.to_ctx()) as usize;
        offsets.push(offsets[offsets.len() - 1] + size);
    }
    offsets
}
