//! Which techniques can build a path: decided on the interactions along it, from the light to the eye.
//!
//! The vertices of a path are v₀ (the light), its interactions, and the eye. Technique (s, t) traces s vertices from the light
//! and t from the eye, and connects the s-th from the light with the t-th from the eye. The connection is the one edge that
//! nothing has drawn: the scattering at both of its ends is evaluated for a direction that happens to be there.
//!
//! - s = 0 or t = 0 would need a path that hits the light or the pinhole by chance. A point, a direction and a pinhole have no
//!   extent: impossible.
//! - A specular vertex at either end scatters into one direction only: the connection has probability zero of being
//!   that one. Impossible.
//!
//! If no technique of a method is possible, every edge that it could connect touches a singularity: the class is *irregular* for
//! it. It cannot be sampled, or one specular vertex is mollified, which makes that vertex as good as any other. Classes with a
//! possible technique are regular, and never regularized.

use nephroid_analytic::class::PathClass;

/// What is at a vertex of a path.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Interaction {
    /// The light: a point, or a direction.
    Light,
    /// A diffuse reflection.
    Diffuse,
    /// A specular reflection or refraction.
    Specular,
    /// The pinhole.
    Eye,
}

/// The vertices of a path of a class, from the light to the eye.
pub fn vertices(class: PathClass) -> Vec<Interaction> {
    let mut vertices = vec![Interaction::Light];
    vertices.extend(class.light.iter().map(|_| Interaction::Specular));
    vertices.extend((0..class.diffuse).map(|_| Interaction::Diffuse));
    vertices.extend(class.eye.iter().map(|_| Interaction::Specular));
    vertices.push(Interaction::Eye);
    vertices
}

/// A technique: how many vertices are traced from either side.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Subpaths {
    /// Vertices traced from the light, itself included: s.
    pub light: usize,
    /// Vertices traced from the eye, itself included: t.
    pub eye: usize,
}

/// Which of all techniques a method has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Family {
    /// Next event estimation, s = 1.
    NextEvent,
    /// Light tracing to the pinhole, t = 1.
    LightTracing,
    /// All.
    Bidirectional,
}

impl Family {
    /// Whether a technique belongs to it.
    pub fn has(self, technique: Subpaths) -> bool {
        match self {
            Family::NextEvent => technique.light == 1,
            Family::LightTracing => technique.eye == 1,
            Family::Bidirectional => true,
        }
    }
}

/// The techniques of a family that can build paths of a class, in the order of s, if the specular vertex v_`mollified` is
/// mollified.
pub fn possible(class: PathClass, family: Family, mollified: Option<usize>) -> Vec<Subpaths> {
    let vertices = vertices(class);
    let connects =
        |i: usize| vertices[i] != Interaction::Specular || mollified.is_some_and(|m| m == i);
    (1..vertices.len())
        .map(|s| Subpaths {
            light: s,
            eye: vertices.len() - s,
        })
        .filter(|&technique| family.has(technique))
        .filter(|technique| connects(technique.light - 1) && connects(technique.light))
        .collect()
}

/// The vertex to be mollified: none for a regular class; of an irregular one the specular vertex next to the light, where
/// that makes a technique possible.
pub fn mollified_vertex(class: PathClass, family: Family) -> Option<usize> {
    let irregular = possible(class, family, None).is_empty();
    (irregular && !possible(class, family, Some(1)).is_empty()).then_some(1)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn words(class: &str, family: Family, mollified: Option<usize>) -> Vec<(usize, usize)> {
        let class = class.parse().unwrap();
        possible(class, family, mollified)
            .iter()
            .map(|t| (t.light, t.eye))
            .collect()
    }

    #[test]
    fn connections_need_two_vertices_that_are_not_specular() {
        use Family::*;
        for (class, next_event, light_tracing, all) in [
            ("LDE", &[(1, 2)][..], &[(2, 1)][..], &[(1, 2), (2, 1)][..]),
            ("LSDE", &[], &[(3, 1)], &[(3, 1)]),
            ("LDSE", &[(1, 3)], &[], &[(1, 3)]),
            ("LSDSE", &[], &[], &[]),
            ("LTTDE", &[], &[(4, 1)], &[(4, 1)]),
            ("LDDE", &[(1, 3)], &[(3, 1)], &[(1, 3), (2, 2), (3, 1)]),
            ("LSDDSE", &[], &[], &[(3, 3)]),
        ] {
            assert_eq!(words(class, NextEvent, None), next_event, "{class}");
            assert_eq!(words(class, LightTracing, None), light_tracing, "{class}");
            assert_eq!(words(class, Bidirectional, None), all, "{class}");
        }
    }

    #[test]
    fn only_irregular_classes_are_mollified_and_where_it_helps() {
        use Family::*;
        let at = |class: &str, family| mollified_vertex(class.parse().unwrap(), family);
        for class in ["LDE", "LSDE", "LDSE", "LDDE", "LSSDE"] {
            assert_eq!(at(class, Bidirectional), None, "{class}");
        }
        for class in ["LSDSE", "LSSDSE"] {
            assert_eq!(at(class, Bidirectional), Some(1), "{class}");
        }
        assert_eq!(at("LSDE", NextEvent), Some(1));
        // Light tracing cannot connect through the vertex next to the eye.
        assert_eq!(at("LDSE", LightTracing), None);
        assert_eq!(words("LSDSE", Bidirectional, Some(1)), [(1, 4), (2, 3)]);
        // Behind a chain the light's side ends in a specular vertex that is not mollified.
        assert_eq!(words("LSSDSE", Bidirectional, Some(1)), [(1, 5)]);
    }
}
