//! Accessors: typed views of buffers. Every range is checked before a byte is read.

use std::borrow::Cow;
use std::cell::Cell;

use gltf::json::accessor::{Accessor, ComponentType, GenericComponentType, Type};
use gltf::json::validation::Checked;
use gltf::json::{Index, Root, buffer};

use super::error::Refusal;
use super::limits::{MAX_ACCESSOR_COUNT, MAX_ENTRIES_READ};

/// A document with the bytes of its buffers.
pub(super) struct Source<'a> {
    pub root: &'a Root,
    pub buffers: &'a [Cow<'a, [u8]>],
    /// How many entries have been read so far.
    pub entries_read: Cell<u64>,
}

/// How one run of elements lies in its bytes. Invariant: `bytes` holds `count` elements.
struct Layout<'a> {
    bytes: &'a [u8],
    stride: usize,
    component: ComponentType,
    normalized: bool,
}

impl Layout<'_> {
    /// Component `c` of element `i` as a number; normalised integers as shares (specification, 3.6.2.2).
    fn float(&self, i: usize, c: usize) -> f32 {
        let at = i * self.stride + c * self.component.size();
        let b = |k: usize| self.bytes[at + k];
        let (value, greatest) = match self.component {
            ComponentType::F32 => return f32::from_le_bytes([b(0), b(1), b(2), b(3)]),
            ComponentType::I8 => (f32::from(b(0) as i8), 127.0),
            ComponentType::U8 => (f32::from(b(0)), 255.0),
            ComponentType::I16 => (f32::from(i16::from_le_bytes([b(0), b(1)])), 32_767.0),
            ComponentType::U16 => (f32::from(u16::from_le_bytes([b(0), b(1)])), 65_535.0),
            ComponentType::U32 => (u32::from_le_bytes([b(0), b(1), b(2), b(3)]) as f32, 4_294_967_295.0),
        };
        if self.normalized { (value / greatest).max(-1.0) } else { value }
    }

    /// Element `i` as an index; `None` for types that indices cannot have.
    fn index(&self, i: usize) -> Option<u32> {
        let b = |k: usize| self.bytes[i * self.stride + k];
        match self.component {
            ComponentType::U8 => Some(u32::from(b(0))),
            ComponentType::U16 => Some(u32::from(u16::from_le_bytes([b(0), b(1)]))),
            ComponentType::U32 => Some(u32::from_le_bytes([b(0), b(1), b(2), b(3)])),
            _ => None,
        }
    }
}

impl<'a> Source<'a> {
    /// The bytes of a buffer view.
    pub fn view(&self, index: Index<buffer::View>) -> Result<&'a [u8], Refusal> {
        let place = format!("bufferViews[{}]", index.value());
        let view = self.root.get(index).ok_or_else(|| Refusal::at(&place, "is missing"))?;
        let bytes = self.buffers.get(view.buffer.value()).ok_or_else(|| Refusal::at(&place, "has no buffer"))?;
        let range = usize::try_from(view.byte_offset.unwrap_or_default().0).ok().and_then(|start| {
            let end = start.checked_add(usize::try_from(view.byte_length.0).ok()?)?;
            bytes.get(start..end)
        });
        range.ok_or_else(|| Refusal::at(place, format!("reaches past the {} bytes of its buffer", bytes.len())))
    }

    /// Vectors of `N` components, or of `N + 1` of which the last is left out where `or_longer` is set.
    pub fn floats<const N: usize>(
        &self,
        index: Index<Accessor>,
        or_longer: bool,
        user: &str,
    ) -> Result<Vec<[f32; N]>, Refusal> {
        let (accessor, component, width) = self.accessor(index, user)?;
        if width != N && !(or_longer && width == N + 1) {
            return Err(Refusal::at(user, format!("has {width} components in each entry, not {N}")));
        }
        let count = accessor.count.0 as usize;
        let mut out = vec![[0.0; N]; count];
        if let Some(base) = self.base(accessor, component, width, user)? {
            for (i, entry) in out.iter_mut().enumerate() {
                *entry = std::array::from_fn(|c| base.float(i, c));
            }
        }
        if let Some(overlay) = self.overlay(accessor, component, width, user)? {
            for (i, target) in overlay.targets.into_iter().enumerate() {
                out[target] = std::array::from_fn(|c| overlay.values.float(i, c));
            }
        }
        Ok(out)
    }

    /// Vertex numbers.
    pub fn indices(&self, index: Index<Accessor>, user: &str) -> Result<Vec<u32>, Refusal> {
        let (accessor, component, width) = self.accessor(index, user)?;
        if width != 1 || !matches!(component, ComponentType::U8 | ComponentType::U16 | ComponentType::U32) {
            return Err(Refusal::at(user, "are not unsigned whole numbers"));
        }
        let mut out = vec![0; accessor.count.0 as usize];
        if let Some(base) = self.base(accessor, component, width, user)? {
            for (i, entry) in out.iter_mut().enumerate() {
                *entry = base.index(i).unwrap_or(0);
            }
        }
        if let Some(overlay) = self.overlay(accessor, component, width, user)? {
            for (i, target) in overlay.targets.into_iter().enumerate() {
                out[target] = overlay.values.index(i).unwrap_or(0);
            }
        }
        Ok(out)
    }

    /// The accessor with its component type and its number of components; its count is within limits.
    fn accessor(&self, index: Index<Accessor>, user: &str) -> Result<(&'a Accessor, ComponentType, usize), Refusal> {
        let wrong = |reason: &str| Refusal::at(user, reason);
        let accessor = self.root.get(index).ok_or_else(|| wrong("names an accessor that is missing"))?;
        let Checked::Valid(GenericComponentType(component)) = accessor.component_type else {
            return Err(wrong("has an unknown component type"));
        };
        let Checked::Valid(dimensions) = accessor.type_ else {
            return Err(wrong("has an unknown type"));
        };
        if matches!(dimensions, Type::Mat2 | Type::Mat3 | Type::Mat4) {
            return Err(wrong("is made of matrices"));
        }
        if accessor.count.0 == 0 || accessor.count.0 > MAX_ACCESSOR_COUNT as u64 {
            let count = accessor.count.0;
            return Err(Refusal::at(user, format!("has {count} entries; 1 to {MAX_ACCESSOR_COUNT} are allowed")));
        }
        // An accessor without bytes costs its author nothing, so it must not make us allocate much.
        if accessor.buffer_view.is_none() && accessor.sparse.is_none() {
            return Err(wrong("has no data"));
        }
        self.entries_read.set(self.entries_read.get() + accessor.count.0);
        if self.entries_read.get() > MAX_ENTRIES_READ {
            return Err(Refusal::at(user, format!("makes more than {MAX_ENTRIES_READ} entries to read")));
        }
        Ok((accessor, component, dimensions.multiplicity()))
    }

    /// The dense data; `None` where the accessor starts from zeros.
    fn base(
        &self,
        accessor: &Accessor,
        component: ComponentType,
        width: usize,
        user: &str,
    ) -> Result<Option<Layout<'a>>, Refusal> {
        let Some(view) = accessor.buffer_view else { return Ok(None) };
        let offset = accessor.byte_offset.unwrap_or_default().0;
        let mut layout = self.layout(view, offset, accessor.count.0, component, width, user)?;
        layout.normalized = accessor.normalized;
        Ok(Some(layout))
    }

    /// The entries that a sparse accessor replaces.
    fn overlay(
        &self,
        accessor: &Accessor,
        component: ComponentType,
        width: usize,
        user: &str,
    ) -> Result<Option<Overlay<'a>>, Refusal> {
        let Some(sparse) = &accessor.sparse else { return Ok(None) };
        let user = format!("{user}.sparse");
        let count = sparse.count.0;
        if count == 0 || count > accessor.count.0 {
            return Err(Refusal::at(user, format!("replaces {count} of {} entries", accessor.count.0)));
        }
        let Checked::Valid(gltf::json::accessor::IndexComponentType(index_type)) = sparse.indices.component_type else {
            return Err(Refusal::at(user, "has indices of an unknown type"));
        };
        let indices =
            self.layout(sparse.indices.buffer_view, sparse.indices.byte_offset.0, count, index_type, 1, &user)?;
        let mut values =
            self.layout(sparse.values.buffer_view, sparse.values.byte_offset.0, count, component, width, &user)?;
        values.normalized = accessor.normalized;
        let mut targets = Vec::with_capacity(count as usize);
        for i in 0..count as usize {
            match indices.index(i) {
                Some(target) if u64::from(target) < accessor.count.0 => targets.push(target as usize),
                _ => return Err(Refusal::at(user, format!("replaces an entry that is missing, by index {i}"))),
            }
        }
        Ok(Some(Overlay { targets, values }))
    }

    fn layout(
        &self,
        view: Index<buffer::View>,
        offset: u64,
        count: u64,
        component: ComponentType,
        width: usize,
        user: &str,
    ) -> Result<Layout<'a>, Refusal> {
        let all = self.view(view)?;
        let size = component.size() * width;
        let stride = self.root.get(view).and_then(|v| v.byte_stride).map_or(size, |stride| stride.0);
        if stride < size {
            return Err(Refusal::at(user, format!("has a stride of {stride} bytes for entries of {size}")));
        }
        // Cannot overflow: counts and strides are bounded. The offset is the file's own, so it can.
        let needed = (count - 1) * stride as u64 + size as u64;
        let range = usize::try_from(offset).ok().and_then(|start| {
            let end = start.checked_add(usize::try_from(needed).ok()?)?;
            all.get(start..end)
        });
        let bytes = range.ok_or_else(|| {
            let reason = format!("needs {needed} bytes from byte {offset}, but its view has {}", all.len());
            Refusal::at(user, reason)
        })?;
        Ok(Layout { bytes, stride, component, normalized: false })
    }
}

/// What a sparse accessor puts over its base. Invariant: each target is an entry of the accessor.
struct Overlay<'a> {
    targets: Vec<usize>,
    values: Layout<'a>,
}
