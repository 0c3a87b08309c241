//! Where a ray meets a quadric.

/// The zeros of a t² + 2 b t + c, without cancellation; infinite or NaN where there is none.
#[inline(always)]
pub fn zeros(a: f64, b: f64, c: f64) -> [f64; 2] {
    let root = f64::sqrt(b * b - a * c);
    // The sum in which nothing cancels, then the other zero from their product c/a.
    let q = if b < 0.0 { root - b } else { -(root + b) };
    [q / a, c / q]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn zeros_are_exact_where_they_nearly_cancel_and_where_one_is_infinite() {
        // (t - 1e8)(t - 1e-8)
        let [x, y] = zeros(1.0, -0.5 * (1e8 + 1e-8), 1.0);
        assert_eq!((x, y), (1e8, 1e-8));
        let [x, y] = zeros(0.0, 2.0, -3.0);
        assert!(x.is_infinite() && y == 0.75);
        assert!(zeros(1.0, 0.0, 1.0).iter().all(|t| t.is_nan()));
    }
}
