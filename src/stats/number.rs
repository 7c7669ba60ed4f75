//! Numbers as JSON has them, and words for those that it lacks: its null would pass for nothing, or for small.

use serde::{Deserialize, Deserializer, Serialize, Serializer, de::Error};
use serde_json::Value;

/// A number. What is not finite stands in JSON as `"infinity"`, `"-infinity"` or `"nan"`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Number(pub f64);

impl From<Number> for Value {
    fn from(Number(value): Number) -> Self {
        match value {
            value if value.is_finite() => value.into(),
            value if value.is_nan() => "nan".into(),
            value if value > 0.0 => "infinity".into(),
            _ => "-infinity".into(),
        }
    }
}

impl Serialize for Number {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        Value::from(*self).serialize(to)
    }
}

impl<'de> Deserialize<'de> for Number {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        let value = Value::deserialize(from)?;
        let number = match &value {
            Value::Number(number) => number.as_f64(),
            Value::String(word) if ["infinity", "-infinity", "nan"].contains(&word.as_str()) => word.parse().ok(),
            _ => None,
        };
        let wrong =
            || D::Error::custom(format!("expected a number, \"infinity\", \"-infinity\" or \"nan\", found {value}"));
        number.map(Self).ok_or_else(wrong)
    }
}

/// For `serialize_with`, where a structure holds plain numbers.
pub fn write_number<S: Serializer>(value: &f64, to: S) -> Result<S::Ok, S::Error> {
    Number(*value).serialize(to)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_that_json_lacks_are_words_and_come_back() {
        for (value, word) in
            [(f64::INFINITY, "\"infinity\""), (f64::NEG_INFINITY, "\"-infinity\""), (f64::NAN, "\"nan\""), (1.5, "1.5")]
        {
            assert_eq!(serde_json::to_string(&Number(value)).unwrap(), word);
            let Number(back) = serde_json::from_str(word).unwrap();
            assert!(back == value || back.is_nan() && value.is_nan());
        }
        for wrong in ["null", "\"inf\"", "\"1\"", "[]"] {
            assert!(serde_json::from_str::<Number>(wrong).is_err(), "{wrong}");
        }
    }
}
