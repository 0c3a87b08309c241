//! Seconds for the exact image of every entry at the default tolerance, on all cores, and how they grow with the pixels:
//! `cargo bench --bench images -- [SCENE]...`.

use std::time::Instant;

use nephroid::{entry, truth};

const SIDES: [u32; 3] = [128, 256, 512];

fn main() {
    let only: Vec<String> = std::env::args()
        .skip(1)
        .filter(|a| !a.starts_with('-'))
        .collect();
    println!(
        "seconds of wall time on {} threads, tolerance {:e}; last column: 512² over 128², 16 if linear in the pixels",
        rayon::current_num_threads(),
        truth::DEFAULT_TOLERANCE
    );
    for name in entry::names() {
        if !only.is_empty() && !only.iter().any(|n| n == name) {
            continue;
        }
        let mut scene = match entry::load(name) {
            Ok(scene) => scene,
            Err(error) => {
                eprintln!("{error}");
                continue;
            }
        };
        let seconds = SIDES.map(|side| {
            (scene.camera.width, scene.camera.height) = (side, side);
            let start = Instant::now();
            std::hint::black_box(truth::image(&scene, truth::DEFAULT_TOLERANCE));
            start.elapsed().as_secs_f64()
        });
        println!(
            "{name:<13} 128²: {:6.3}  256²: {:6.3}  512²: {:6.3}  ratio {:5.1}",
            seconds[0],
            seconds[1],
            seconds[2],
            seconds[2] / seconds[0]
        );
    }
}
