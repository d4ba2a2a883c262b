//! The Pareto frontier of points in two quantities.

/// The indices of the points on the Pareto frontier: no other point is at most as large in both numbers. Sorted by the
/// first number, smallest first. Of equal points only the first one counts; points that are not finite never count.
pub fn frontier(points: &[(f64, f64)]) -> Vec<usize> {
    let mut order: Vec<usize> =
        (0..points.len()).filter(|&i| points[i].0.is_finite() && points[i].1.is_finite()).collect();
    // The sort is stable, so of equal points the first one stays first.
    order.sort_by(|&a, &b| {
        let ((a0, a1), (b0, b1)) = (points[a], points[b]);
        a0.total_cmp(&b0).then(a1.total_cmp(&b1))
    });
    let mut best = f64::INFINITY;
    order.retain(|&i| {
        let better = points[i].1 < best;
        best = best.min(points[i].1);
        better
    });
    order
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_beaten_is_left_out() {
        let points = [(3.0, 1.0), (1.0, 3.0), (2.0, 2.0), (3.0, 3.0), (2.0, 2.5), (1.5, 3.0)];
        assert_eq!(frontier(&points), [1, 2, 0]);
    }

    #[test]
    fn of_equal_points_the_first_counts() {
        assert_eq!(frontier(&[(1.0, 1.0), (1.0, 1.0)]), [0]);
        assert_eq!(frontier(&[(2.0, 0.0), (1.0, 0.0), (3.0, 0.0)]), [1]);
        assert_eq!(frontier(&[(0.0, -0.0), (0.0, 0.0)]), [0]);
    }

    #[test]
    fn nothing_and_what_is_not_finite() {
        assert_eq!(frontier(&[]), [0; 0]);
        assert_eq!(frontier(&[(f64::NAN, 0.0), (1.0, f64::INFINITY), (5.0, 5.0)]), [2]);
    }

    #[test]
    fn every_point_is_on_it_or_beaten_by_it() {
        let mut state = 1_u32;
        let mut next = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            f64::from(state >> 28)
        };
        for _ in 0..50 {
            let points: Vec<(f64, f64)> = (0..20).map(|_| (next(), next())).collect();
            let best = frontier(&points);
            for (i, point) in points.iter().enumerate() {
                let beaten = best.iter().any(|&j| points[j].0 <= point.0 && points[j].1 <= point.1);
                assert!(beaten, "{point:?} at {i} is neither on the frontier nor beaten");
            }
            for pair in best.windows(2) {
                assert!(points[pair[0]].0 < points[pair[1]].0 && points[pair[0]].1 > points[pair[1]].1);
            }
        }
    }
}
