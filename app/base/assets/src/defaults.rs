//! Viewpoints and skies for models whose files have none.

use std::f32::consts::TAU;

use glam::{Vec2, Vec3};

use super::model::{Bounds, Model, Sky, Viewpoint};
use super::rays::Rays;

/// Number of viewpoints generated for a file without `camera.json`.
const COUNT: usize = 8;

/// Height of the eyes above the floor in metres.
const EYE_HEIGHT: f32 = 1.6;

/// Models smaller than this, in metres, are viewed from around them.
const ROOM: f32 = 3.0;

/// `LEAST_SEEN` is the share of a 60 degree view that must show the model. `LEAST_FLOOR` is the share of the downward
/// rays around a place that must hit something; with fewer hits it is the top of an object, not a place to walk.
const LEAST_SEEN: f32 = 0.3;
const LEAST_FLOOR: f32 = 0.5;

/// Returns viewpoints and a short description of how they were found. Models larger than a few metres are walked
/// through, where there is a floor with headroom and something to see around it. Smaller models are circled, as are
/// those without such places, or of which a walk would show too little.
pub(super) fn viewpoints(model: &Model, rays: &Rays) -> (Vec<Viewpoint>, &'static str) {
    let bounds = model.bounds();
    if (bounds.max - bounds.min).max_element() >= ROOM {
        let walk = walk(&bounds, rays);
        if !walk.is_empty() && !is_inside_body(&walk, rays, bounds) {
            return (walk, "a walk at eye height");
        }
    }
    // Planes are drawn from one side only, which may be the lower one.
    let reach = (bounds.max - bounds.min).length() * 4.0 + 1.0;
    let shows = |v: &Viewpoint| seen(v, rays, reach) > 0.0;
    let above = orbit(&bounds, ELEVATION);
    let mut circle = if above.iter().any(shows) { above } else { orbit(&bounds, -ELEVATION) };
    let first = circle.iter().position(shows).unwrap_or(0);
    circle.rotate_left(first);
    (circle, "a circle around it")
}

/// Degrees above the horizon from which a model is seen.
const ELEVATION: f32 = 18.0;

/// True if nothing but the backs of faces is seen from viewpoints: they are inside a solid body, not in a room, which
/// contains something.
fn is_inside_body(viewpoints: &[Viewpoint], rays: &Rays, bounds: Bounds) -> bool {
    let reach = (bounds.max - bounds.min).length() * 2.0 + 1.0;
    let directions = [-45.0, -20.0, 0.0, 30.0]
        .into_iter()
        .flat_map(|elevation| (0..16).map(move |i| direction(i as f32 * TAU / 16.0, elevation)));
    let directions: Vec<Vec3> = directions.collect();
    let cast = |v: &Viewpoint, d: Vec3| rays.cast(v.position, d, reach);
    let hits = viewpoints.iter().flat_map(|v| directions.iter().filter_map(move |&d| cast(v, d)));
    let (all, behind) =
        hits.fold((0, 0), |(all, behind), hit| (all + 1, behind + usize::from(hit.is_behind)));
    behind * 100 > all * 99
}

fn direction(azimuth: f32, elevation_degrees: f32) -> Vec3 {
    let (up, level) = elevation_degrees.to_radians().sin_cos();
    Vec3::new(azimuth.sin() * level, up, -azimuth.cos() * level)
}

fn orbit(bounds: &Bounds, elevation: f32) -> Vec<Viewpoint> {
    let radius = (bounds.max - bounds.min).length() * 0.5;
    let target = bounds.center();
    // The bounding sphere fits into 60 degrees.
    let distance = (2.1 * radius).max(1e-3);
    // The first is from the front, a little to the side.
    let azimuth = |i: usize| std::f32::consts::PI - 0.4 + i as f32 * TAU / COUNT as f32;
    (0..COUNT)
        .map(|i| Viewpoint { position: target + direction(azimuth(i), elevation) * distance, target })
        .collect()
}

/// A place to stand.
#[derive(Clone, Copy)]
struct Place {
    eye: Vec3,
    /// Rates a place by what is seen from it and by its room to move.
    score: f32,
}

fn walk(bounds: &Bounds, rays: &Rays) -> Vec<Viewpoint> {
    const GRID: usize = 12;
    let size = bounds.max - bounds.min;
    let reach = size.length() * 2.0 + 1.0;
    let mut places = Vec::new();
    for i in 0..GRID * GRID {
        let cell = Vec2::new((i % GRID) as f32 + 0.5, (i / GRID) as f32 + 0.5) / GRID as f32;
        let column = Vec2::new(bounds.min.x + size.x * cell.x, bounds.min.z + size.z * cell.y);
        places.extend(floors(bounds, rays, column, reach).filter_map(|eye| place(eye, rays, reach)));
    }
    let best = places.iter().map(|p| p.score).fold(0.0, f32::max);
    places.retain(|p| p.score > 0.0 && p.score >= 0.4 * best);
    places.sort_by(|a, b| b.score.total_cmp(&a.score));
    // A few places are roofs and niches of an object, not a scene to walk in.
    if places.len() < 4 {
        return Vec::new();
    }
    // As far apart as possible while leaving enough of them.
    let extent = size.max_element();
    let routes = [8.0, 12.0, 18.0].map(|parts| route(&places, (extent / parts).max(0.4), rays));
    let enough = routes.iter().find(|r| r.len() == COUNT);
    let Some(eyes) = enough.or(routes.iter().max_by_key(|r| r.len())) else { return Vec::new() };
    let mut heading: Option<Vec3> = None;
    let mut viewpoints = Vec::new();
    for i in 0..COUNT {
        // If the walk is shorter, the remaining viewpoints look around from its last place.
        let eye = eyes[i.min(eyes.len() - 1)];
        let around = i.saturating_sub(eyes.len() - 1) as f32 * TAU / COUNT as f32;
        let viewpoint = |ahead: Vec3| Viewpoint { position: eye, target: eye + ahead * 4.0 - Vec3::Y * 0.3 };
        let sees = |ahead: &Vec3| seen(&viewpoint(*ahead), rays, reach) >= LEAST_SEEN;
        let score = |ahead: &Vec3| {
            let depth = rays.cast(eye, *ahead, reach).map_or(0.5, |h| (h.distance / 20.0).min(1.0));
            depth + heading.map_or(0.0, |h| 0.4 * h.dot(*ahead))
        };
        let ahead = match heading {
            Some(h) if i >= eyes.len() => Some(Vec3::new(
                h.x * around.cos() - h.z * around.sin(),
                0.0,
                h.x * around.sin() + h.z * around.cos(),
            ))
            .filter(sees),
            _ => (0..16)
                .map(|k| direction(k as f32 * TAU / 16.0, 0.0))
                .filter(sees)
                .max_by(|a, b| score(a).total_cmp(&score(b))),
        };
        let Some(ahead) = ahead else { return Vec::new() };
        if i < eyes.len() {
            heading = Some(ahead);
        }
        viewpoints.push(viewpoint(ahead));
    }
    viewpoints
}

/// Returns the share of a view of 60 degrees, 0 to 1, that shows the model.
fn seen(viewpoint: &Viewpoint, rays: &Rays, reach: f32) -> f32 {
    const GRID: usize = 6;
    let orientation = viewpoint.pose().orientation;
    let tangent = |i: usize| ((i as f32 + 0.5) / GRID as f32 - 0.5) * 2.0 * 30f32.to_radians().tan();
    let ray = |i: usize| orientation * Vec3::new(tangent(i % GRID), tangent(i / GRID), -1.0).normalize();
    let shows = |&i: &usize| rays.cast(viewpoint.position, ray(i), reach).is_some_and(|h| h.is_drawn);
    let hits = (0..GRID * GRID).filter(shows).count();
    hits as f32 / (GRID * GRID) as f32
}

/// Returns a route from the best place to the nearest one visible from there, and so on: a camera path along it stays
/// clear of walls.
fn route(places: &[Place], apart: f32, rays: &Rays) -> Vec<Vec3> {
    let mut eyes = vec![places[0].eye];
    while eyes.len() < COUNT {
        let here = eyes[eyes.len() - 1];
        let visible = |p: &&Place| rays.cast(here, p.eye - here, 1.0).is_none();
        let free = places.iter().filter(|p| eyes.iter().all(|e| e.distance(p.eye) >= apart)).filter(visible);
        match free.min_by(|a, b| a.eye.distance(here).total_cmp(&b.eye.distance(here))) {
            Some(p) => eyes.push(p.eye),
            None => break,
        }
    }
    eyes
}

/// Returns eye positions above all floors of a column that have headroom, from the top down.
fn floors(bounds: &Bounds, rays: &Rays, column: Vec2, reach: f32) -> impl Iterator<Item = Vec3> {
    let mut found = Vec::new();
    let mut ceiling = f32::INFINITY;
    let mut from = Vec3::new(column.x, bounds.max.y + 1.0, column.y);
    for _ in 0..32 {
        let Some(hit) = rays.cast(from, Vec3::NEG_Y, reach) else { break };
        let floor = from.y - hit.distance;
        if hit.normal.y.abs() > 0.7 && ceiling - floor > EYE_HEIGHT + 0.4 {
            found.push(Vec3::new(column.x, floor + EYE_HEIGHT, column.y));
        }
        ceiling = floor;
        from.y = floor - 1e-3 * (1.0 + floor.abs() * 1e-2);
    }
    found.into_iter()
}

fn place(eye: Vec3, rays: &Rays, reach: f32) -> Option<Place> {
    let azimuths = (0..16).map(|i| i as f32 * TAU / 16.0);
    let floor =
        azimuths.filter(|&a| rays.cast(eye, direction(a, -20.0), reach).is_some_and(|h| h.is_drawn)).count();
    if (floor as f32) < LEAST_FLOOR * 16.0 {
        return None;
    }
    let mut distances = Vec::new();
    let mut seen = 0.0;
    for i in 0..16 {
        for elevation in [0.0, 20.0] {
            let distance =
                rays.cast(eye, direction(i as f32 * TAU / 16.0, elevation), reach).map(|h| h.distance);
            seen += distance.map_or(0.2, |d| if (1.0..60.0).contains(&d) { 1.0 } else { 0.1 }) / 32.0;
            distances.push(distance.unwrap_or(30.0));
        }
    }
    distances.sort_by(f32::total_cmp);
    // Prefer the street to the empty inside of a house; on a roof there is little to see around.
    let street = seen > 0.4 && rays.cast(eye, Vec3::Y, reach).is_none();
    let score = seen * (distances[16] / 8.0).min(1.0) * if street { 3.0 } else { 1.0 };
    // Nothing may be nearer than half a metre: the eyes need room, and so does the synthesis.
    (distances[0] >= 0.5).then_some(Place { eye, score })
}

/// Returns sun and sky for a model without them: where the viewpoints see (almost) no sky, the even light of a room.
pub(super) fn sky(model: &Model, rays: &Rays, viewpoints: &[Viewpoint]) -> Sky {
    let bounds = model.bounds();
    let reach = (bounds.max - bounds.min).length() * 2.0 + 1.0;
    let upward: Vec<Vec3> = [25.0, 55.0]
        .into_iter()
        .flat_map(|e| (0..8).map(move |i| direction(i as f32 * TAU / 8.0, e)))
        .chain([Vec3::Y])
        .collect();
    let open = viewpoints
        .iter()
        .flat_map(|v| upward.iter().map(|d| (v.position, *d)))
        .filter(|&(p, d)| rays.cast(p, d, reach).is_none());
    let sky_share = open.count() as f32 / (viewpoints.len() * upward.len()).max(1) as f32;
    if sky_share > 0.2 {
        return Sky::default();
    }
    Sky {
        sun_color: if sky_share > 0.0 { Sky::default().sun_color } else { Vec3::ZERO },
        zenith: Vec3::new(0.40, 0.40, 0.41),
        horizon: Vec3::new(0.34, 0.33, 0.31),
        ground: Vec3::new(0.25, 0.22, 0.19),
        ..Sky::default()
    }
}
