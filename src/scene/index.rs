//! Indices of refraction: as a number, a number a band, by Cauchy's equation, or by the name of a material.
use std::{borrow::Cow, fmt};

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{
    Deserialize, Deserializer,
    de::{Error, MapAccess, SeqAccess, Visitor, value::SeqAccessDeserializer},
};

use super::{
    error::SceneError,
    file::{Colour, Floats},
    locate::Key,
};

/// Indices: beyond any real one on both sides.
const INDICES: std::ops::RangeInclusive<f64> = 0.1..=10.0;

/// Wavelengths that stand for red, green and blue, µm: the dominant ones of the sRGB primaries.
pub const WAVELENGTHS: [f64; 3] = [0.611, 0.549, 0.464];

/// Indices at 0.5876 µm (helium d; ice and sapphire at 0.589 µm, ordinary ray), as tabulated by refractiveindex.info.
const NAMED: [(&str, f64); 11] = [
    ("acrylic", 1.4906),
    ("bk7", 1.5168),
    ("diamond", 2.4175),
    ("ethanol", 1.3617),
    ("fused-silica", 1.4585),
    ("glass", 1.5168),
    ("ice", 1.309),
    ("polycarbonate", 1.5848),
    ("sapphire", 1.7681),
    ("sf11", 1.7847),
    ("water", 1.333),
];

/// An index as a file writes it.
#[derive(Clone)]
pub enum IndexFile {
    /// One number, or one a band.
    Bands([f64; 3]),
    /// A material's name.
    Named(String),
    /// A and B (µm²) of n = A + B/λ².
    Cauchy([f64; 2]),
}

impl<'de> Deserialize<'de> for IndexFile {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(Written)
    }
}

impl JsonSchema for IndexFile {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        "Index".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        json_schema!({ "anyOf": [
            Colour::json_schema(generator),
            { "enum": NAMED.map(|(name, _)| name) },
            {
                "type": "object",
                "properties": { "cauchy": Floats::<2>::json_schema(generator) },
                "required": ["cauchy"],
                "additionalProperties": false,
            },
        ] })
    }
}

struct Written;

impl<'de> Visitor<'de> for Written {
    type Value = IndexFile;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "a number, an array of 3 numbers, the name of a material, or {{ cauchy = [A, B] }}")
    }

    fn visit_f64<E: Error>(self, value: f64) -> Result<IndexFile, E> {
        Ok(IndexFile::Bands([value; 3]))
    }

    fn visit_i64<E: Error>(self, value: i64) -> Result<IndexFile, E> {
        self.visit_f64(value as f64)
    }

    fn visit_str<E: Error>(self, name: &str) -> Result<IndexFile, E> {
        Ok(IndexFile::Named(name.to_owned()))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, sequence: A) -> Result<IndexFile, A::Error> {
        Ok(IndexFile::Bands(Floats::<3>::deserialize(SeqAccessDeserializer::new(sequence))?.0))
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<IndexFile, A::Error> {
        let mut found = None;
        while let Some(key) = map.next_key::<String>()? {
            match key.as_str() {
                "cauchy" => found = Some(map.next_value::<Floats<2>>()?),
                other => return Err(A::Error::unknown_field(other, &["cauchy"])),
            }
        }
        found.map(|Floats(numbers)| IndexFile::Cauchy(numbers)).ok_or_else(|| A::Error::missing_field("cauchy"))
    }
}

/// The index of each band.
pub fn index(key: &Key, file: &IndexFile) -> Result<[f64; 3], SceneError> {
    let bands = match file {
        IndexFile::Bands(bands) => *bands,
        IndexFile::Cauchy([a, b]) => WAVELENGTHS.map(|micrometres| a + b / (micrometres * micrometres)),
        IndexFile::Named(name) => {
            let names = NAMED.iter().map(|(name, _)| *name);
            [NAMED[key.resolve("a material whose index is known", name, names)?].1; 3]
        }
    };
    for band in bands {
        key.number(band, INDICES, "an index of refraction", "glass has about 1.5, water 1.33")?;
    }
    Ok(bands)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(Deserialize)]
    struct File {
        ior: IndexFile,
    }

    fn read(text: &str) -> Result<IndexFile, String> {
        toml::from_str::<File>(text).map(|file| file.ior).map_err(|error| error.message().to_owned())
    }

    #[test]
    fn each_way_of_writing_one() {
        assert!(matches!(read("ior = 1.5"), Ok(IndexFile::Bands([1.5, 1.5, 1.5]))));
        assert!(matches!(read("ior = 2"), Ok(IndexFile::Bands([2.0, 2.0, 2.0]))));
        assert!(matches!(read("ior = [1.5, 1.51, 1.52]"), Ok(IndexFile::Bands([1.5, 1.51, 1.52]))));
        assert!(matches!(read("ior = \"water\""), Ok(IndexFile::Named(name)) if name == "water"));
        assert!(matches!(read("ior = { cauchy = [1.5, 0.004] }"), Ok(IndexFile::Cauchy([1.5, 0.004]))));
        for wrong in ["ior = true", "ior = [1.5]", "ior = { cauchy = 1 }", "ior = { sellmeier = [1, 2] }", "ior = {}"] {
            assert!(read(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn names_are_sorted_and_their_indices_possible() {
        assert!(NAMED.windows(2).all(|pair| pair[0].0 < pair[1].0));
        assert!(NAMED.iter().all(|(_, index)| INDICES.contains(index)));
    }
}
