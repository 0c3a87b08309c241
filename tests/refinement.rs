//! A coarse image is the block mean of a fine one: pixels cut in different places must add up, in every class of every
//! entry. A missed edge, fold or jump of a footprint shows here.

use nephroid::entry;
use nephroid::truth;

#[test]
fn a_coarse_pixel_is_the_mean_of_the_fine_pixels_in_it() {
    for name in entry::names() {
        let mut scene = entry::load(name).unwrap();
        let mut images = Vec::new();
        for (size, tolerance) in [(30, 1e-8), (90, 1e-7)] {
            (scene.camera.width, scene.camera.height) = (size, size);
            images.push(truth::image(&scene, tolerance));
        }
        let (coarse, fine) = (&images[0], &images[1]);
        for (c, class) in coarse.classes.iter().enumerate() {
            let (mut worst, mut largest) = (0.0_f64, 0.0_f64);
            for j in 0..30 {
                for i in 0..30 {
                    let block = (0..9).map(|k| (3 * j + k / 3) * 90 + 3 * i + k % 3);
                    let mean = block.clone().map(|p| fine.layers[c][p]).sum::<f64>() / 9.0;
                    let error = block.map(|p| fine.errors[c][p]).sum::<f64>() / 9.0;
                    let p = j * 30 + i;
                    let difference = (coarse.layers[c][p] - mean).abs();
                    let bound = coarse.errors[c][p] + error;
                    worst = worst.max(difference);
                    largest = largest.max(coarse.layers[c][p]);
                    if !(difference <= 2.0 * bound + 1e-13) {
                        println!(
                            "{name} {class} ({i}, {j}): {} and {mean}, bound {bound:e}",
                            coarse.layers[c][p]
                        );
                    }
                }
            }
            println!("{name} {class}: worst {worst:e} of {largest}");
            assert!(
                worst <= 1e-7 * largest,
                "{name} {class}: {worst:e} of {largest}"
            );
        }
    }
}
