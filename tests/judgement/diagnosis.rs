//! The patterns of a residual image, on pictures made by hand: each is told from all the others, and noise from a pattern.

use libm::pow;
use nephroid::diagnosis::covariates::Covariate;
use nephroid::diagnosis::patterns::{Pattern, Residual};
use nephroid::stream::{philox, uniform};

const WIDTH: usize = 32;

fn picture() -> Vec<f64> {
    (0..WIDTH * WIDTH)
        .map(|i| {
            let (x, y) = ((i % WIDTH) as f64, (i / WIDTH) as f64);
            let spot = (x - 20.0) * (x - 20.0) + (y - 9.0) * (y - 9.0) < 30.0;
            1.0 + 0.03 * x + 0.01 * y + if spot { 3.0 } else { 0.0 }
        })
        .collect()
}

fn cosine() -> Covariate {
    Covariate {
        name: "the cosine at the receiver",
        values: (0..WIDTH * WIDTH)
            .map(|i| 1.0 - 0.015 * (i % WIDTH) as f64)
            .collect(),
    }
}

/// Noise of 1 % of each pixel.
fn noisy(image: &[f64]) -> (Vec<f64>, Vec<f64>) {
    let measured = image.iter().enumerate().map(|(i, &v)| {
        let [a, b, c, d] = philox([i as u32, 0, 4, 0], [8, 9]);
        v * (1.0 + 0.01 * libm::sqrt(6.0) * (uniform(a, b) + uniform(c, d) - 1.0))
    });
    (
        measured.collect(),
        image.iter().map(|v| 1e-4 * v * v).collect(),
    )
}

fn found(image: &[f64]) -> Option<Pattern> {
    let (measured, variance) = noisy(image);
    let truth = picture();
    let residual = Residual::new(WIDTH, &measured, &truth, &variance)?;
    residual.best(&[cosine()], |_| false).map(|f| f.pattern)
}

#[test]
fn each_pattern_is_told_from_the_others() {
    let truth = picture();
    let cosines = cosine().values;
    let at = |x: i64, y: i64| {
        let inside = x >= 0 && y >= 0;
        if inside {
            truth[y as usize * WIDTH + x as usize]
        } else {
            0.0
        }
    };
    let of = |f: &dyn Fn(usize) -> f64| -> Vec<f64> { (0..truth.len()).map(f).collect() };
    assert_eq!(found(&truth), None);
    assert_eq!(found(&of(&|i| 0.6 * truth[i])), Some(Pattern::Constant));
    for power in [1, -1, 2] {
        let image = of(&|i| truth[i] * pow(cosines[i], f64::from(power)));
        match found(&image) {
            Some(Pattern::Power(_, p, [factor, error])) => {
                assert!(p == power && (factor - 1.0).abs() < 5.0 * error, "{factor}");
            }
            other => panic!("{power}: {other:?}"),
        }
    }
    let low = of(&|i| at((i % WIDTH) as i64, (i / WIDTH) as i64 - 1));
    assert_eq!(found(&low), Some(Pattern::Shift(0.0, 1.0)));
    let flipped = of(&|i| truth[(WIDTH - 1 - i / WIDTH) * WIDTH + i % WIDTH]);
    assert_eq!(found(&flipped), Some(Pattern::Flip(false, true)));
    let lost = of(&|i| {
        if i % WIDTH == WIDTH - 1 {
            0.0
        } else {
            truth[i]
        }
    });
    let at_frame = found(&lost);
    assert!(matches!(at_frame, Some(Pattern::Frame(_))), "{at_frame:?}");
    let clamped = of(&|i| truth[i].min(3.0));
    assert!(matches!(found(&clamped), Some(Pattern::Bright(f)) if f < 0.8));
}
