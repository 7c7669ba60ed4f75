//! Accessors: checked once against their buffers, then read element by element.
use super::{Document, EXPORT, GltfFault, fault, json, named};

/// What a component is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Component {
    I8,
    U8,
    I16,
    U16,
    U32,
    F32,
}

impl Component {
    /// By its number in OpenGL.
    fn of(number: usize) -> Option<Component> {
        Some(match number {
            5120 => Component::I8,
            5121 => Component::U8,
            5122 => Component::I16,
            5123 => Component::U16,
            5125 => Component::U32,
            5126 => Component::F32,
            _ => return None,
        })
    }

    fn size(self) -> usize {
        match self {
            Component::I8 | Component::U8 => 1,
            Component::I16 | Component::U16 => 2,
            Component::U32 | Component::F32 => 4,
        }
    }

    /// What a whole number is divided by where it stands for a share.
    fn most(self) -> f64 {
        match self {
            Component::I8 => 127.0,
            Component::U8 => 255.0,
            Component::I16 => 32767.0,
            Component::U16 => 65535.0,
            Component::U32 => f64::from(u32::MAX),
            Component::F32 => 1.0,
        }
    }

    /// The first component in these bytes; none where they are too few.
    fn read(self, bytes: &[u8]) -> Option<f64> {
        Some(match self {
            Component::I8 => f64::from(i8::from_le_bytes(*bytes.first_chunk()?)),
            Component::U8 => f64::from(*bytes.first()?),
            Component::I16 => f64::from(i16::from_le_bytes(*bytes.first_chunk()?)),
            Component::U16 => f64::from(u16::from_le_bytes(*bytes.first_chunk()?)),
            Component::U32 => f64::from(u32::from_le_bytes(*bytes.first_chunk()?)),
            Component::F32 => f64::from(f32::from_le_bytes(*bytes.first_chunk()?)),
        })
    }
}

/// What an attribute may be made of.
pub struct Wanted {
    pub kind: &'static str,
    pub components: &'static [Component],
    pub told: &'static str,
}

/// Elements at even distances in bytes that hold them all.
struct Elements<'a> {
    bytes: &'a [u8],
    stride: usize,
}

impl<'a> Elements<'a> {
    fn at(&self, index: usize) -> &'a [u8] {
        self.bytes.get(index * self.stride..).unwrap_or_default()
    }
}

/// Elements that lie within their buffers.
pub struct Accessor<'a> {
    pub count: usize,
    pub component: Component,
    normalized: bool,
    /// Zeros where there is none.
    base: Option<Elements<'a>>,
    sparse: Option<Sparse<'a>>,
}

/// Elements that stand in the place of others.
struct Sparse<'a> {
    count: usize,
    component: Component,
    indices: Elements<'a>,
    values: Elements<'a>,
}

impl Sparse<'_> {
    fn index(&self, at: usize) -> usize {
        self.component.read(self.indices.at(at)).unwrap_or_default() as usize
    }

    /// Where the element of this index stands, if it does; indices grow.
    fn find(&self, index: usize) -> Option<&[u8]> {
        let (mut low, mut high) = (0, self.count);
        while low < high {
            let middle = low + (high - low) / 2;
            if self.index(middle) < index { low = middle + 1 } else { high = middle }
        }
        (low < self.count && self.index(low) == index).then(|| self.values.at(low))
    }
}

impl Accessor<'_> {
    /// An element of N components; `index` is below the count.
    pub fn floats<const N: usize>(&self, index: usize) -> [f64; N] {
        let replaced = self.sparse.as_ref().and_then(|sparse| sparse.find(index));
        let Some(bytes) = replaced.or_else(|| self.base.as_ref().map(|base| base.at(index))) else { return [0.0; N] };
        let size = self.component.size();
        std::array::from_fn(|k| {
            let value = bytes.get(k * size..).and_then(|bytes| self.component.read(bytes)).unwrap_or_default();
            if self.normalized { (value / self.component.most()).max(-1.0) } else { value }
        })
    }

    /// A whole number.
    pub fn whole(&self, index: usize) -> u32 {
        self.floats::<1>(index)[0] as u32
    }

    /// The number that ends a strip in other formats.
    pub fn restart(&self) -> u32 {
        self.component.most() as u32
    }
}

impl Document {
    /// Checks all that an accessor says of itself.
    pub fn accessor(&self, index: usize, used_at: &str, wanted: &Wanted) -> Result<Accessor<'_>, GltfFault> {
        let written = named(&self.json.accessors, index, used_at, "accessors")?;
        let path = format!("accessors[{index}]");
        let component = component(&path, written.component_type)?;
        // Shares of 32 bits there are none, and floats are what they are.
        let normalized = written.normalized && !matches!(component, Component::U32 | Component::F32);
        if written.kind != wanted.kind || !wanted.components.contains(&component) {
            let found = format!("{} of {component:?} in {path}", written.kind);
            return Err(fault(used_at, wanted.told, found, EXPORT));
        }
        let width = match wanted.kind {
            "VEC3" => 3,
            "VEC2" => 2,
            _ => 1,
        };
        let size = width * component.size();
        let base = written.buffer_view.map(|view| {
            let view_path = format!("{path}.bufferView");
            self.elements(&path, (view, &view_path), written.byte_offset, written.count, size, true)
        });
        let sparse = written.sparse.as_ref().map(|sparse| self.sparse(&path, sparse, written.count, size));
        Ok(Accessor {
            count: written.count,
            component,
            normalized,
            base: base.transpose()?,
            sparse: sparse.transpose()?,
        })
    }

    /// A part of a buffer; `path` names what names it.
    pub(super) fn bytes_of(&self, view: usize, path: &str) -> Result<&[u8], GltfFault> {
        let written = named(&self.json.buffer_views, view, path, "buffer views")?;
        let view_path = format!("bufferViews[{view}]");
        let buffer = named(&self.buffers, written.buffer, &format!("{view_path}.buffer"), "buffers")?;
        let end = written.byte_offset.checked_add(written.byte_length);
        end.and_then(|end| buffer.get(written.byte_offset..end)).ok_or_else(|| {
            let found = format!("{} from byte {} on", written.byte_length, written.byte_offset);
            fault(view_path, format!("a part of the buffer's {} bytes", buffer.len()), found, EXPORT)
        })
    }

    fn sparse(&self, path: &str, written: &json::Sparse, of: usize, size: usize) -> Result<Sparse<'_>, GltfFault> {
        let (indices, values) = (&written.indices, &written.values);
        let at = format!("{path}.sparse.indices");
        let component = component(&at, indices.component_type)?;
        if !matches!(component, Component::U8 | Component::U16 | Component::U32) {
            return Err(fault(at, "indices as unsigned whole numbers", format!("{component:?}"), EXPORT));
        }
        let part = |view: usize, name: &str, offset, size| {
            let path = format!("{path}.sparse.{name}");
            self.elements(&path, (view, &format!("{path}.bufferView")), offset, written.count, size, false)
        };
        let sparse = Sparse {
            count: written.count,
            component,
            indices: part(indices.buffer_view, "indices", indices.byte_offset, component.size())?,
            values: part(values.buffer_view, "values", values.byte_offset, size)?,
        };
        self.spend(&at, written.count)?;
        let mut next = 0;
        for element in 0..written.count {
            let index = sparse.index(element);
            if index < next || index >= of {
                let expected = format!("indices that grow, below {of}");
                return Err(fault(at, expected, format!("{index} as number {element}"), EXPORT));
            }
            next = index + 1;
        }
        Ok(sparse)
    }

    /// `count` elements in a view, which must hold them.
    fn elements(
        &self,
        path: &str,
        (view, view_path): (usize, &str),
        offset: usize,
        count: usize,
        size: usize,
        may_stride: bool,
    ) -> Result<Elements<'_>, GltfFault> {
        let bytes = self.bytes_of(view, view_path)?;
        let written = &self.json.buffer_views[view];
        let view_path = format!("bufferViews[{view}]");
        let stride = written.byte_stride.filter(|_| may_stride).unwrap_or(size);
        if stride < size {
            let expected = format!("a stride of at least {size} bytes, the size of an element");
            return Err(fault(format!("{view_path}.byteStride"), expected, stride.to_string(), EXPORT));
        }
        let needed = count.saturating_sub(1).checked_mul(stride).and_then(|bytes| bytes.checked_add(size));
        let needed = if count == 0 { Some(0) } else { needed };
        match needed.and_then(|needed| bytes.get(offset..offset.checked_add(needed)?)) {
            Some(bytes) => Ok(Elements { bytes, stride }),
            None => {
                let expected = format!("elements within the {} bytes of {view_path}", bytes.len());
                let found = format!("{count} of {size} bytes from byte {offset} on, {stride} apart");
                Err(fault(path, expected, found, EXPORT))
            }
        }
    }
}

fn component(path: &str, number: usize) -> Result<Component, GltfFault> {
    let expected = "one of 5120, 5121, 5122, 5123, 5125 and 5126";
    Component::of(number).ok_or_else(|| fault(format!("{path}.componentType"), expected, number.to_string(), EXPORT))
}
