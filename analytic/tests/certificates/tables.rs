//! The certificates against the committed 30-digit tables: every value of every point and view lies in its enclosure,
//! which is narrow away from singularities, and the number of rays of each class is proven.

use nephroid_analytic::certificate::claims::Claim;
use nephroid_analytic::certificate::scene::Scene;
use nephroid_analytic::certificate::source::Source;
use nephroid_analytic::enclosure::Enclosure;
use nephroid_analytic::scalar::Scalar;
use serde_json::Value;

/// A JSON object as a source of decimals.
struct Json<'a>(&'a Value);

impl Source for Json<'_> {
    fn text(&self, key: &str, indices: &[usize]) -> Option<String> {
        let at = key.split('.').try_fold(self.0, |v, k| v.get(k))?;
        match indices.iter().try_fold(at, |v, i| v.get(i))? {
            Value::String(s) => Some(s.clone()),
            Value::Number(n) => Some(n.to_string()),
            _ => None,
        }
    }
}

/// What a table's comparison has seen.
#[derive(Debug, Default)]
struct Tally {
    compared: u32,
    counted: u32,
    undecided: Vec<String>,
    /// Largest relative width of a value whose relative change per rounding is ordinary.
    widest: (f64, String),
}

impl Tally {
    /// Compares every value of `item` that a claim has the name of.
    fn check(&mut self, item: &Value, claims: &[Claim]) {
        let id = item["id"].as_str().expect("an id");
        assert!(!claims.is_empty(), "{id}: nothing certified");
        for (key, value) in item.as_object().expect("an object") {
            let radiometric = key.starts_with(['E', 'L'])
                || key == "T"
                || key == "specular_weight"
                || key.starts_with("fluence");
            if radiometric {
                self.compare(id, key, value, claims);
            }
        }
        for path in item
            .get("paths")
            .and_then(Value::as_array)
            .into_iter()
            .flatten()
        {
            // Claims do not tell reflection from refraction.
            let class = path["class"].as_str().expect("a class");
            let class = class.replace(['R', 'T'], "S");
            self.compare(id, &format!("paths.{class}.E"), &path["E"], claims);
            let roots = path["roots"].as_array().expect("roots");
            self.compare_roots(id, &format!("paths.{class}.roots."), "E", roots, claims);
        }
        if let Some(roots) = item.get("roots").and_then(Value::as_array) {
            self.compare_roots(id, "roots.", "E", roots, claims);
            self.compare_roots(id, "roots.", "fluence", roots, claims);
        }
    }

    fn compare(&mut self, id: &str, key: &str, value: &Value, claims: &[Claim]) {
        let text = value.as_str().expect("a decimal");
        let claim = claims.iter().find(|c| c.key == key);
        let certified = claim
            .unwrap_or_else(|| panic!("{id} {key}: no claim"))
            .certified;
        let exact = Enclosure::from_decimal(text).expect("a decimal");
        assert!(
            certified.value.intersection(exact).is_some(),
            "{id} {key}: {text} is not in {certified:?}"
        );
        self.compared += 1;
        if certified.undecided {
            self.undecided.push(format!("{id} {key}"));
        } else if exact != Enclosure::ZERO {
            let width = certified.value.relative_width();
            if width > self.widest.0 {
                self.widest = (width, format!("{id} {key}"));
            }
        } else {
            assert!(certified.value.contains(0.0), "{id} {key} {certified:?}");
        }
    }

    /// The listed roots and the claimed rays are the same numbers, in any order.
    fn compare_roots(
        &mut self,
        id: &str,
        prefix: &str,
        key: &str,
        roots: &[Value],
        claims: &[Claim],
    ) {
        let mut rays: Vec<_> = claims
            .iter()
            .filter(|c| c.key.starts_with(prefix) && c.key.ends_with(&format!(".{key}")))
            .map(|c| c.certified)
            .collect();
        if rays.iter().any(|r| r.undecided) {
            return;
        }
        assert_eq!(rays.len(), roots.len(), "{id} {prefix}: {rays:?}");
        self.counted += rays.len() as u32;
        let mut listed: Vec<_> = roots
            .iter()
            .map(|r| Enclosure::from_decimal(r[key].as_str().expect(key)).expect(key))
            .collect();
        listed.sort_by(|a, b| a.low().total_cmp(&b.low()));
        rays.sort_by(|a, b| a.value.low().total_cmp(&b.value.low()));
        for (ray, exact) in rays.iter().zip(listed) {
            assert!(
                ray.value.intersection(exact).is_some(),
                "{id} {prefix}: {exact:?} {ray:?}"
            );
        }
    }
}

fn table(text: &str) -> Tally {
    let file: Value = serde_json::from_str(text).expect("JSON");
    let name = file["scene"].as_str().expect("a scene");
    let mut tally = Tally::default();
    for c in file["configurations"].as_array().expect("configurations") {
        let scene = Scene::read(name, &Json(&c["parameters"])).expect("a scene");
        let mut rows = 0;
        for point in c["points"].as_array().expect("points") {
            tally.check(point, &scene.point_enclosed(&Json(point)));
            rows += 1;
        }
        for view in c
            .get("views")
            .and_then(Value::as_array)
            .into_iter()
            .flatten()
        {
            tally.check(view, &scene.view_enclosed(&Json(view)));
        }
        assert!(rows > 0);
    }
    println!("{name}: {tally:?}");
    tally
}

macro_rules! tables {
    ($($test:ident $file:literal $widest:literal $compared:literal $counted:literal;)*) => {
        $(
            #[test]
            fn $test() {
                let tally = table(include_str!(concat!("../../../golden/reference/", $file, ".json")));
                assert!(tally.widest.0 <= $widest, "{tally:?}");
                assert_eq!((tally.compared, tally.counted), ($compared, $counted), "{tally:?}");
            }
        )*
    };
}

// Allowed relative width, number of compared values, number of proven rays.
tables! {
    diffuse "diffuse" 1e-14 66 8;
    planar_mirror "planar-mirror" 1e-13 218 34;
    planar_chains "planar-chains" 1e-13 216 204;
    paraboloid "paraboloid" 1e-13 75 23;
    conic_mirrors "conic-mirrors" 1e-13 96 24;
    flat_interface "flat-interface" 1e-12 206 37;
    glass_slab "glass-slab" 1e-12 144 60;
    cylinder_cup "cylinder-cup" 1e-10 370 158;
    concave_sphere "concave-sphere" 1e-7 231 58;
    convex_sphere "convex-sphere" 1e-12 107 18;
    glass_sphere "glass-sphere" 1e-7 78 36;
    water_waves "water-waves" 1e-10 99 36;
    stigmatic_refractors "stigmatic-refractors" 1e-12 72 24;
    pillar "pillar" 1e-12 105 11;
    conic_wall "conic-wall" 1e-10 280 76;
    glass_pillar "glass-pillar" 1e-10 251 52;
}
