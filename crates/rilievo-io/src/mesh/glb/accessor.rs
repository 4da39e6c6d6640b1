//! Numbers out of glTF accessors, every index and offset checked.

use gltf::json::accessor::{Accessor, ComponentType, Type};
use gltf::json::validation::Checked;
use gltf::json::{Index, Root, buffer};

use super::super::assemble::Assembly;
use super::buffers::Buffers;
use crate::Result;

/// What an accessor must be to be read as a certain thing.
pub(super) struct Shape {
    /// What it is read as, for messages.
    pub(super) what: &'static str,
    pub(super) kind: Type,
    /// Component types, each with whether it must be normalised.
    pub(super) components: &'static [(ComponentType, bool)],
}

pub(super) const POSITION: Shape =
    Shape { what: "POSITION", kind: Type::Vec3, components: &[(ComponentType::F32, false)] };
pub(super) const NORMAL: Shape = Shape { what: "NORMAL", kind: Type::Vec3, components: &[(ComponentType::F32, false)] };
pub(super) const TEXCOORD: Shape = Shape {
    what: "TEXCOORD_0",
    kind: Type::Vec2,
    components: &[(ComponentType::F32, false), (ComponentType::U8, true), (ComponentType::U16, true)],
};
pub(super) const INDICES: Shape = Shape {
    what: "indices",
    kind: Type::Scalar,
    components: &[(ComponentType::U8, false), (ComponentType::U16, false), (ComponentType::U32, false)],
};

/// Reads accessors of one file.
pub(super) struct Reader<'r, 'b> {
    pub(super) root: &'r Root,
    pub(super) buffers: &'r Buffers<'b>,
}

impl Reader<'_, '_> {
    /// The accessor's numbers as `N` floats each.
    pub(super) fn floats<const N: usize>(
        &self,
        index: Index<Accessor>,
        shape: &Shape,
        assembly: &Assembly<'_>,
    ) -> Result<Vec<[f32; N]>> {
        let at = |reason| assembly.damage(format!("accessor {}", index.value()), reason);
        self.read(index, shape, [0.0; N], assembly, |bytes, component| {
            let mut item = [0.0; N];
            for (value, bytes) in item.iter_mut().zip(bytes.chunks(size(component))) {
                *value = match component {
                    ComponentType::U8 => f32::from(bytes[0]) / 255.0,
                    ComponentType::U16 => f32::from(u16::from_le_bytes([bytes[0], bytes[1]])) / 65535.0,
                    _ => f32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]),
                };
            }
            item
        })
        .map_err(at)
    }

    /// The accessor's numbers as indices, each below `len`.
    pub(super) fn indices(&self, index: Index<Accessor>, len: usize, assembly: &Assembly<'_>) -> Result<Vec<u32>> {
        let at = |reason| assembly.damage(format!("accessor {}", index.value()), reason);
        let indices = self.read(index, &INDICES, 0, assembly, unsigned).map_err(at)?;
        match indices.iter().position(|&i| i as usize >= len) {
            None => Ok(indices),
            Some(k) => Err(at(format!("index {k} is {}, but there are {len} vertices", indices[k]))),
        }
    }

    fn read<T: Copy>(
        &self,
        index: Index<Accessor>,
        shape: &Shape,
        zero: T,
        assembly: &Assembly<'_>,
        parse: impl Fn(&[u8], ComponentType) -> T,
    ) -> Result<Vec<T>, String> {
        let what = shape.what;
        let accessor = self.root.get(index).ok_or("it does not exist")?;
        let (Checked::Valid(component), Checked::Valid(kind)) = (accessor.component_type, accessor.type_) else {
            return Err("its type is unknown".into());
        };
        if kind != shape.kind || !shape.components.contains(&(component.0, accessor.normalized)) {
            let normalized = if accessor.normalized { "normalised " } else { "" };
            return Err(format!("{what} cannot be {normalized}{:?} of {:?}", kind, component.0));
        }
        // Indices may be three for each triangle that is allowed; all else is one for each vertex.
        let limits = assembly.limits;
        let most = limits.max_triangles.saturating_mul(3).max(limits.max_vertices) as u64;
        let count = accessor.count.0;
        if count == 0 || count > most {
            return Err(format!("a count of {count}; between 1 and {most} are accepted"));
        }
        let count = count as usize;
        let item = size(component.0) * kind.multiplicity();
        let offset = accessor.byte_offset.map_or(0, |offset| offset.0);
        let mut values = match (accessor.buffer_view, &accessor.sparse) {
            (Some(view), _) => {
                self.items(view, offset, count, item)?.map(|bytes| parse(bytes, component.0)).collect::<Vec<_>>()
            }
            // All zeros, except for what the sparse part sets.
            (None, Some(_)) if count <= limits.max_vertices => vec![zero; count],
            _ => return Err("it has no buffer view, so all its values are zero".into()),
        };
        if let Some(sparse) = &accessor.sparse {
            let Checked::Valid(index_component) = sparse.indices.component_type else {
                return Err("the type of its sparse indices is unknown".into());
            };
            let changed = usize::try_from(sparse.count.0).ok().filter(|&n| n <= count);
            let changed = changed.ok_or("more sparse values than values")?;
            let (at, offset) = (sparse.indices.buffer_view, sparse.indices.byte_offset.0);
            let places = self.items(at, offset, changed, size(index_component.0))?;
            let (at, offset) = (sparse.values.buffer_view, sparse.values.byte_offset.0);
            let new = self.items(at, offset, changed, item)?;
            for (place, bytes) in places.zip(new) {
                let place = unsigned(place, index_component.0) as usize;
                *values.get_mut(place).ok_or("a sparse index beyond its count")? = parse(bytes, component.0);
            }
        }
        Ok(values)
    }

    /// `count` items of `item` bytes each, from `offset` in a view on, by the view's stride.
    fn items(
        &self,
        view: Index<buffer::View>,
        offset: u64,
        count: usize,
        item: usize,
    ) -> Result<impl Iterator<Item = &[u8]>, String> {
        let number = view.value();
        let view = self.root.get(view).ok_or_else(|| format!("its buffer view {number} does not exist"))?;
        let buffer = self.buffers.get(view.buffer.value());
        let buffer = buffer.ok_or_else(|| format!("the buffer of view {number} does not exist"))?;
        let begin = view.byte_offset.map_or(0, |offset| offset.0);
        let range = begin.checked_add(view.byte_length.0).filter(|&end| end <= buffer.len() as u64);
        let end = range.ok_or_else(|| format!("its buffer view {number} is longer than the buffer"))?;
        let bytes = &buffer[begin as usize..end as usize];
        let stride = view.byte_stride.map_or(item, |stride| stride.0);
        if stride < item {
            return Err(format!("the stride of {stride} bytes of view {number} is shorter than its items"));
        }
        // Offset + stride (count − 1) + item ≤ length, without overflow.
        let last = (count as u128).saturating_sub(1) * stride as u128 + u128::from(offset) + item as u128;
        if count > 0 && last > bytes.len() as u128 {
            let length = bytes.len();
            return Err(format!("it needs {last} bytes of view {number}, which has {length}"));
        }
        let bytes = bytes.get(offset as usize..).unwrap_or_default();
        Ok((0..count).map(move |k| &bytes[k * stride..][..item]))
    }
}

fn unsigned(bytes: &[u8], component: ComponentType) -> u32 {
    match component {
        ComponentType::U8 => u32::from(bytes[0]),
        ComponentType::U16 => u32::from(u16::from_le_bytes([bytes[0], bytes[1]])),
        _ => u32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]),
    }
}

fn size(component: ComponentType) -> usize {
    match component {
        ComponentType::I8 | ComponentType::U8 => 1,
        ComponentType::I16 | ComponentType::U16 => 2,
        ComponentType::U32 | ComponentType::F32 => 4,
    }
}
