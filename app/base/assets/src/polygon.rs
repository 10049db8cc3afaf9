//! Polygons to triangles.

use earcut::{Earcut, utils3d::project3d_to_2d};
use glam::{DVec2, Vec3};

/// Cuts polygons, convex or concave, into triangles by ear clipping.
#[derive(Default)]
pub(super) struct Triangulator {
    earcut: Earcut<f64>,
    flat: Vec<[f64; 2]>,
    triangles: Vec<u32>,
}

impl Triangulator {
    /// Returns triangles with the polygon's winding, as indices of their corners in `points`. A convex polygon becomes a
    /// fan, as does one without area or with coordinates that are not finite.
    pub(super) fn triangulate(&mut self, points: &[Vec3]) -> &[u32] {
        self.triangles.clear();
        let origin = points.first().map_or_else(Default::default, |p| p.as_dvec3());
        // In f64 relative to a corner: f32 loses small polygons far from the origin.
        let local: Vec<_> = points.iter().map(|p| (p.as_dvec3() - origin).to_array()).collect();
        let is_finite = points.iter().all(|p| p.is_finite());
        let has_area = points.len() > 3 && is_finite && project3d_to_2d(&local, local.len(), &mut self.flat);
        if has_area && !is_convex(&self.flat) {
            self.earcut.earcut(self.flat.iter().copied(), &[], &mut self.triangles);
        } else {
            self.triangles.extend((2..points.len() as u32).flat_map(|i| [0, i - 1, i]));
        }
        &self.triangles
    }
}

/// True if no corner of a counter-clockwise polygon turns to the right.
fn is_convex(points: &[[f64; 2]]) -> bool {
    let point = |i: usize| DVec2::from(points[i % points.len()]);
    (0..points.len()).all(|i| {
        let [a, b, c] = [point(i), point(i + 1), point(i + 2)];
        (b - a).perp_dot(c - b) >= 0.0
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cut(points: &[Vec3]) -> Vec<[usize; 3]> {
        let mut triangulator = Triangulator::default();
        let triangles = triangulator.triangulate(points);
        triangles.chunks_exact(3).map(|t| [0, 1, 2].map(|k| t[k] as usize)).collect()
    }

    fn area_vector(points: &[Vec3], t: [usize; 3]) -> Vec3 {
        let [a, b, c] = t.map(|i| points[i]);
        (b - a).cross(c - a) * 0.5
    }

    /// Triangles cover a planar polygon exactly if their areas add up and none is reversed.
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
        // Three teeth, along x from 0 to 5.
        let comb: Vec<[f32; 2]> =
            [(0., 0.), (5., 0.), (5., 3.), (4., 3.), (4., 1.), (3., 1.), (3., 3.), (2., 3.), (2., 1.)]
                .into_iter()
                .chain([(1., 1.), (1., 3.), (0., 3.)])
                .map(<[f32; 2]>::from)
                .collect();
        for axis in 0..3 {
            let lift = |p: &[f32; 2]| match axis {
                0 => Vec3::new(1.0, p[0], p[1]),
                1 => Vec3::new(p[0], 1.0, p[1]),
                _ => Vec3::new(p[0], p[1], 1.0),
            };
            covers(&l.iter().map(lift).collect::<Vec<_>>(), 3.0);
            covers(&comb.iter().map(lift).collect::<Vec<_>>(), 11.0);
            // Starts at each corner in turn, so that either diagonal must be chosen.
            let mut arrow: Vec<Vec3> = arrow.iter().map(lift).collect();
            for _ in 0..4 {
                covers(&arrow, 1.0);
                arrow.rotate_left(1);
            }
        }
    }

    #[test]
    fn polygons_without_an_inside_become_something() {
        let nan = vec![Vec3::NAN; 40];
        assert_eq!(cut(&nan).len(), 38);
        let same = vec![Vec3::ONE; 40];
        assert_eq!(cut(&same).len(), 38);
        let crossing: Vec<Vec3> =
            (0..200).map(|i| Vec3::new((i * 37 % 100) as f32, (i * 61 % 90) as f32, 0.0)).collect();
        // No triangles can cover such a polygon once, but the indices must be those of its corners.
        assert!(cut(&crossing).into_iter().flatten().all(|corner| corner < 200));
    }

    #[test]
    fn a_polygon_of_a_hundred_thousand_corners_is_covered_once() {
        let saw = (0..100_000).map(|i| Vec3::new((i % 7) as f32, i as f32, 0.0));
        let points: Vec<Vec3> = saw.chain([Vec3::new(-1.0, 1e5, 0.0), Vec3::NEG_X]).collect();
        let area = |t: [usize; 3]| f64::from(area_vector(&points, t).z);
        let (signed, unsigned) =
            cut(&points).into_iter().map(area).fold((0.0, 0.0), |(a, b), area| (a + area, b + area.abs()));
        let fan: f64 = (2..points.len()).map(|i| area([0, i - 1, i])).sum();
        assert!(
            (signed - fan).abs() < 1.0 && (unsigned - fan.abs()).abs() < 1.0,
            "{signed} {unsigned} {fan}"
        );
    }
}
