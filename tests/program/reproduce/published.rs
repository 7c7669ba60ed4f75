//! The registry against the file that it is made from, walked by another way.

use std::collections::BTreeMap;

use nephroid::lab::papers::{self, Label};
use toml::{Table, Value};

static TABLES: &str = include_str!("../../../src/lab/papers/tables.toml");

/// Every number below a value: key path and value.
fn leaves(path: &str, value: &Value, into: &mut Vec<(String, f64)>) {
    match value {
        Value::Table(table) => table.iter().for_each(|(key, v)| leaves(&format!("{path}.{key}"), v, into)),
        Value::Array(values) => values.iter().for_each(|v| leaves(path, v, into)),
        Value::Integer(n) => into.push((path.to_owned(), *n as f64)),
        Value::Float(x) if !x.is_nan() => into.push((path.to_owned(), *x)), // what is said in words is no figure
        _ => {}
    }
}

fn is_axis(path: &str) -> bool {
    path.ends_with(".photons") || path.ends_with(".screen")
}

#[test]
fn every_published_figure_is_there_once_and_equal() {
    let root: Table = TABLES.parse().unwrap();
    let mut expected = Vec::new();
    leaves("", &Value::Table(root), &mut expected);
    let mut expected: Vec<(String, u64)> = expected
        .into_iter()
        .filter(|(path, _)| !is_axis(path))
        .map(|(path, v)| (path.rsplit('.').next().unwrap().to_owned(), v.to_bits()))
        .collect();
    let all = papers::all();
    let mut found: Vec<(String, u64)> =
        all.iter().flat_map(|p| &p.figures).filter_map(|f| Some((f.column.clone(), f.value?.to_bits()))).collect();
    expected.sort();
    found.sort();
    assert!(expected.len() > 150, "{} figures", expected.len());
    assert_eq!(found, expected);
}

#[test]
fn rows_are_what_the_papers_have_in_them() {
    let figure = |id: &str, column: &str, row: Label| {
        let published = papers::find(id).unwrap();
        let found: Vec<f64> =
            published.figures.iter().filter(|f| f.column == column && f.row == row).filter_map(|f| f.value).collect();
        assert_eq!(found.len(), 1, "{id} {column} {row:?}");
        found[0]
    };
    let words = |text: &str| Label::Words(text.to_owned());
    assert_eq!(figure("maps.table1", "copy_to_vertex_array", Label::Number(2048)), 215.5);
    assert_eq!(figure("maps.table2", "f16_to_f16", Label::Number(256)), 0.5);
    assert_eq!(figure("maps.table5", "fps", words("bunny, 4096")), 9.3);
    assert_eq!(figure("lines.table1", "volume_caustic", words("gemstone")), 21.0);
    assert_eq!(figure("lines.table2", "buffer_512", Label::Number(1024)), 115.0);
    assert_eq!(figure("beams.figure6", "tight_fps", words("")), 38.0);
    assert_eq!(figure("waves.text", "wave_size", words("")), 10.0);
    let ids: BTreeMap<String, usize> = papers::all().into_iter().map(|p| (p.id, p.figures.len())).collect();
    assert_eq!(ids["maps.table1"], 20);
    assert!(ids.values().all(|n| *n > 0), "{ids:?}");
    let error = papers::find("maps.tabel2").unwrap_err().to_string();
    assert!(error.contains("`maps.table2`"), "{error}");
}
