//! Numbers as scene files write them: N in a row, or one for three bands.
use std::{borrow::Cow, fmt};

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{
    Deserialize, Deserializer,
    de::{Error, IgnoredAny, SeqAccess, Unexpected, Visitor},
};

/// Exactly N numbers; the library's own arrays let surplus ones pass.
#[derive(Clone, Copy)]
pub struct Floats<const N: usize>(pub [f64; N]);

impl<const N: usize> Default for Floats<N> {
    fn default() -> Self {
        Floats([0.0; N])
    }
}

impl<'de, const N: usize> Deserialize<'de> for Floats<N> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(Numbers { single: false }).map(Floats)
    }
}

/// One number for all three bands, or `[red, green, blue]`.
#[derive(Clone, Copy, Default)]
pub struct Colour(pub [f64; 3]);

impl<'de> Deserialize<'de> for Colour {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(Numbers { single: true }).map(Colour)
    }
}

impl<const N: usize> JsonSchema for Floats<N> {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        format!("Floats{N}").into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({ "type": "array", "items": { "type": "number" }, "minItems": N, "maxItems": N })
    }
}

impl JsonSchema for Colour {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        "Colour".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        json_schema!({ "anyOf": [{ "type": "number" }, Floats::<3>::json_schema(generator)] })
    }
}

struct Numbers<const N: usize> {
    /// A lone number stands for N equal ones.
    single: bool,
}

impl<'de, const N: usize> Visitor<'de> for Numbers<N> {
    type Value = [f64; N];

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}an array of {N} numbers", if self.single { "a number or " } else { "" })
    }

    fn visit_f64<E: Error>(self, value: f64) -> Result<Self::Value, E> {
        if self.single { Ok([value; N]) } else { Err(E::invalid_type(Unexpected::Other("one number"), &self)) }
    }

    fn visit_i64<E: Error>(self, value: i64) -> Result<Self::Value, E> {
        self.visit_f64(value as f64)
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut sequence: A) -> Result<Self::Value, A::Error> {
        let mut values = [0.0; N];
        for (i, value) in values.iter_mut().enumerate() {
            *value = sequence.next_element()?.ok_or_else(|| A::Error::invalid_length(i, &self))?;
        }
        match sequence.next_element::<IgnoredAny>()? {
            None => Ok(values),
            Some(_) => Err(A::Error::invalid_length(N + 1, &self)),
        }
    }
}
