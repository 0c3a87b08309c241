//! Weighted least squares as linear functions of an image: which part each of some pictures has in it.
//!
//! If an image is Σ f_c P_c plus noise of mean zero, f = (P W Pᵀ)⁻¹ P W x has the expectation f for any weights W; so the
//! weights may be guessed (1 over the radiance, as for counts) without making the test wrong.

/// Least part of a picture, after the others are taken away, that must be left to tell it from them.
const LEAST_OWN: f64 = 1e-6;
/// Light where there is none, relative to the mean, for the weights.
const FLOOR: f64 = 0.02;

/// Weights of the pixels for an image that should be `truth`; none where it is not looked at.
pub fn weights(truth: &[f64], covered: &[bool]) -> Vec<f64> {
    let mean = truth.iter().sum::<f64>() / truth.len() as f64;
    let weight = |(t, c): (&f64, &bool)| {
        if *c {
            1.0 / (t + FLOOR * mean).max(f64::MIN_POSITIVE)
        } else {
            0.0
        }
    };
    truth.iter().zip(covered).map(weight).collect()
}

/// For each picture the pixel weights of the linear function that is its factor; `None` if one of them is (nearly) a sum of
/// the others.
pub fn factors(pictures: &[&[f64]], weights: &[f64]) -> Option<Vec<Vec<f64>>> {
    let n = pictures.len();
    let product = |a: &[f64], b: &[f64]| -> f64 {
        weights
            .iter()
            .zip(a)
            .zip(b)
            .map(|((w, x), y)| w * x * y)
            .sum()
    };
    let norms: Vec<f64> = pictures.iter().map(|p| libm::sqrt(product(p, p))).collect();
    if norms.iter().any(|n| !(*n > 0.0 && n.is_finite())) {
        return None;
    }
    let gram: Vec<Vec<f64>> = (0..n)
        .map(|i| {
            (0..n)
                .map(|j| product(pictures[i], pictures[j]) / (norms[i] * norms[j]))
                .collect()
        })
        .collect();
    let inverse = inverse(gram)?;
    let functional = |i: usize| -> Vec<f64> {
        let pixel = |p: usize| {
            let sum: f64 = (0..n)
                .map(|j| inverse[i][j] / (norms[i] * norms[j]) * pictures[j][p])
                .sum();
            weights[p] * sum
        };
        (0..weights.len()).map(pixel).collect()
    };
    Some((0..n).map(functional).collect())
}

/// Inverse of a symmetric matrix with ones on its diagonal; `None` if it is nearly singular.
fn inverse(mut a: Vec<Vec<f64>>) -> Option<Vec<Vec<f64>>> {
    let n = a.len();
    let mut b: Vec<Vec<f64>> = (0..n)
        .map(|i| (0..n).map(|j| f64::from(u8::from(i == j))).collect())
        .collect();
    for k in 0..n {
        // Positive definite: the diagonal is a good pivot, and what is left of it is the picture's own part.
        let pivot = a[k][k];
        if !(pivot > LEAST_OWN) {
            return None;
        }
        for j in 0..n {
            a[k][j] /= pivot;
            b[k][j] /= pivot;
        }
        for i in (0..n).filter(|&i| i != k) {
            let factor = a[i][k];
            for j in 0..n {
                a[i][j] -= factor * a[k][j];
                b[i][j] -= factor * b[k][j];
            }
        }
    }
    Some(b)
}

/// Central differences of an image along columns and rows; zero at the border of what is looked at.
pub fn gradients(image: &[f64], width: usize, covered: &[bool]) -> [Vec<f64>; 2] {
    let height = image.len() / width;
    let along = |step: usize, position: &dyn Fn(usize) -> usize, length: usize| -> Vec<f64> {
        let pixel = |i: usize| {
            let at = position(i);
            let inner = at > 0 && at + 1 < length;
            if inner && covered[i - step] && covered[i] && covered[i + step] {
                0.5 * (image[i + step] - image[i - step])
            } else {
                0.0
            }
        };
        (0..image.len()).map(pixel).collect()
    };
    [
        along(1, &|i| i % width, width),
        along(width, &|i| i / width, height),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn factors_are_found_and_mixtures_refused() {
        let a = [1.0, 2.0, 3.0, 0.0, 1.0];
        let b = [0.0, 1.0, 0.0, 2.0, 1.0];
        let c: Vec<f64> = (0..5).map(|i| a[i] + 2.0 * b[i]).collect();
        let w = weights(&c, &[true, true, true, true, false]);
        let found = factors(&[&a, &b], &w).unwrap();
        let image: Vec<f64> = (0..5).map(|i| 0.5 * a[i] + 3.0 * b[i]).collect();
        let value = |f: &Vec<f64>| f.iter().zip(&image).map(|(f, x)| f * x).sum::<f64>();
        assert!((value(&found[0]) - 0.5).abs() < 1e-12 && (value(&found[1]) - 3.0).abs() < 1e-12);
        assert_eq!(found[0][4], 0.0);
        assert_eq!(factors(&[&a, &b, &c], &w), None);
        assert_eq!(factors(&[&a, &[0.0; 5]], &w), None);
    }

    #[test]
    fn differences_are_those_of_a_plane() {
        let plane: Vec<f64> = (0..20)
            .map(|i| 2.0 * f64::from(i % 5) + 7.0 * f64::from(i / 5))
            .collect();
        let [x, y] = gradients(&plane, 5, &[true; 20]);
        assert_eq!((x[6], y[6]), (2.0, 7.0));
        assert_eq!((x[5], y[1]), (0.0, 0.0));
    }
}
