//! Wavefront OBJ: `v`, `vt`, `vn` and `f`; every other statement is passed over.
//!
//! Polygons become triangle fans; groups and materials play no part. Texture coordinates count where every corner has some;
//! where they part, as at a seam, normals are still those of the whole surface. Written here because every
//! fault must name its line and no input may panic.
use std::collections::HashMap;

use glam::{Vec2, Vec3};

use super::{Mesh, mesh::vertex_normals};

/// What is wrong with an OBJ file; line 0 is the file as a whole.
#[derive(Debug, PartialEq)]
pub struct ObjFault {
    pub line: usize,
    pub expected: &'static str,
    pub found: String,
    pub remedy: &'static str,
}

/// Indices of a face's corner: position, and texture coordinates and normal if it has them.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
struct Corner {
    position: usize,
    coordinates: Option<usize>,
    normal: Option<usize>,
}

#[derive(Default)]
struct Statements {
    positions: Vec<Vec3>,
    coordinates: Vec<Vec2>,
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
                Some("vt") => all.coordinates.push(pair(line, words)?),
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
            let mut next = |count: usize| {
                let part = parts.next().filter(|part| !part.is_empty());
                part.map_or(Some(None), |part| index(part, count).map(Some))
            };
            Some(Corner { position, coordinates: next(self.coordinates.len())?, normal: next(self.normals.len())? })
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
        let mut corners = self.faces.iter().flat_map(|(_, face)| face);
        let own_normals = corners.clone().all(|corner| corner.normal.is_some());
        let placed = corners.all(|corner| corner.coordinates.is_some());
        let mut mesh = Mesh { file: file.to_owned(), ..Mesh::default() };
        let made = if own_normals { vec![] } else { self.normals_of_positions()? };
        let mut vertices = HashMap::new();
        for (line, face) in &self.faces {
            let mut vertex = |corner: &Corner| {
                self.check(*line, corner)?;
                let key = Corner {
                    coordinates: corner.coordinates.filter(|_| placed),
                    normal: corner.normal.filter(|_| own_normals),
                    ..*corner
                };
                Ok(*vertices.entry(key).or_insert_with(|| {
                    mesh.positions.push(self.positions[key.position]);
                    mesh.normals.push(key.normal.map_or_else(|| made[key.position], |n| self.normals[n]));
                    mesh.coordinates.extend(key.coordinates.map(|t| self.coordinates[t]));
                    (mesh.positions.len() - 1) as u32
                }))
            };
            let corners: Vec<u32> = face.iter().map(&mut vertex).collect::<Result<_, _>>()?;
            mesh.triangles.extend(fan(&corners));
        }
        Ok(mesh)
    }

    /// Whether a corner names what is there, used or not.
    fn check(&self, line: usize, corner: &Corner) -> Result<(), ObjFault> {
        let held = [
            ("vertex", Some(corner.position), self.positions.len()),
            ("texture coordinates", corner.coordinates, self.coordinates.len()),
            ("normal", corner.normal, self.normals.len()),
        ];
        let missing = held.into_iter().find_map(|(what, index, count)| Some((what, index.filter(|i| *i >= count)?)));
        missing.map_or(Ok(()), |(what, index)| Err(beyond(line, what, index)))
    }

    /// One for each position, over all triangles that meet there, whatever their texture coordinates.
    fn normals_of_positions(&self) -> Result<Vec<Vec3>, ObjFault> {
        let mut triangles = vec![];
        for (line, face) in &self.faces {
            face.iter().try_for_each(|corner| self.check(*line, corner))?;
            triangles.extend(fan(&face.iter().map(|corner| corner.position as u32).collect::<Vec<_>>()));
        }
        Ok(vertex_normals(&self.positions, &triangles))
    }
}

/// A polygon's triangles.
fn fan(corners: &[u32]) -> impl Iterator<Item = [u32; 3]> {
    corners[1..].windows(2).map(|edge| [corners[0], edge[0], edge[1]])
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
    ObjFault { line, expected: "indices of what the file holds", found, remedy: "export it again" }
}

fn triple<'t>(line: usize, words: impl Iterator<Item = &'t str>) -> Result<Vec3, ObjFault> {
    numbers(line, words, "three finite numbers").map(Vec3::from_array)
}

/// The second is 0 where it is left out; a third, of pictures in depth, is passed over.
fn pair<'t>(line: usize, words: impl Iterator<Item = &'t str>) -> Result<Vec2, ObjFault> {
    let written: Vec<&str> = words.take(2).collect();
    let zero = (written.len() == 1).then_some("0");
    numbers(line, written.into_iter().chain(zero), "one or two finite numbers").map(Vec2::from_array)
}

fn numbers<'t, const N: usize>(
    line: usize,
    mut words: impl Iterator<Item = &'t str>,
    expected: &'static str,
) -> Result<[f32; N], ObjFault> {
    let remedy = "repair the line, or export the mesh again";
    let fault = |found: String| ObjFault { line, expected, found, remedy };
    let mut values = [0.0_f32; N];
    for value in &mut values {
        let word = words.next().ok_or_else(|| fault("fewer".to_owned()))?;
        *value = word.parse().ok().filter(|x: &f32| x.is_finite()).ok_or_else(|| fault(format!("{word:?}")))?;
    }
    Ok(values)
}

fn normal<'t>(line: usize, words: impl Iterator<Item = &'t str>) -> Result<Vec3, ObjFault> {
    let given = triple(line, words)?.as_dvec3();
    let remedy = "take the normals out; the program then makes its own";
    let zero = || ObjFault { line, expected: "a normal that is not zero", found: "zero".to_owned(), remedy };
    given.try_normalize().map(|unit| unit.as_vec3()).ok_or_else(zero)
}
