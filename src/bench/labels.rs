//! Finds a place for each label where it covers neither a mark nor another label.

/// A rectangle on the canvas: left, upper, right and lower edge, in pixels.
pub(super) type Edges = [f64; 4];

/// A label to place.
pub(super) struct Wish {
    /// The point that the label belongs to.
    pub at: (f64, f64),
    /// Width and height of the label.
    pub size: (f64, f64),
    /// The radius of the mark around the point.
    pub reach: f64,
}

/// The place of a label.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct LabelPlace {
    /// The rectangle that the label fills.
    pub edges: Edges,
    /// The end of the leader line from the mark, for a label far from its mark.
    pub leader: Option<(f64, f64)>,
}

/// Areas that labels must not cover, and lines that they should avoid.
pub(super) struct Obstacles {
    /// Labels stay inside this rectangle.
    pub inside: Edges,
    /// Rectangles around marks and other labels.
    pub taken: Vec<Edges>,
    /// Points along lines; labels cover as few as possible.
    pub lines: Vec<(f64, f64)>,
}

const DIRECTIONS: usize = 24;
const DISTANCES: [f64; 9] = [3.0, 8.0, 16.0, 26.0, 38.0, 52.0, 68.0, 86.0, 106.0];
/// A label farther away than this, in pixels, gets a leader line to its mark.
const NEAR: f64 = 10.0;
/// The extra distance, in pixels, that a label accepts to cover one point of a line less.
const COST_OF_LINE: f64 = 5.0;

impl Obstacles {
    /// Places the labels in order; earlier labels get the better places. A label that fits nowhere gets no place: color
    /// and shape still identify its mark, and overlapping text would be unreadable.
    pub fn place(&mut self, wishes: &[Wish]) -> Vec<Option<LabelPlace>> {
        wishes
            .iter()
            .map(|wish| {
                let place = self.best(wish)?;
                self.taken.push(grown(place.edges, 2.0));
                if let Some(end) = place.leader {
                    self.lines.extend(along(wish.at, end));
                }
                Some(place)
            })
            .collect()
    }

    fn best(&self, wish: &Wish) -> Option<LabelPlace> {
        let mut best: Option<(f64, LabelPlace)> = None;
        for distance in DISTANCES {
            for i in 0..DIRECTIONS {
                let place = candidate(wish, distance, i);
                let Some(cost) = self.cost(wish, &place, distance) else { continue };
                if best.is_none_or(|(least, _)| cost < least) {
                    best = Some((cost, place));
                }
            }
        }
        best.map(|(_, place)| place)
    }

    /// The cost of a place; `None` if it covers something that it must not cover.
    fn cost(&self, wish: &Wish, place: &LabelPlace, distance: f64) -> Option<f64> {
        let [left, top, right, bottom] = place.edges;
        let inside =
            left >= self.inside[0] && top >= self.inside[1] && right <= self.inside[2] && bottom <= self.inside[3];
        if !inside || self.taken.iter().any(|taken| overlap(*taken, place.edges)) {
            return None;
        }
        // The leader line must avoid other marks, else it seems to belong to them.
        if let Some(end) = place.leader {
            let own = |taken: &Edges| contains(*taken, wish.at);
            let mut others = self.taken.iter().filter(|taken| !own(taken));
            if others.any(|taken| along(wish.at, end).any(|point| contains(*taken, point))) {
                return None;
            }
        }
        let covered = self.lines.iter().filter(|point| contains(place.edges, **point)).count();
        // Horizontal text reads best beside its mark.
        let steep = ((top + bottom) / 2.0 - wish.at.1).abs() * 0.15;
        Some(distance + steep + covered as f64 * COST_OF_LINE)
    }
}

/// The label whose nearest point to the mark lies in this direction at this distance.
fn candidate(wish: &Wish, distance: f64, direction: usize) -> LabelPlace {
    let (sin, cos) = (direction as f64 * std::f64::consts::TAU / DIRECTIONS as f64).sin_cos();
    let far = wish.reach + distance;
    let (x, y) = (wish.at.0 + cos * far, wish.at.1 + sin * far);
    // The label slides past the point from one side to the other as the direction turns.
    let left = x - wish.size.0 * (0.5 - 0.5 * (cos * 1.6).clamp(-1.0, 1.0));
    let top = y - wish.size.1 * (0.5 - 0.5 * sin);
    let edges = [left, top, left + wish.size.0, top + wish.size.1];
    let end = (wish.at.0.clamp(edges[0], edges[2]), wish.at.1.clamp(edges[1], edges[3]));
    LabelPlace { edges, leader: (distance > NEAR).then_some(end) }
}

/// Points along a straight line, a few pixels apart.
pub(super) fn along(from: (f64, f64), to: (f64, f64)) -> impl Iterator<Item = (f64, f64)> {
    let count = ((to.0 - from.0).hypot(to.1 - from.1) / 5.0).ceil().max(1.0) as usize;
    (0..=count).map(move |i| {
        let t = i as f64 / count as f64;
        (from.0 + (to.0 - from.0) * t, from.1 + (to.1 - from.1) * t)
    })
}

/// The rectangle around a point.
pub(super) fn around((x, y): (f64, f64), reach: f64) -> Edges {
    [x - reach, y - reach, x + reach, y + reach]
}

fn grown([left, top, right, bottom]: Edges, by: f64) -> Edges {
    [left - by, top - by, right + by, bottom + by]
}

fn overlap(a: Edges, b: Edges) -> bool {
    a[0] < b[2] && b[0] < a[2] && a[1] < b[3] && b[1] < a[3]
}

fn contains([left, top, right, bottom]: Edges, (x, y): (f64, f64)) -> bool {
    (left..=right).contains(&x) && (top..=bottom).contains(&y)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_cover_neither_marks_nor_labels() {
        let points: Vec<(f64, f64)> =
            (0..12).map(|i| (200.0 + f64::from(i % 4) * 30.0, 200.0 + f64::from(i))).collect();
        let marks: Vec<Edges> = points.iter().map(|point| around(*point, 7.0)).collect();
        let mut obstacles = Obstacles {
            inside: [0.0, 0.0, 500.0, 400.0],
            taken: marks.clone(),
            lines: along((0.0, 190.0), (500.0, 190.0)).collect(),
        };
        let wishes: Vec<Wish> = points.iter().map(|at| Wish { at: *at, size: (90.0, 16.0), reach: 7.0 }).collect();
        let places: Vec<LabelPlace> = obstacles.place(&wishes).into_iter().flatten().collect();
        assert!(places.len() >= 6, "only {} labels have a place", places.len());
        for (i, place) in places.iter().enumerate() {
            assert!(marks.iter().all(|mark| !overlap(*mark, place.edges)));
            assert!(places[i + 1..].iter().all(|other| !overlap(other.edges, place.edges)));
        }
    }

    #[test]
    fn without_room_there_is_no_label() {
        let mut obstacles = Obstacles { inside: [0.0, 0.0, 50.0, 50.0], taken: Vec::new(), lines: Vec::new() };
        let wish = Wish { at: (25.0, 25.0), size: (90.0, 16.0), reach: 7.0 };
        assert_eq!(obstacles.place(&[wish]), [None]);
    }

    #[test]
    fn alone_a_label_stands_beside_its_mark() {
        let mut obstacles = Obstacles { inside: [0.0, 0.0, 500.0, 500.0], taken: Vec::new(), lines: Vec::new() };
        let wish = Wish { at: (250.0, 250.0), size: (90.0, 16.0), reach: 7.0 };
        let place = obstacles.place(&[wish])[0].unwrap();
        assert_eq!(place.leader, None);
        assert_eq!(place.edges, [260.0, 242.0, 350.0, 258.0]);
    }
}
