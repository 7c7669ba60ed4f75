//! Wavefront OBJ: `v`, `vn` and `f`; every other statement is passed over.
//!
//! Polygons become triangle fans; texture coordinates, groups and materials play no part. Written here because every
//! fault must name its line and no input may panic.
use std::collections::HashMap;

use glam::Vec3;

use super::{Mesh, mesh::vertex_normals};

/// What is wrong with an OBJ file; line 0 is the file as a whole.
#[derive(Debug, PartialEq)]
pub struct ObjFault {
    pub line: usize,
    pub expected: &'static str,
    pub found: String,
    pub remedy: &'static str,
}

/// Indices of a face's corner: position, and normal if it has one.
type Corner = (usize, Option<usize>);

#[derive(Default)]
struct Statements {
    positions: Vec<Vec3>,
    normals: Vec<Vec3>,
    /// Line, and corners as written: counted from 1, or backwards from what stood before.
    faces: Vec<(usize, Vec<Corner>)>,
}

/// Reads a mesh. A file with vertices and no face is an empty mesh.
pub fn parse(file: &str, bytes: &[u8]) -> Result<Mesh, ObjFault> {
    let statements = Statements::read(&String::from_utf8_lossy(bytes))?;
    if statements.positions.is_empty() {
        let remedy = "check that this is the right file";
        return Err(ObjFault { line: 0, expected: "an OBJ file", found: "no vertex".to_owned(), remedy });
    }
    statements.into_mesh(file)
}

impl Statements {
    fn read(text: &str) -> Result<Statements, ObjFault> {
        let mut all = Statements::default();
        for (line, statement) in (1..).zip(text.lines()) {
            let mut words = statement.split('#').next().unwrap_or_default().split_whitespace();
            match words.next() {
                Some("v") => all.positions.push(triple(line, words)?),
                Some("vn") => all.normals.push(normal(line, words)?),
                Some("f") => {
                    let face = all.face(line, words)?;
                    all.faces.push((line, face));
                }
                _ => {}
            }
        }
        Ok(all)
    }

    fn face<'t>(&self, line: usize, words: impl Iterator<Item = &'t str>) -> Result<Vec<Corner>, ObjFault> {
        let corner = |word: &str| {
            let mut parts = word.split('/');
            let position = index(parts.next()?, self.positions.len())?;
            let normal = parts.nth(1).filter(|part| !part.is_empty()).map(|part| index(part, self.normals.len()));
            Some((position, normal.map_or(Some(None), |n| n.map(Some))?))
        };
        let wrong = |word: &str| ObjFault {
            line,
            expected: "face corners as `v`, `v/t`, `v//n` or `v/t/n`",
            found: format!("{word:?}"),
            remedy: "count indices from 1, or backwards from -1",
        };
        let corners: Vec<Corner> =
            words.map(|word| corner(word).ok_or_else(|| wrong(word))).collect::<Result<_, _>>()?;
        if corners.len() < 3 {
            let found = corners.len().to_string();
            return Err(ObjFault { line, expected: "three corners or more", found, remedy: "take the face out" });
        }
        Ok(corners)
    }

    fn into_mesh(self, file: &str) -> Result<Mesh, ObjFault> {
        let own_normals = self.faces.iter().flat_map(|(_, face)| face).all(|corner| corner.1.is_some());
        let mut mesh =
            Mesh { file: file.to_owned(), positions: vec![], normals: vec![], triangles: vec![], sheet: None };
        let mut vertices = HashMap::new();
        for (line, face) in &self.faces {
            let mut vertex = |&(position, normal): &Corner| {
                let key = (position, normal.filter(|_| own_normals));
                let at = *self.positions.get(position).ok_or_else(|| beyond(*line, "vertex", position))?;
                let along = key.1.map(|n| self.normals.get(n).ok_or_else(|| beyond(*line, "normal", n))).transpose()?;
                Ok(*vertices.entry(key).or_insert_with(|| {
                    mesh.positions.push(at);
                    mesh.normals.extend(along);
                    (mesh.positions.len() - 1) as u32
                }))
            };
            let corners: Vec<u32> = face.iter().map(&mut vertex).collect::<Result<_, _>>()?;
            mesh.triangles.extend(corners[1..].windows(2).map(|edge| [corners[0], edge[0], edge[1]]));
        }
        if !own_normals {
            mesh.normals = vertex_normals(&mesh.positions, &mesh.triangles);
        }
        Ok(mesh)
    }
}

/// Zero-based index of what is written from 1 on, or from -1 back.
fn index(word: &str, count: usize) -> Option<usize> {
    match word.parse::<i64>().ok()? {
        0 => None,
        n if n > 0 => usize::try_from(n - 1).ok(),
        n => count.checked_sub(usize::try_from(n.unsigned_abs()).ok()?),
    }
}

fn beyond(line: usize, what: &str, index: usize) -> ObjFault {
    let found = format!("{what} {}", index + 1);
    ObjFault { line, expected: "indices of vertices and normals that the file holds", found, remedy: "export it again" }
}

fn triple<'t>(line: usize, words: impl Iterator<Item = &'t str>) -> Result<Vec3, ObjFault> {
    let fault = |found: String| ObjFault {
        line,
        expected: "three finite numbers",
        found,
        remedy: "repair the line, or export the mesh again",
    };
    let mut values = [0.0_f32; 3];
    let mut words = words;
    for value in &mut values {
        let word = words.next().ok_or_else(|| fault("fewer".to_owned()))?;
        *value = word.parse().ok().filter(|x: &f32| x.is_finite()).ok_or_else(|| fault(format!("{word:?}")))?;
    }
    Ok(Vec3::from_array(values))
}

fn normal<'t>(line: usize, words: impl Iterator<Item = &'t str>) -> Result<Vec3, ObjFault> {
    let given = triple(line, words)?.as_dvec3();
    let remedy = "take the normals out; the program then makes its own";
    let zero = || ObjFault { line, expected: "a normal that is not zero", found: "zero".to_owned(), remedy };
    given.try_normalize().map(|unit| unit.as_vec3()).ok_or_else(zero)
}
