//! Tests of unions of rectangles and disks, against known results.

use super::*;
use crate::straight_curve;

fn polygon(corners: &[[f64; 2]]) -> Vec<ArcPiece> {
    let points: Vec<DVec3> = corners.iter().map(|[x, y]| DVec3::new(*x, *y, 0.0)).collect();
    straight_curve(&points).into_iter().flatten().collect()
}

fn rectangle([x0, y0]: [f64; 2], [x1, y1]: [f64; 2]) -> Vec<ArcPiece> {
    polygon(&[[x0, y0], [x1, y0], [x1, y1], [x0, y1]])
}

fn circle(center: DVec3, radius: f64) -> Vec<ArcPiece> {
    let [right, left] = [center + DVec3::X * radius, center - DVec3::X * radius];
    vec![ArcPiece::leaving(right, DVec3::Y, left), ArcPiece::leaving(left, -DVec3::Y, right)]
}

fn backward(arcs: Vec<ArcPiece>) -> Vec<ArcPiece> {
    arcs.into_iter().rev().map(ArcPiece::reversed).collect()
}

fn length(arcs: &[ArcPiece]) -> f64 {
    arcs.iter().map(ArcPiece::length).sum()
}

/// The enclosed area, by Green's theorem along chords of small pieces.
fn area(arcs: &[ArcPiece]) -> f64 {
    let mut sum = 0.0;
    for arc in arcs {
        for i in 0..200 {
            let at = |i: i32| arc.at(arc.reach * (f64::from(i) / 100.0 - 1.0));
            sum += 0.5 * at(i).perp_dot(at(i + 1));
        }
    }
    sum
}

fn united(parts: &[Vec<ArcPiece>]) -> Option<Vec<ArcPiece>> {
    arc_union(&parts.concat(), 1e-6).unwrap()
}

#[test]
fn simple_curves_stay_as_they_are() {
    let ring = [circle(DVec3::ZERO, 1.0), backward(circle(DVec3::ZERO, 0.5))];
    assert_eq!(united(&ring), None);
    assert_eq!(united(&[rectangle([0.0, 0.0], [1.0, 1.0]), rectangle([2.0, 0.0], [3.0, 1.0])]), None);
    // The other orientation, as in the other kind of font.
    assert_eq!(united(&ring.map(backward)), None);
    assert_eq!(united(&[]), None);
}

#[test]
fn what_overlaps_is_one_curve_around_both() {
    let cross = united(&[rectangle([0.0, 1.0], [3.0, 2.0]), rectangle([1.0, 0.0], [2.0, 3.0])]).unwrap();
    assert!((length(&cross) - 12.0).abs() < 1e-9 && (area(&cross) - 5.0).abs() < 1e-9);
    // A disk inside a disk of the same orientation vanishes.
    let nested = united(&[circle(DVec3::ZERO, 1.0), circle(DVec3::X * 0.2, 0.3)]).unwrap();
    assert!((length(&nested) - std::f64::consts::TAU).abs() < 1e-6);
    // Two disks, against the area of a lens.
    let lens = united(&[circle(DVec3::ZERO, 1.0), circle(DVec3::X, 1.0)]).unwrap();
    let overlap = 2.0 * std::f64::consts::PI / 3.0 - 0.75_f64.sqrt();
    assert!((area(&lens) - (std::f64::consts::TAU - overlap)).abs() < 1e-4, "{}", area(&lens));
    // One of them reversed.
    let mixed = united(&[circle(DVec3::ZERO, 1.0), circle(DVec3::new(5.0, 0.0, 0.0), 1.0)]);
    assert_eq!(mixed, None);
}

#[test]
fn what_touches_or_coincides_is_joined() {
    // Joined letters: their strokes overlap, with edges on one line.
    let stroke = united(&[rectangle([0.0, 0.0], [2.0, 1.0]), rectangle([1.5, 0.0], [4.0, 1.0])]).unwrap();
    assert!((length(&stroke) - 10.0).abs() < 1e-9 && (area(&stroke) - 4.0).abs() < 1e-9);
    // Rectangles that share an edge.
    let touching = united(&[rectangle([0.0, 0.0], [2.0, 1.0]), rectangle([2.0, 0.0], [4.0, 1.0])]).unwrap();
    assert!((length(&touching) - 10.0).abs() < 1e-9);
    // The same curve twice, circles too.
    let twice = united(&[circle(DVec3::ZERO, 1.0), circle(DVec3::ZERO, 1.0)]).unwrap();
    assert!((length(&twice) - std::f64::consts::TAU).abs() < 1e-6);
    // Once in each direction: nothing is left.
    let gone = united(&[circle(DVec3::ZERO, 1.0), backward(circle(DVec3::ZERO, 1.0))]).unwrap();
    assert!(gone.is_empty());
    // A stroke that crosses itself.
    let knot =
        polygon(&[[0.0, 0.0], [3.0, 0.0], [3.0, 2.0], [1.0, 2.0], [1.0, -1.0], [2.0, -1.0], [2.0, 1.0], [0.0, 1.0]]);
    let knot = united(&[knot]).unwrap();
    assert!(area(&knot) > 0.0);
}

#[test]
fn what_crosses_without_end_is_refused() {
    let mut grid = Vec::new();
    for i in 0..400 {
        let at = f64::from(i) * 0.01;
        grid.extend(rectangle([at, 0.0], [at + 0.004, 4.0]));
        grid.extend(rectangle([0.0, at], [4.0, at + 0.004]));
    }
    assert_eq!(arc_union(&grid, 1e-6), Err(TooDense));
}
