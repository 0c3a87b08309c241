//! Triangle meshes of curved surfaces, and the PLY files in which renderers read them.
//!
//! Vertices lie on the surface and carry its normals. That is right for the comparison: rays then turn about the
//! interpolated normal, which is off by O(h²) for cells of size h; flat facets without it are off by O(h), and split a
//! caustic into as many flat images as there are facets.

use glam::DVec3;

use super::model::{Element, Patch};

/// A mesh with a normal at every vertex.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// Points [m] and unit normals.
    pub vertices: Vec<Element>,
    /// Triples of vertices, counterclockwise seen from the front.
    pub triangles: Vec<[u32; 3]>,
}

impl Mesh {
    /// A patch in `cells` columns along s and rows along t.
    pub fn of(patch: &Patch, [columns, rows]: [u32; 2]) -> Self {
        let mut mesh = Mesh::default();
        for j in 0..=rows {
            for i in 0..=columns {
                let (s, t) = (
                    f64::from(i) / f64::from(columns),
                    f64::from(j) / f64::from(rows),
                );
                mesh.vertices.push((patch.at)(s, t));
            }
        }
        let index = |i: u32, j: u32| j * (columns + 1) + i;
        for j in 0..rows {
            for i in 0..columns {
                let corners = [
                    index(i, j),
                    index(i + 1, j),
                    index(i + 1, j + 1),
                    index(i, j + 1),
                ];
                mesh.add([corners[0], corners[1], corners[2]]);
                mesh.add([corners[0], corners[2], corners[3]]);
            }
        }
        mesh
    }

    /// A rectangle: exactly two triangles.
    pub fn rectangle(center: DVec3, u: DVec3, v: DVec3) -> Self {
        let normal = u.cross(v).normalize();
        let mut mesh = Mesh::default();
        for corner in [-u - v, u - v, u + v, -u + v] {
            mesh.vertices.push((center + corner, normal));
        }
        mesh.triangles = vec![[0, 1, 2], [0, 2, 3]];
        mesh
    }

    /// Adds a triangle turned to the side of its normals; one that has no area, at a pole, is left out.
    fn add(&mut self, [a, b, c]: [u32; 3]) {
        let at = |k: u32| self.vertices[k as usize];
        let ((pa, na), (pb, nb), (pc, nc)) = (at(a), at(b), at(c));
        let (u, v) = (pb - pa, pc - pa);
        let area = u.cross(v);
        if area.length_squared() <= 1e-20 * u.length_squared() * v.length_squared() {
            return;
        }
        let front = area.dot(na + nb + nc) > 0.0;
        self.triangles
            .push(if front { [a, b, c] } else { [a, c, b] });
    }

    /// The mesh moved by `distance` against its normals and turned round: the back of a mirror.
    pub fn backing(&self, distance: f64) -> Self {
        Mesh {
            vertices: self
                .vertices
                .iter()
                .map(|&(p, n)| (p - n * distance, -n))
                .collect(),
            triangles: self.triangles.iter().map(|&[a, b, c]| [a, c, b]).collect(),
        }
    }

    /// The largest angle between a facet and a normal at its vertices [rad].
    pub fn facet_angle(&self) -> f64 {
        let angle = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|k| self.vertices[k as usize]);
            let facet = (b.0 - a.0).cross(c.0 - a.0).normalize();
            [a.1, b.1, c.1]
                .map(|n| facet.cross(n).length())
                .into_iter()
                .fold(0.0, f64::max)
        };
        libm::asin(
            self.triangles
                .iter()
                .map(angle)
                .fold(0.0, f64::max)
                .min(1.0),
        )
    }

    /// The mesh as a binary PLY file: single precision, little-endian; the same bytes everywhere.
    pub fn ply(&self) -> Vec<u8> {
        let mut bytes = format!(
            "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty float z\n\
             property float nx\nproperty float ny\nproperty float nz\nelement face {}\n\
             property list uchar int vertex_indices\nend_header\n",
            self.vertices.len(),
            self.triangles.len()
        )
        .into_bytes();
        for (p, n) in &self.vertices {
            for value in [p.x, p.y, p.z, n.x, n.y, n.z] {
                // Adding 0 turns -0 into 0.
                bytes.extend_from_slice(&(value as f32 + 0.0).to_le_bytes());
            }
        }
        for triangle in &self.triangles {
            bytes.push(3);
            for index in triangle {
                bytes.extend_from_slice(&index.to_le_bytes());
            }
        }
        bytes
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::export::model::Geometry;

    #[test]
    fn a_sphere_is_turned_outwards_and_closed() {
        let sphere = Geometry::Sphere {
            center: DVec3::new(0.3, -0.2, 1.0),
            radius: 0.5,
            inward: false,
        };
        let mesh = Mesh::of(&sphere.patch().unwrap(), [64, 32]);
        // By the divergence theorem the volume is a sum over facets; that of the polyhedron is a little too small.
        let volume: f64 = mesh
            .triangles
            .iter()
            .map(|t| {
                let [a, b, c] = t.map(|k| mesh.vertices[k as usize].0);
                a.dot(b.cross(c)) / 6.0
            })
            .sum();
        let exact = 4.0 / 3.0 * std::f64::consts::PI * 0.125;
        assert!(volume > 0.99 * exact && volume < exact, "{volume}");
        // Two rows at the poles have one triangle a cell.
        assert_eq!(mesh.triangles.len(), 2 * 64 * 32 - 2 * 64);
        assert!(mesh.facet_angle() < 0.1);
    }

    #[test]
    fn a_file_has_the_length_that_its_head_says() {
        let mesh = Mesh::rectangle(DVec3::Z, DVec3::X, DVec3::Y);
        let ply = mesh.ply();
        let end = b"end_header\n";
        let head = ply.windows(end.len()).position(|w| w == end).unwrap() + end.len();
        assert_eq!(ply.len() - head, 4 * 24 + 2 * 13);
        assert!(mesh.vertices.iter().all(|v| v.1 == DVec3::Z));
        assert!(
            mesh.backing(0.1)
                .vertices
                .iter()
                .all(|v| v.1 == -DVec3::Z && v.0.z == 0.9)
        );
    }
}
