//! What a layer's name says: which light it holds.
//!
//! | program | names |
//! | --- | --- |
//! | ours | `LSDE.Y`: a path class; `error.Y` is a bound, no light |
//! | light path expressions | `C<RD>L`, also behind `lpe:`, `lpe_` or `lpe.` |
//! | Mitsuba | no name or `<integrator>.R`: the image; `m2_<name>`: second moment of a sample |
//! | pbrt | no name: the image; `Variance`: of a sample |
//! | LuxCore | `RGB`, `RGB_IMAGEPIPELINE`; `DIRECT_DIFFUSE`, `INDIRECT_DIFFUSE`, `CAUSTIC`, `INDIRECT_SPECULAR` |
//! | Cycles | `<view layer>.Combined`; `DiffDir`, `DiffInd`, `GlossInd`, `TransInd`, each times its `...Col` |
//!
//! A name may stand for several classes: then their sum is meant.

use nephroid_analytic::class::{Chain, PathClass, Specular};

use super::lpe::Expression;

/// What a layer holds.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Meaning {
    /// All light.
    Beauty,
    /// The sum of these classes, by position in the scene's list.
    Classes(Vec<usize>),
    /// The same, to be multiplied by the layer of this name.
    Times(Vec<usize>, String),
    /// The variance of the image: of a sample, or of a pixel's value.
    Variance {
        /// Whether of a single sample.
        of_sample: bool,
    },
    /// The second moment of one sample of the layer of this name.
    SecondMoment(String),
    /// No light that is known here.
    Unknown,
}

/// Splits a channel's name into its layer and its component.
pub fn split(channel: &str) -> (&str, &str) {
    match channel.rsplit_once('.') {
        Some((layer, component)) => (layer, component),
        None if is_component(channel) => ("", channel),
        None => (channel, ""),
    }
}

/// Whether a name is that of a component of a colour, or of a single number.
fn is_component(name: &str) -> bool {
    let known = [
        "R", "G", "B", "A", "X", "Y", "Z", "V", "L", "RY", "BY", "AR", "AG", "AB",
    ];
    known.iter().any(|k| k.eq_ignore_ascii_case(name))
}

/// What a layer of an image of these classes holds, by its name.
pub fn meaning(layer: &str, classes: &[PathClass]) -> Meaning {
    let last = layer.rsplit('.').next().unwrap_or(layer);
    if is_beauty(layer) || is_beauty(last) {
        return Meaning::Beauty;
    }
    if let Some(of) = layer.strip_prefix("m2_") {
        return Meaning::SecondMoment(of.to_owned());
    }
    if let Some(known) = statistics(last) {
        return known;
    }
    for name in [layer, last].into_iter().map(without_prefix) {
        if let Ok(named) = name.parse::<PathClass>() {
            return some(classes, |c| is_one_of(c, &named))
                .map_or(Meaning::Unknown, Meaning::Classes);
        }
        if let Some(expression) = Expression::parse(name) {
            return some(classes, |c| expression.matches(c))
                .map_or(Meaning::Unknown, Meaning::Classes);
        }
    }
    by_program(layer, last, classes).unwrap_or(Meaning::Unknown)
}

fn is_beauty(name: &str) -> bool {
    const NAMES: [&str; 9] = [
        "",
        "combined",
        "rgb",
        "rgba",
        "rgb_imagepipeline",
        "beauty",
        "color",
        "colour",
        "image",
    ];
    NAMES.iter().any(|n| n.eq_ignore_ascii_case(name))
}

fn statistics(name: &str) -> Option<Meaning> {
    match name {
        "Variance" => Some(Meaning::Variance { of_sample: true }),
        "variance" => Some(Meaning::Variance { of_sample: false }),
        _ => None,
    }
}

fn without_prefix(name: &str) -> &str {
    let prefixes = ["lpe:", "lpe_", "lpe.", "LPE:", "LPE_"];
    prefixes
        .iter()
        .find_map(|p| name.strip_prefix(p))
        .unwrap_or(name)
}

/// The classes for which something holds; `None` for none.
fn some(classes: &[PathClass], holds: impl Fn(&PathClass) -> bool) -> Option<Vec<usize>> {
    let found: Vec<usize> = (0..classes.len()).filter(|&i| holds(&classes[i])).collect();
    (!found.is_empty()).then_some(found)
}

/// Whether a class is one of those that a name stands for, in which `S` may be `R` or `T`.
pub fn is_one_of(class: &PathClass, named: &PathClass) -> bool {
    let fits = |a: &Chain, b: &Chain| {
        a.len() == b.len()
            && a.iter()
                .zip(b.iter())
                .all(|(x, y)| x == y || x == Specular::Any || y == Specular::Any)
    };
    class.diffuse == named.diffuse
        && fits(&class.eye, &named.eye)
        && fits(&class.light, &named.light)
}

fn by_program(layer: &str, last: &str, classes: &[PathClass]) -> Option<Meaning> {
    // Next to the camera.
    let first = |c: &PathClass| c.eye.iter().last();
    let is_via =
        |c: &PathClass, kind: Specular| first(c).is_some_and(|k| k == kind || k == Specular::Any);
    let is_direct = |c: &PathClass| c.eye.is_empty() && c.light.is_empty() && c.diffuse == 1;
    let is_indirect = |c: &PathClass| c.eye.is_empty() && !is_direct(c);
    let times = |holds: &dyn Fn(&PathClass) -> bool, factor: &str| {
        let factor = format!("{}{factor}", &layer[..layer.len() - last.len()]);
        some(classes, holds).map(|c| Meaning::Times(c, factor))
    };
    match last {
        "DIRECT_DIFFUSE" => some(classes, is_direct).map(Meaning::Classes),
        "INDIRECT_DIFFUSE" => some(classes, is_indirect).map(Meaning::Classes),
        "CAUSTIC" => some(classes, |c| c.eye.is_empty() && c.is_caustic()).map(Meaning::Classes),
        "INDIRECT_SPECULAR" => some(classes, |c| !c.eye.is_empty()).map(Meaning::Classes),
        "DiffDir" => times(&is_direct, "DiffCol"),
        "DiffInd" => times(&is_indirect, "DiffCol"),
        "GlossInd" => times(&|c| is_via(c, Specular::Reflection), "GlossCol"),
        "TransInd" => times(&|c| is_via(c, Specular::Transmission), "TransCol"),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn classes() -> Vec<PathClass> {
        ["LDE", "LSDE", "LDSE", "LSDSE"]
            .map(|c| c.parse().unwrap())
            .to_vec()
    }

    fn positions(layer: &str) -> Vec<usize> {
        match meaning(layer, &classes()) {
            Meaning::Classes(list) | Meaning::Times(list, _) => list,
            _ => Vec::new(),
        }
    }

    #[test]
    fn channels_have_layers_and_components() {
        assert_eq!(split("R"), ("", "R"));
        assert_eq!(split("LSDE.Y"), ("LSDE", "Y"));
        assert_eq!(split("View Layer.Combined.R"), ("View Layer.Combined", "R"));
        assert_eq!(split("C<.D>L.G"), ("C<.D>L", "G"));
        assert_eq!(split("LSDE"), ("LSDE", ""));
    }

    #[test]
    fn every_program_s_names_are_known() {
        for name in [
            "",
            "ViewLayer.Combined",
            "RGB",
            "rgba",
            "RGB_IMAGEPIPELINE",
            "image",
        ] {
            assert_eq!(meaning(name, &classes()), Meaning::Beauty, "{name}");
        }
        assert_eq!(positions("LDE"), [0]);
        assert_eq!(positions("path.LSDSE"), [3]);
        assert_eq!(positions("LTDE"), [1]);
        assert_eq!(positions("lpe:C<RD>L"), [0]);
        assert_eq!(positions("lpe_CS+DL"), [2]);
        assert_eq!(positions("DIRECT_DIFFUSE"), [0]);
        assert_eq!(positions("CAUSTIC"), [1]);
        assert_eq!(positions("INDIRECT_SPECULAR"), [2, 3]);
        let factor = "ViewLayer.DiffCol".to_owned();
        assert_eq!(
            meaning("ViewLayer.DiffInd", &classes()),
            Meaning::Times(vec![1], factor)
        );
        assert_eq!(
            meaning("m2_path", &classes()),
            Meaning::SecondMoment("path".to_owned())
        );
        assert_eq!(
            meaning("Variance", &classes()),
            Meaning::Variance { of_sample: true }
        );
        for name in ["Depth", "error", "LSSDE", "CL", "Albedo", "AOV_1"] {
            assert_eq!(meaning(name, &classes()), Meaning::Unknown, "{name}");
        }
    }
}
