//! The scene format as a JSON schema, made from the types that read it: for editors, which complete keys and mark wrong ones.
use schemars::{
    Schema,
    generate::SchemaSettings,
    transform::{Transform, transform_subschemas},
};
use serde_json::{Value, json};

use super::{
    file::{SceneFile, VERSION},
    format::KINDS,
};

pub fn schema() -> Value {
    let settings = SchemaSettings::draft2020_12().with_transform(NoNull);
    let mut schema = settings.into_generator().into_root_schema_for::<SceneFile>();
    schema.insert("title".to_owned(), json!("Scene of nephroid"));
    if let Some(version) = schema.pointer_mut("/properties/version") {
        version["const"] = json!(VERSION);
    }
    schema.to_value()
}

/// Exactly one of the tables that say of what kind an entry is.
pub fn one_kind(schema: &mut Schema) {
    let properties = schema.get("properties").and_then(Value::as_object);
    let kinds = properties.into_iter().flat_map(|all| all.keys()).filter(|key| KINDS.contains(&key.as_str()));
    let one: Vec<_> = kinds.map(|kind| json!({ "required": [kind] })).collect();
    schema.insert("oneOf".to_owned(), Value::Array(one));
}

/// TOML has no null: what may be left out is left out.
#[derive(Clone, Debug)]
struct NoNull;

impl Transform for NoNull {
    fn transform(&mut self, schema: &mut Schema) {
        transform_subschemas(self, schema);
        if let Some(Value::Array(types)) = schema.get_mut("type") {
            types.retain(|name| name != "null");
            if let [one] = types.as_slice() {
                let one = one.clone();
                schema.insert("type".to_owned(), one);
            }
        }
        let Some(Value::Array(ways)) = schema.get_mut("anyOf") else { return };
        ways.retain(|way| *way != json!({ "type": "null" }));
        if let [Value::Object(one)] = ways.as_slice() {
            let one = one.clone();
            schema.remove("anyOf");
            for (key, value) in one {
                schema.insert(key, value);
            }
        }
    }
}
