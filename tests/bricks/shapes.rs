//! Meshes made by code: good ones and broken ones.

use std::f64::consts::TAU;
use std::path::Path;

use glam::DVec3;
use isolith::mesh::{TriangleMesh, parse};
use serde_json::json;

use crate::meshes::tiny::{FLOAT, Tiny};

/// Points and triangles.
#[derive(Clone, Default)]
pub struct Soup {
    pub points: Vec<DVec3>,
    pub triangles: Vec<[u32; 3]>,
}

impl Soup {
    /// A grid of `n` times `m` points on a surface of two turns, each from 0 to 1; whether it meets itself at their ends.
    pub fn grid([n, m]: [u32; 2], closed: [bool; 2], at: impl Fn(f64, f64) -> DVec3) -> Self {
        let share = |i: u32, n: u32, closed: bool| f64::from(i) / f64::from(if closed { n } else { n - 1 });
        let points = (0..m).flat_map(|j| (0..n).map(move |i| (i, j)));
        let points = points.map(|(i, j)| at(share(i, n, closed[0]), share(j, m, closed[1]))).collect();
        let mut triangles = Vec::new();
        for j in 0..if closed[1] { m } else { m - 1 } {
            for i in 0..if closed[0] { n } else { n - 1 } {
                let p = |i: u32, j: u32| i % n + n * (j % m);
                triangles.push([p(i, j), p(i + 1, j), p(i + 1, j + 1)]);
                triangles.push([p(i, j), p(i + 1, j + 1), p(i, j + 1)]);
            }
        }
        Self { points, triangles }
    }

    pub fn sphere(detail: u32, radius: f64) -> Self {
        Self::grid([2 * detail, detail + 1], [true, false], |u, v| {
            let (around, down) = (TAU * u, 0.5 * TAU * v);
            radius * DVec3::new(down.sin() * around.cos(), down.cos(), down.sin() * around.sin())
        })
    }

    pub fn torus(detail: u32) -> Self {
        Self::tube(detail, 0.3, |t| DVec3::new(t.cos(), 0.0, t.sin()))
    }

    /// A trefoil.
    pub fn knot(detail: u32) -> Self {
        let line = |t: f64| {
            DVec3::new(t.sin() + 2.0 * (2.0 * t).sin(), t.cos() - 2.0 * (2.0 * t).cos(), -(3.0 * t).sin()) * 0.4
        };
        Self::tube(detail, 0.17, line)
    }

    fn tube(detail: u32, radius: f64, line: impl Fn(f64) -> DVec3) -> Self {
        Self::grid([detail, 4 * detail], [true, true], |u, v| {
            let t = TAU * v;
            let ahead = (line(t + 1e-4) - line(t - 1e-4)).normalize();
            let side = ahead.cross(DVec3::new(0.1, 1.0, 0.2)).normalize();
            line(t) + radius * ((TAU * u).cos() * side + (TAU * u).sin() * ahead.cross(side))
        })
    }

    pub fn cuboid(half: DVec3) -> Self {
        let points = (0..8).map(|i| half * DVec3::from([0, 1, 2].map(|a| f64::from(2 * (i >> a & 1) - 1)))).collect();
        let quads = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
        let triangles = quads.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).collect();
        Self { points, triangles }
    }

    /// A frame of bars along the edges of a cube: of genus 5.
    pub fn frame() -> Self {
        let n = 4_i32;
        let bar = |v: i32| v == 0 || v == n - 1;
        let filled = |p: [i32; 3]| p.iter().all(|v| (0..n).contains(v)) && p.iter().filter(|v| bar(**v)).count() >= 2;
        let mut out = Self::default();
        for i in 0..n * n * n {
            let p = [i % n, i / n % n, i / (n * n)];
            for (axis, side) in (0..3).flat_map(|axis| [(axis, 0), (axis, 1)]).filter(|_| filled(p)) {
                let mut next: [i32; 3] = p;
                next[axis] += 2 * side - 1;
                if filled(next) {
                    continue;
                }
                let corner = |a: i32, b: i32| {
                    let mut at = p;
                    at[axis] += side;
                    at[(axis + 1) % 3] += a;
                    at[(axis + 2) % 3] += b;
                    (DVec3::from(at.map(f64::from)) - 2.0) * 0.4
                };
                let quad = [corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)];
                out.quad(if side == 1 { quad } else { [quad[0], quad[3], quad[2], quad[1]] });
            }
        }
        out
    }

    fn quad(&mut self, corners: [DVec3; 4]) {
        let first = self.points.len() as u32;
        self.points.extend(corners);
        self.triangles.extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
    }

    pub fn moved(mut self, by: DVec3) -> Self {
        self.points.iter_mut().for_each(|p| *p += by);
        self
    }

    pub fn inverted(mut self) -> Self {
        self.triangles.iter_mut().for_each(|t| t.swap(1, 2));
        self
    }

    pub fn with(mut self, other: Self) -> Self {
        let first = self.points.len() as u32;
        self.points.extend(other.points);
        self.triangles.extend(other.triangles.iter().map(|t| t.map(|p| p + first)));
        self
    }

    /// Without the triangles whose first corner is so.
    pub fn without(mut self, is_gone: impl Fn(DVec3) -> bool) -> Self {
        let points = &self.points;
        self.triangles.retain(|t| !t.iter().all(|p| is_gone(points[*p as usize])));
        self
    }

    /// A rectangle of no thickness, across Y.
    pub fn sheet(half: [f64; 2]) -> Self {
        let mut out = Self::default();
        out.quad(
            [[-1.0, -1.0], [-1.0, 1.0], [1.0, 1.0], [1.0, -1.0]]
                .map(|[x, z]| DVec3::new(x * half[0], 0.0, z * half[1])),
        );
        out
    }

    pub fn mesh(&self) -> TriangleMesh {
        parse(&self.glb(), Path::new("made.glb"), None).unwrap()
    }

    /// The same as a file.
    pub fn glb(&self) -> Vec<u8> {
        let mut tiny = Tiny::new();
        let points: Vec<[f32; 3]> = self.points.iter().map(|p| p.as_vec3().to_array()).collect();
        let positions = tiny.floats(&points);
        let bytes: Vec<u8> = self.triangles.iter().flatten().flat_map(|i| i.to_le_bytes()).collect();
        const U32: u32 = FLOAT - 1;
        let indices = tiny.accessor(&bytes, U32, "SCALAR", 3 * self.triangles.len());
        tiny.mesh(json!({ "attributes": { "POSITION": positions }, "indices": indices }));
        tiny.glb()
    }
}

/// Ten meshes by name, and whether each is smooth. The last three are broken: open, crossing itself, inside out in parts.
pub fn ten() -> Vec<(&'static str, Soup, bool)> {
    let up = |y: f64| DVec3::new(0.0, y, 0.0);
    let hole = Soup::sphere(40, 1.0).without(|p| p.y > 0.8);
    let crossing = Soup::sphere(32, 0.8).with(Soup::torus(24)).with(Soup::cuboid(DVec3::new(0.3, 1.2, 0.3)));
    let turned = Soup::sphere(32, 0.6).moved(up(-0.8)).inverted().with(Soup::sphere(32, 0.5).moved(up(0.8)));
    vec![
        ("sphere", Soup::sphere(48, 1.0), true),
        ("torus", Soup::torus(32), true),
        ("knot", Soup::knot(36), true),
        ("box", Soup::cuboid(DVec3::new(0.7, 1.0, 0.41)), false),
        ("plate", Soup::cuboid(DVec3::new(1.0, 0.013, 0.8)), false),
        ("frame", Soup::frame(), false),
        ("shells", Soup::sphere(40, 1.0).with(Soup::sphere(32, 0.6).inverted()), true),
        ("open", hole, true),
        ("crossing", crossing, false),
        ("turned", turned, true),
    ]
}
