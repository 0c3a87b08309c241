//! Runs that write everything: one that passes, and one of a renderer that leaves out what is seen in a mirror.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;

use nephroid::entry;
use nephroid::exr_output::write_exr;
use nephroid::stream::{philox, uniform};
use nephroid::truth;

/// A directory that was written with `--report`, and the exit code.
pub struct Written {
    pub directory: PathBuf,
    pub code: i32,
}

impl Written {
    pub fn read(&self, name: &str) -> String {
        std::fs::read_to_string(self.directory.join(name)).unwrap()
    }
}

fn directory(name: &str) -> PathBuf {
    let path = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = std::fs::remove_dir_all(&path);
    std::fs::create_dir_all(&path).unwrap();
    path
}

/// Runs the program in a directory, with `--report out` there.
fn run(directory: &Path, arguments: &[String]) -> Written {
    let output = Command::new(env!("CARGO_BIN_EXE_nephroid"))
        .args(arguments)
        .args(["--report", "out"])
        .current_dir(directory)
        .output()
        .unwrap();
    Written {
        directory: directory.join("out"),
        code: output.status.code().unwrap(),
    }
}

/// `verify` of what is right, some of it not sampled.
pub fn verify_into(name: &str) -> Written {
    let words = "verify --scene floor --scene mirror-wall --integrator pt --margin 0.05";
    let arguments: Vec<String> = words.split(' ').map(str::to_owned).collect();
    run(&directory(name), &arguments)
}

pub fn verify() -> &'static Written {
    static WRITTEN: OnceLock<Written> = OnceLock::new();
    WRITTEN.get_or_init(|| verify_into("report-verify"))
}

/// `gate` of images without the classes that end in a mirror.
pub fn gate() -> &'static Written {
    static WRITTEN: OnceLock<Written> = OnceLock::new();
    WRITTEN.get_or_init(|| {
        let directory = directory("report-gate");
        let entry = entry::load("mirror-wall").unwrap();
        let exact = truth::image(&entry, 1e-4);
        let mut image = vec![0.0; exact.layers[0].len()];
        for (class, layer) in exact.classes.iter().zip(&exact.layers) {
            if !class.to_string().ends_with("SE") && !class.to_string().ends_with("DSE") {
                image.iter_mut().zip(layer).for_each(|(t, v)| *t += v);
            }
        }
        let mut arguments = vec!["gate".to_owned(), "mirror-wall".to_owned()];
        for k in 0..10_u32 {
            let noisy = |(i, v): (u32, &f64)| {
                let [a, b, ..] = philox([i, k, 0, 0], [3, 4]);
                v * (0.5 + uniform(a, b))
            };
            let values: Vec<f64> = (0..).zip(&image).map(noisy).collect();
            let name = format!("run-{k}.exr");
            let layers: Vec<_> = ["R", "G", "B"]
                .iter()
                .map(|c| ((*c).to_owned(), values.as_slice()))
                .collect();
            let (width, height) = (exact.width, exact.height);
            write_exr(&directory.join(&name), width, height, &layers, &[]).unwrap();
            arguments.push(name);
        }
        run(&directory, &arguments)
    })
}
