//! A renderer that is right but for noise: the exact image, with a mistake if one is asked for, times noise of mean 1.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;

use nephroid::entry;
use nephroid::exr_output::write_exr;
use nephroid::stream::{philox, uniform};
use nephroid::truth::{self, TruthImage};
use nephroid_analytic::scene::Entry;
use serde_json::Value;

/// An image: `[row * width + column]`.
pub type Image = Vec<f64>;

/// A scene with its exact image.
pub struct Scene {
    pub entry: Entry,
    pub truth: TruthImage,
}

impl Scene {
    pub fn new(argument: &str) -> Self {
        let entry = entry::load(argument).unwrap();
        let truth = truth::image(&entry, 1e-4);
        Scene { entry, truth }
    }

    pub fn size(&self) -> (u32, u32) {
        (self.truth.width, self.truth.height)
    }

    /// The sum of the classes of these names.
    pub fn sum(&self, classes: &[&str]) -> Image {
        let mut total = vec![0.0; self.truth.layers[0].len()];
        for (class, layer) in self.truth.classes.iter().zip(&self.truth.layers) {
            if classes.contains(&class.to_string().as_str()) {
                total.iter_mut().zip(layer).for_each(|(t, v)| *t += v);
            }
        }
        total
    }

    pub fn names(&self) -> Vec<String> {
        self.truth.classes.iter().map(ToString::to_string).collect()
    }

    pub fn all(&self) -> Image {
        self.truth.total().0
    }

    /// Files `<name>-<k>.exr` with grey R, G and B.
    pub fn beauty(&self, name: &str, image: &[f64], files: u32) -> Vec<String> {
        self.beauty_with(name, image, files, |v| v)
    }

    /// The same with what is done to each noisy value.
    pub fn beauty_with(
        &self,
        name: &str,
        image: &[f64],
        files: u32,
        done: impl Fn(f64) -> f64,
    ) -> Vec<String> {
        (0..files)
            .map(|k| {
                let noisy: Image = noisy(image, k).into_iter().map(&done).collect();
                let layers = ["R", "G", "B"].map(|c| (c.to_owned(), noisy.as_slice()));
                let path = file(&format!("{name}-{k}.exr"));
                write_exr(&path, self.truth.width, self.truth.height, &layers, &[]).unwrap();
                shown(&path)
            })
            .collect()
    }

    /// Files with a layer for each class, each changed by `of`.
    pub fn layers(
        &self,
        name: &str,
        files: u32,
        of: impl Fn(&str, &[f64]) -> Option<Image>,
    ) -> Vec<String> {
        (0..files)
            .map(|k| {
                let mut layers = Vec::new();
                for (c, (class, layer)) in self.names().iter().zip(&self.truth.layers).enumerate() {
                    if let Some(image) = of(class, layer) {
                        layers.push((
                            format!("{class}.Y"),
                            noisy(&image, 1000 * (c as u32 + 1) + k),
                        ));
                    }
                }
                let views: Vec<_> = layers
                    .iter()
                    .map(|(n, v)| (n.clone(), v.as_slice()))
                    .collect();
                let path = file(&format!("{name}-{k}.exr"));
                write_exr(&path, self.truth.width, self.truth.height, &views, &[]).unwrap();
                shown(&path)
            })
            .collect()
    }
}

/// `mirror-wall`, computed once.
pub fn mirror_wall() -> &'static Scene {
    static SCENE: OnceLock<Scene> = OnceLock::new();
    SCENE.get_or_init(|| Scene::new("mirror-wall"))
}

/// The relative standard deviation of a pixel's noise.
pub const NOISE: f64 = 0.125;

/// Each pixel times an exponential variable of little weight: skewed, as light is.
pub fn noisy(image: &[f64], seed: u32) -> Image {
    let pixel = |(i, v): (usize, &f64)| {
        let [a, b, ..] = philox([i as u32, seed, 0, 0], [2026, 7]);
        v * (1.0 + NOISE * (-libm::log(1.0 - uniform(a, b)) - 1.0))
    };
    image.iter().enumerate().map(pixel).collect()
}

pub fn file(name: &str) -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("gate-{name}"))
}

pub fn shown(path: &Path) -> String {
    path.to_str().unwrap().to_owned()
}

/// Exit code, standard output and standard error, with runs of white space as one blank.
pub fn nephroid(args: &[String]) -> (i32, String, String) {
    let output = Command::new(env!("CARGO_BIN_EXE_nephroid"))
        .args(args)
        .output()
        .unwrap();
    let text = |bytes: Vec<u8>| {
        let text = String::from_utf8(bytes).unwrap().replace('│', " ");
        text.split_whitespace().collect::<Vec<_>>().join(" ")
    };
    (
        output.status.code().unwrap(),
        text(output.stdout),
        text(output.stderr),
    )
}

/// `nephroid gate` on a scene and files, with options.
pub fn gate(scene: &str, files: &[String], options: &[&str]) -> (i32, String, String) {
    let mut args = vec!["gate".to_owned(), scene.to_owned()];
    args.extend(files.iter().cloned());
    args.extend(options.iter().map(|o| (*o).to_owned()));
    nephroid(&args)
}

/// The same as JSON.
pub fn json(scene: &str, files: &[String], options: &[&str]) -> (i32, Value) {
    let mut options = options.to_vec();
    options.push("--json");
    let (code, out, err) = gate(scene, files, &options);
    (
        code,
        serde_json::from_str(&out).unwrap_or_else(|e| panic!("{e}: {out} {err}")),
    )
}

/// The verdict on a class.
pub fn verdict<'a>(answer: &'a Value, class: &str) -> &'a Value {
    let list = answer["verdicts"].as_array().unwrap();
    list.iter()
        .find(|v| v["class"] == class)
        .unwrap_or_else(|| panic!("{class}: {answer:#}"))
}

/// The state of the verdict on a class.
pub fn state(answer: &Value, class: &str) -> String {
    verdict(answer, class)["state"].as_str().unwrap().to_owned()
}

/// What the verdict on a class looks like.
pub fn looks_like(answer: &Value, class: &str) -> String {
    verdict(answer, class)["looks_like"]
        .as_str()
        .unwrap_or_default()
        .to_owned()
}
