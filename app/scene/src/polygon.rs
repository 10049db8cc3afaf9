//! Polygons to triangles.

use glam::{DVec2, DVec3, Vec3};

/// Corners above which a polygon is cut as a fan: ear clipping takes the square of the number.
const MAX_CLIPPED: usize = 1024;

/// Cuts a polygon, convex or concave, into `n - 2` triangles with its own winding; corners are given to `emit` by
/// their place in `points`.
pub(super) fn triangulate(points: &[Vec3], mut emit: impl FnMut([usize; 3])) {
    let n = points.len();
    if n <= 3 {
        if n == 3 {
            emit([0, 1, 2]);
        }
        return;
    }
    let flat = project(points);
    let turn = |a: usize, b: usize, c: usize| (flat[b] - flat[a]).perp_dot(flat[c] - flat[b]);
    if n == 4 {
        // The second diagonal only where the first lies outside the polygon.
        if turn(0, 1, 2) < 0.0 || turn(2, 3, 0) < 0.0 {
            emit([0, 1, 3]);
            emit([1, 2, 3]);
        } else {
            emit([0, 1, 2]);
            emit([0, 2, 3]);
        }
        return;
    }
    let reflex = |prev, here, next| turn(prev, here, next) < 0.0;
    if n > MAX_CLIPPED || (0..n).all(|i| !reflex((i + n - 1) % n, i, (i + 1) % n)) {
        for i in 1..n - 1 {
            emit([0, i, i + 1]);
        }
        return;
    }
    let mut ring: Vec<usize> = (0..n).collect();
    let mut at = 0;
    // A simple polygon takes two to three tests a corner; one that crosses itself may never give an ear.
    let mut tests_left = 8 * n;
    while ring.len() > 3 {
        let m = ring.len();
        let i = at % m;
        let (a, b, c) = (ring[(i + m - 1) % m], ring[i], ring[(i + 1) % m]);
        let ear = tests_left > 0
            && turn(a, b, c) > 0.0
            && ring
                .iter()
                .all(|&p| p == a || p == b || p == c || !inside(flat[p], flat[a], flat[b], flat[c]));
        if ear || tests_left == 0 {
            emit([a, b, c]);
            ring.remove(i);
        }
        tests_left = tests_left.saturating_sub(1);
        // Also after a cut: clipping on at the same corner makes long thin fans.
        at = i + 1;
    }
    emit([ring[0], ring[1], ring[2]]);
}

/// Drops the axis that the polygon's normal (Newell's method) points along most, keeping it counter-clockwise.
fn project(points: &[Vec3]) -> Vec<DVec2> {
    let origin = points[0].as_dvec3();
    let mut normal = DVec3::ZERO;
    for (i, p) in points.iter().enumerate() {
        let (a, b) = (p.as_dvec3() - origin, points[(i + 1) % points.len()].as_dvec3() - origin);
        let (d, s) = (a - b, a + b);
        normal += DVec3::new(d.y * s.z, d.z * s.x, d.x * s.y);
    }
    let size = normal.abs();
    points
        .iter()
        .map(|p| {
            let p = p.as_dvec3();
            if size.x >= size.y && size.x >= size.z {
                DVec2::new(p.y * normal.x.signum(), p.z)
            } else if size.y >= size.z {
                DVec2::new(p.z * normal.y.signum(), p.x)
            } else {
                DVec2::new(p.x * normal.z.signum(), p.y)
            }
        })
        .collect()
}

fn inside(p: DVec2, a: DVec2, b: DVec2, c: DVec2) -> bool {
    let side = |u: DVec2, v: DVec2| (v - u).perp_dot(p - u);
    // A corner of the ring that coincides with a corner of the ear (a keyhole) does not block it.
    p != a && p != b && p != c && side(a, b) >= 0.0 && side(b, c) >= 0.0 && side(c, a) >= 0.0
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cut(points: &[Vec3]) -> Vec<[usize; 3]> {
        let mut out = Vec::new();
        triangulate(points, |t| out.push(t));
        out
    }

    fn area_vector(points: &[Vec3], t: [usize; 3]) -> Vec3 {
        let [a, b, c] = t.map(|i| points[i]);
        (b - a).cross(c - a) * 0.5
    }

    /// Triangles cover a planar polygon exactly when the areas add up with none of them turned over.
    fn covers(points: &[Vec3], area: f32) {
        for turned in [false, true] {
            let mut points = points.to_vec();
            if turned {
                points.reverse();
            }
            let triangles = cut(&points);
            assert_eq!(triangles.len(), points.len() - 2);
            let total: Vec3 = triangles.iter().map(|&t| area_vector(&points, t)).sum();
            let sum: f32 = triangles.iter().map(|&t| area_vector(&points, t).length()).sum();
            assert!(
                (total.length() - area).abs() < 1e-4 && (sum - area).abs() < 1e-4,
                "{total} {sum}, not {area}"
            );
        }
    }

    #[test]
    fn concave_polygons_are_covered_once() {
        let l = [[0., 0.], [2., 0.], [2., 1.], [1., 1.], [1., 2.], [0., 2.]];
        let arrow = [[0., 0.], [2., 1.], [0., 2.], [1., 1.]];
        let comb = [
            [0., 0.],
            [5., 0.],
            [5., 3.],
            [4., 3.],
            [4., 1.],
            [3., 1.],
            [3., 3.],
            [2., 3.],
            [2., 1.],
            [1., 1.],
            [1., 3.],
            [0., 3.],
        ];
        for axis in 0..3 {
            let lift = |p: &[f32; 2]| match axis {
                0 => Vec3::new(1.0, p[0], p[1]),
                1 => Vec3::new(p[0], 1.0, p[1]),
                _ => Vec3::new(p[0], p[1], 1.0),
            };
            covers(&l.iter().map(lift).collect::<Vec<_>>(), 3.0);
            covers(&comb.iter().map(lift).collect::<Vec<_>>(), 11.0);
            // Every corner first, so that either diagonal must be chosen.
            let mut arrow: Vec<Vec3> = arrow.iter().map(lift).collect();
            for _ in 0..4 {
                covers(&arrow, 1.0);
                arrow.rotate_left(1);
            }
        }
    }

    #[test]
    fn hostile_polygons_end() {
        let nan = vec![Vec3::NAN; 40];
        assert_eq!(cut(&nan).len(), 38);
        let same = vec![Vec3::ONE; 40];
        assert_eq!(cut(&same).len(), 38);
        let crossing: Vec<Vec3> =
            (0..200).map(|i| Vec3::new((i * 37 % 100) as f32, (i * 61 % 90) as f32, 0.0)).collect();
        assert_eq!(cut(&crossing).len(), 198);
        let large: Vec<Vec3> = (0..100_000).map(|i| Vec3::new((i % 7) as f32, i as f32, 0.0)).collect();
        assert_eq!(cut(&large).len(), 99_998);
    }
}
