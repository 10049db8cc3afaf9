//! Polygons to triangles.

use std::collections::{HashMap, HashSet};

use earcut::{Earcut, utils3d::project3d_to_2d};
use glam::{DVec2, DVec3, Vec3};

/// Number of corners from which a polygon is examined for crossings.
const MANY: usize = 200;

/// Cuts polygons, convex or concave, into triangles by ear clipping.
#[derive(Default)]
pub(super) struct Triangulator {
    earcut: Earcut<f64>,
    flat: Vec<[f64; 2]>,
    triangles: Vec<u32>,
}

impl Triangulator {
    /// Returns triangles with the polygon's winding, as indices of their corners in `points`.
    ///
    /// A convex polygon becomes a fan, as does one without area or with coordinates that are not finite. One with many
    /// corners that winds over itself or crosses itself all over has no inside, takes ear clipping minutes, and covers
    /// itself a thousand times: it becomes the different triangles of a fan, or nothing if these still cover it too
    /// often to be drawn.
    pub(super) fn triangulate(&mut self, points: &[Vec3]) -> &[u32] {
        self.triangles.clear();
        let origin = points.first().map_or_else(Default::default, |p| p.as_dvec3());
        // In f64 relative to a corner: f32 loses small polygons far from the origin.
        let local: Vec<_> = points.iter().map(|p| (p.as_dvec3() - origin).to_array()).collect();
        let is_finite = points.iter().all(|p| p.is_finite());
        let has_area = points.len() > 3 && is_finite && project3d_to_2d(&local, local.len(), &mut self.flat);
        // Of many corners, those without area are in a line, or cancel one another.
        let cancels = is_finite && points.len() >= MANY && !has_area;
        if cancels || has_area && is_tangled(&self.flat) {
            self.triangles.extend(different_triangles(&local).into_iter().flatten());
        } else if has_area && !is_convex(&self.flat) {
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

/// Returns the triangles of a fan that differ in the places of their corners, or nothing if together they cover more
/// than [`MAX_COVERED`] times the box around the polygon.
fn different_triangles(points: &[[f64; 3]]) -> Vec<[u32; 3]> {
    const MAX_COVERED: f64 = 32.0;
    let mut known = HashMap::new();
    let places: Vec<usize> = points
        .iter()
        .map(|p| {
            let next = known.len();
            *known.entry(p.map(f64::to_bits)).or_insert(next)
        })
        .collect();
    let point = |i: u32| DVec3::from(points[i as usize]);
    let mut seen = HashSet::new();
    let (mut triangles, mut covered) = (Vec::new(), 0.0);
    for i in 2..points.len() as u32 {
        let triangle = [0, i - 1, i];
        let mut corners = triangle.map(|i| places[i as usize]);
        let first = (0..3).min_by_key(|&k| corners[k]).unwrap_or(0);
        corners.rotate_left(first);
        let [a, b, c] = corners;
        if a != b && b != c && a != c && seen.insert(corners) {
            covered += 0.5 * (point(i - 1) - point(0)).cross(point(i) - point(0)).length();
            triangles.push(triangle);
        }
    }
    let all = || points.iter().copied().map(DVec3::from);
    let size = all().reduce(DVec3::max).unwrap_or_default() - all().reduce(DVec3::min).unwrap_or_default();
    let largest_side = (size.x * size.y).max(size.y * size.z).max(size.x * size.z);
    if covered > MAX_COVERED * largest_side { Vec::new() } else { triangles }
}

/// True if a polygon has many corners and either goes round more than once, or has a crossing for every eighth edge.
fn is_tangled(points: &[[f64; 2]]) -> bool {
    if points.len() < MANY {
        return false;
    }
    let mut ends: Vec<DVec2> = points.iter().copied().map(DVec2::from).collect();
    ends.dedup();
    while ends.len() > 1 && ends.first() == ends.last() {
        ends.pop();
    }
    let edge = |i: usize| ends[(i + 1) % ends.len()] - ends[i % ends.len()];
    let turns: f64 = (0..ends.len()).map(|i| edge(i).angle_to(edge(i + 1))).sum();
    turns.abs() > 1.5 * std::f64::consts::TAU || crosses_often(&ends, points.len() / 8)
}

/// True if the edges of a polygon cross more than `limit` times, as far as that is found in a few million comparisons.
fn crosses_often(ends: &[DVec2], limit: usize) -> bool {
    let count = ends.len();
    let edges = (0..count).map(|i| [ends[i], ends[(i + 1) % count]]);
    let extent = edges.clone().map(|[a, b]| (b - a).abs()).sum::<DVec2>();
    // Edges are compared if they overlap along the axis along which they are short.
    let axis = usize::from(extent.y < extent.x);
    let mut edges: Vec<[DVec2; 2]> = edges.collect();
    let low = |edge: &[DVec2; 2]| edge[0][axis].min(edge[1][axis]);
    edges.sort_by(|a, b| low(a).total_cmp(&low(b)));
    let side = |[a, b]: [DVec2; 2], p: DVec2| (b - a).perp_dot(p - a);
    let cross = |a: [DVec2; 2], b: [DVec2; 2]| {
        side(a, b[0]) * side(a, b[1]) < 0.0 && side(b, a[0]) * side(b, a[1]) < 0.0
    };
    let (mut found, mut comparisons) = (0, 0);
    for (i, &edge) in edges.iter().enumerate() {
        let high = edge[0][axis].max(edge[1][axis]);
        for &other in edges[i + 1..].iter().take_while(|other| low(other) < high) {
            found += usize::from(cross(edge, other));
            comparisons += 1;
            if found > limit || comparisons > 1 << 24 {
                return found > limit;
            }
        }
    }
    false
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
            // Starts at each corner in turn, so that either diagonal must be chosen.
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
        // No triangles can cover such a polygon once, but the indices must be those of its corners.
        assert!(cut(&crossing).into_iter().flatten().all(|corner| corner < 200));
        // With ear clipping, these took from 5 s to a minute.
        let square = [Vec3::ZERO, Vec3::X, Vec3::new(1.0, 1.0, 0.0), Vec3::Y];
        let wound = square.repeat(1000);
        let star = (0..2001).map(|i| {
            let angle = i as f32 * 1000.0 / 2001.0 * std::f32::consts::TAU;
            Vec3::new(angle.cos(), angle.sin(), 0.0)
        });
        let crossed = (0..3000).map(|i| Vec3::new((i % 2) as f32, i as f32 * 1e-3, 0.0));
        for (points, count) in [(wound, 2), (star.collect(), 0), (crossed.collect(), 0)] {
            assert_eq!(cut(&points).len(), count);
        }
        // A ring whose hole is joined to its rim by a cut is no tangle.
        let circle = |radius: f32, turn: f32| {
            (0..=200)
                .map(move |i| i as f32 / 200.0 * std::f32::consts::TAU * turn)
                .map(move |a| [a.cos() * radius, a.sin() * radius])
        };
        let ring: Vec<[f64; 2]> =
            circle(2.0, 1.0).chain(circle(1.0, -1.0)).map(|p| p.map(f64::from)).collect();
        assert!(!is_tangled(&ring));
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
