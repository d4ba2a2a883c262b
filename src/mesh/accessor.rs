//! Accessors: typed views of buffers. Every range is checked before a byte is read.

use std::borrow::Cow;
use std::cell::Cell;

use super::error::LoadRefusal;
use super::limits::{MAX_ACCESSOR_COUNT, MAX_ENTRIES_READ};
use super::schema::{Accessor, Root, Whole};

/// The type of one number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ComponentType {
    I8,
    U8,
    I16,
    U16,
    U32,
    F32,
}

impl ComponentType {
    /// The component type with this code in files.
    pub fn of(code: Whole) -> Option<Self> {
        Some(match code.0 {
            5120 => Self::I8,
            5121 => Self::U8,
            5122 => Self::I16,
            5123 => Self::U16,
            5125 => Self::U32,
            5126 => Self::F32,
            _ => return None,
        })
    }

    /// Whether indices may have this type.
    pub fn is_index(self) -> bool {
        matches!(self, Self::U8 | Self::U16 | Self::U32)
    }

    fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::U32 | Self::F32 => 4,
        }
    }
}

/// The number of components of an entry. Matrices differ from vectors: their columns may be padded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ElementShape {
    Vector(usize),
    Matrix(usize),
}

impl ElementShape {
    /// The type with this name in files.
    pub fn of(name: &str) -> Option<Self> {
        Some(match name {
            "SCALAR" => Self::Vector(1),
            "VEC2" => Self::Vector(2),
            "VEC3" => Self::Vector(3),
            "VEC4" => Self::Vector(4),
            "MAT2" => Self::Matrix(4),
            "MAT3" => Self::Matrix(9),
            "MAT4" => Self::Matrix(16),
            _ => return None,
        })
    }
}

/// A document with the bytes of its buffers.
pub(super) struct Source<'a> {
    pub root: &'a Root,
    pub buffers: &'a [Cow<'a, [u8]>],
    /// Entries read so far, for the limit.
    pub entries_read: Cell<u64>,
}

/// The memory layout of a run of elements. Invariant: `bytes` holds `count` elements.
struct Layout<'a> {
    bytes: &'a [u8],
    stride: usize,
    component: ComponentType,
    normalized: bool,
}

impl Layout<'_> {
    /// Component `c` of element `i` as a number; integers are normalized (specification, 3.6.2.2).
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
    pub fn view(&self, index: Whole) -> Result<&'a [u8], LoadRefusal> {
        let place = format!("bufferViews[{}]", index.0);
        let view = self.root.buffer_views.get(index.index()).ok_or_else(|| LoadRefusal::at(&place, "is missing"))?;
        let bytes = self.buffers.get(view.buffer.index()).ok_or_else(|| LoadRefusal::at(&place, "has no buffer"))?;
        let range = usize::try_from(view.byte_offset.0).ok().and_then(|start| {
            let end = start.checked_add(usize::try_from(view.byte_length.0).ok()?)?;
            bytes.get(start..end)
        });
        range.ok_or_else(|| LoadRefusal::at(place, format!("reaches past the {} bytes of its buffer", bytes.len())))
    }

    /// Vectors of `N` components, or of fewer, down to `least`; missing components become 1.
    pub fn floats<const N: usize>(&self, index: Whole, least: usize, user: &str) -> Result<Vec<[f32; N]>, LoadRefusal> {
        let (accessor, component, shape) = self.accessor(index, user)?;
        let width = match shape {
            ElementShape::Matrix(_) => return Err(LoadRefusal::at(user, "is made of matrices")),
            ElementShape::Vector(width) if width > N || width < least => {
                return Err(LoadRefusal::at(user, format!("has {width} components in each entry, not {N}")));
            }
            ElementShape::Vector(width) => width,
        };
        self.entries(accessor, component, width, user)
    }

    /// Matrices of 4 × 4, column by column.
    pub fn matrices(&self, index: Whole, user: &str) -> Result<Vec<[f32; 16]>, LoadRefusal> {
        match self.accessor(index, user)? {
            (accessor, component @ ComponentType::F32, ElementShape::Matrix(16)) => {
                self.entries(accessor, component, 16, user)
            }
            _ => Err(LoadRefusal::at(user, "is not made of 4 × 4 matrices of floats")),
        }
    }

    fn entries<const N: usize>(
        &self,
        accessor: &'a Accessor,
        component: ComponentType,
        width: usize,
        user: &str,
    ) -> Result<Vec<[f32; N]>, LoadRefusal> {
        let read =
            |layout: &Layout<'_>, i: usize| std::array::from_fn(|c| if c < width { layout.float(i, c) } else { 1.0 });
        let base = self.base(accessor, component, width, user)?;
        // An accessor without data of its own holds zeros.
        let zero = std::array::from_fn(|c| if c < width { 0.0 } else { 1.0 });
        let mut out = vec![zero; accessor.count.0 as usize];
        if let Some(base) = base {
            for (i, entry) in out.iter_mut().enumerate() {
                *entry = read(&base, i);
            }
        }
        if let Some(overlay) = self.overlay(accessor, component, width, user)? {
            for (i, target) in overlay.targets.into_iter().enumerate() {
                out[target] = read(&overlay.values, i);
            }
        }
        Ok(out)
    }

    /// The entry count that the accessor states.
    pub fn count(&self, index: Whole) -> u64 {
        self.root.accessors.get(index.index()).map_or(0, |accessor| accessor.count.0)
    }

    /// Whether all entries are zero because the accessor has no data.
    pub fn is_zero(&self, index: Whole) -> bool {
        let accessor = self.root.accessors.get(index.index());
        accessor.is_some_and(|accessor| accessor.buffer_view.is_none() && accessor.sparse.is_none())
    }

    /// Vertex indices.
    pub fn indices(&self, index: Whole, user: &str) -> Result<Vec<u32>, LoadRefusal> {
        let (accessor, component, shape) = self.accessor(index, user)?;
        if shape != ElementShape::Vector(1) || !component.is_index() {
            return Err(LoadRefusal::at(user, "are not unsigned whole numbers"));
        }
        if self.is_zero(index) {
            return Err(LoadRefusal::at(user, "have no data"));
        }
        let mut out = vec![0; accessor.count.0 as usize];
        if let Some(base) = self.base(accessor, component, 1, user)? {
            for (i, entry) in out.iter_mut().enumerate() {
                *entry = base.index(i).unwrap_or(0);
            }
        }
        if let Some(overlay) = self.overlay(accessor, component, 1, user)? {
            for (i, target) in overlay.targets.into_iter().enumerate() {
                out[target] = overlay.values.index(i).unwrap_or(0);
            }
        }
        Ok(out)
    }

    /// The accessor with its component type and element type; its count is within limits.
    fn accessor(&self, index: Whole, user: &str) -> Result<(&'a Accessor, ComponentType, ElementShape), LoadRefusal> {
        let wrong = |reason: &str| LoadRefusal::at(user, reason);
        let missing = || wrong("names an accessor that is missing");
        let accessor = self.root.accessors.get(index.index()).ok_or_else(missing)?;
        let component =
            ComponentType::of(accessor.component_type).ok_or_else(|| wrong("has an unknown component type"))?;
        let shape = ElementShape::of(&accessor.kind).ok_or_else(|| wrong("has an unknown type"))?;
        if accessor.count.0 == 0 || accessor.count.0 > MAX_ACCESSOR_COUNT as u64 {
            let count = accessor.count.0;
            return Err(LoadRefusal::at(user, format!("has {count} entries; 1 to {MAX_ACCESSOR_COUNT} are allowed")));
        }
        self.charge(accessor.count.0, user)?;
        Ok((accessor, component, shape))
    }

    /// Counts entries that are read or generated against the limit. A file may request the same ones again and again.
    pub fn charge(&self, entries: u64, user: &str) -> Result<(), LoadRefusal> {
        self.entries_read.set(self.entries_read.get().saturating_add(entries));
        if self.entries_read.get() > MAX_ENTRIES_READ {
            return Err(LoadRefusal::at(user, format!("makes more than {MAX_ENTRIES_READ} entries to read")));
        }
        Ok(())
    }

    /// The dense data; `None` if the accessor starts from zeros.
    fn base(
        &self,
        accessor: &Accessor,
        component: ComponentType,
        width: usize,
        user: &str,
    ) -> Result<Option<Layout<'a>>, LoadRefusal> {
        let Some(view) = accessor.buffer_view else { return Ok(None) };
        let offset = accessor.byte_offset.0;
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
    ) -> Result<Option<Overlay<'a>>, LoadRefusal> {
        let Some(sparse) = &accessor.sparse else { return Ok(None) };
        let user = format!("{user}.sparse");
        let count = sparse.count.0;
        if count == 0 || count > accessor.count.0 {
            return Err(LoadRefusal::at(user, format!("replaces {count} of {} entries", accessor.count.0)));
        }
        let Some(index_type) = ComponentType::of(sparse.indices.component_type).filter(|c| c.is_index()) else {
            return Err(LoadRefusal::at(user, "has indices of an unknown type"));
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
                _ => return Err(LoadRefusal::at(user, format!("replaces an entry that is missing, by index {i}"))),
            }
        }
        Ok(Some(Overlay { targets, values }))
    }

    fn layout(
        &self,
        view: Whole,
        offset: u64,
        count: u64,
        component: ComponentType,
        width: usize,
        user: &str,
    ) -> Result<Layout<'a>, LoadRefusal> {
        let all = self.view(view)?;
        let size = component.size() * width;
        let stride = self.root.buffer_views.get(view.index()).and_then(|v| v.byte_stride);
        // Some exporters write 0 for tightly packed, as in version 1.
        let stride = stride.filter(|stride| stride.0 > 0).map_or(size as u64, |stride| stride.0);
        if stride < size as u64 {
            return Err(LoadRefusal::at(user, format!("has a stride of {stride} bytes for entries of {size}")));
        }
        let needed = (count - 1).saturating_mul(stride).saturating_add(size as u64);
        let range = usize::try_from(offset).ok().and_then(|start| {
            let end = start.checked_add(usize::try_from(needed).ok()?)?;
            all.get(start..end)
        });
        let bytes = range.ok_or_else(|| {
            let reason = format!("needs {needed} bytes from byte {offset}, but its view has {}", all.len());
            LoadRefusal::at(user, reason)
        })?;
        Ok(Layout { bytes, stride: stride as usize, component, normalized: false })
    }
}

/// The replacements of a sparse accessor. Invariant: each target is an entry of the accessor.
struct Overlay<'a> {
    targets: Vec<usize>,
    values: Layout<'a>,
}
