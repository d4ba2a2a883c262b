//! The modifiers, one table row per kind: all that other modules know about it. The parameters of a kind stand in
//! `scene/modifier.rs`, its effects on bounds and steps in `modify`. The functions that a row names stand in
//! `eval/modifier.rs`, their counterparts of the same names for the GPU in `shaders/mod/`.
//!
//! | entry | what it says |
//! |---|---|
//! | `rows` | number of its own rows; `with data`: the last one locates its payload |
//! | `count` | number of evaluations of the content for one point |
//! | `start` | bound of the field besides the copies |
//! | `exists` | whether the k-th copy exists |
//! | `scale` | size of the k-th copy |
//! | `point` | position of a point in the k-th copy of the content |
//! | `value` | the field, from that of the content |
//! | `rough` | its field may be far below the distance: only a change of sign is a hit |
//! | `exact` | exactness of the content for a field exact up to `local`; `own` are the modifier's parameters |
//!
//! Kinds without rows are written as copies and have no entry of their own.

use super::arrays::{ParamRow, payload_at};
use super::eval::{
    Real, mod_bend_point, mod_bend_value, mod_displacement_value, mod_elongate_point, mod_noise_value, mod_onion_value,
    mod_recursion_point, mod_repeat_count, mod_repeat_exists, mod_repeat_point, mod_repeat_start, mod_taper_point,
    mod_taper_value, mod_twist_point, mod_twist_value, mod_waves_value,
};
use isolith_scene::ModifierKind;

/// Whether an argument is given.
macro_rules! is_given {
    () => {
        false
    };
    ($($given:tt)+) => {
        true
    };
}

/// The given argument, or else the default.
macro_rules! given_or {
    ($otherwise:expr;) => {
        $otherwise
    };
    ($otherwise:expr; $given:expr) => {
        $given
    };
}

macro_rules! modifier_table {
    ($( $name:ident {
        $(rows: $rows:literal $(with $data:ident)?,)?
        $(count: |$count_rows:ident| $count:expr,)?
        $(start: |$start_p:ident, $start_rows:ident| $start:expr,)?
        $(exists: |$exists_p:ident, $exists_k:ident, $exists_rows:ident| $exists:expr,)?
        $(scale: |$scale_k:ident, $scale_rows:ident| $scale:expr,)?
        $(point: |$point_p:ident, $point_k:ident, $point_rows:ident| $point:expr,)?
        $(value: |$value_f:ident, $value_p:ident, $value_rows:ident| $value:expr,)?
        $(rough: $rough:literal,)?
        $(exact: |$local:ident, $own:ident| $exact:expr,)?
    } )+) => {
        /// Number of own rows of a modifier, including the one that locates its payload.
        pub const fn modifier_rows(kind: ModifierKind) -> usize {
            match kind { $( ModifierKind::$name => given_or!(0; $($rows)?), )+ }
        }

        /// Index of the row that locates the payload of a modifier, the last of its own rows; `None` for a kind
        /// without a payload.
        pub const fn modifier_payload_row(kind: ModifierKind) -> Option<usize> {
            let has_data = match kind { $( ModifierKind::$name => is_given!($($($data)?)?), )+ };
            if has_data { Some(modifier_rows(kind) - 1) } else { None }
        }

        /// Whether the kind evaluates its content several times.
        pub const fn is_copying(kind: ModifierKind) -> bool {
            match kind { $( ModifierKind::$name => is_given!($($count)?), )+ }
        }

        /// Whether it moves the point.
        pub const fn moves_point(kind: ModifierKind) -> bool {
            match kind { $( ModifierKind::$name => is_given!($($point)?), )+ }
        }

        /// Whether it changes the field's value.
        pub const fn changes_value(kind: ModifierKind) -> bool {
            match kind { $( ModifierKind::$name => is_given!($($value)?), )+ }
        }

        /// Whether its field may be far below the distance, so that rays come near to 0 without touching a surface.
        pub const fn is_rough(kind: ModifierKind) -> bool {
            match kind { $( ModifierKind::$name => given_or!(false; $($rough)?), )+ }
        }

        /// The exactness that the content needs for the modifier's field to be exact up to `local` in its own space;
        /// `own` reads its parameters by row and column.
        #[allow(unused_variables, reason = "some need no numbers of their own")]
        pub(super) fn content_exactness(kind: ModifierKind, local: f64, own: &dyn Fn(usize, usize) -> f64) -> f64 {
            match kind { $( ModifierKind::$name => given_or!(
                unreachable!("this is written as copies"); $( { let ($local, $own) = (local, own); $exact } )?
            ), )+ }
        }

        /// Number of evaluations of the content for one point.
        pub(super) fn modifier_count(kind: ModifierKind, rows: &[ParamRow]) -> u32 {
            match kind { $( ModifierKind::$name => given_or!(1; $( { let $count_rows = rows; $count } )?), )+ }
        }

        /// The bound of the field besides the copies.
        pub(super) fn modifier_start<T: Real>(kind: ModifierKind, p: [T; 3], rows: &[ParamRow]) -> T {
            match kind { $( ModifierKind::$name => given_or!(
                T::constant(f64::INFINITY); $( { let ($start_p, $start_rows) = (p, rows); $start } )?
            ), )+ }
        }

        /// Whether the k-th copy exists.
        pub(super) fn modifier_exists<T: Real>(kind: ModifierKind, p: [T; 3], k: u32, rows: &[ParamRow]) -> bool {
            match kind { $( ModifierKind::$name => given_or!(
                true; $( { let ($exists_p, $exists_k, $exists_rows) = (p, k, rows); $exists } )?
            ), )+ }
        }

        /// The size of the k-th copy.
        pub(super) fn modifier_scale(kind: ModifierKind, k: u32, rows: &[ParamRow]) -> f64 {
            match kind { $( ModifierKind::$name => given_or!(
                1.0; $( { let ($scale_k, $scale_rows) = (k, rows); $scale } )?
            ), )+ }
        }

        /// The position of the point in the k-th copy of the content.
        #[allow(unused_variables, reason = "most have one copy")]
        pub(super) fn modifier_point<T: Real>(kind: ModifierKind, p: [T; 3], k: u32, rows: &[ParamRow]) -> [T; 3] {
            match kind { $( ModifierKind::$name => given_or!(
                p; $( { let ($point_p, $point_k, $point_rows) = (p, k, rows); $point } )?
            ), )+ }
        }

        /// The field, from that of the content.
        #[allow(unused_variables, reason = "some are the same everywhere")]
        pub(super) fn modifier_value<T: Real>(kind: ModifierKind, f: T, p: [T; 3], rows: &[ParamRow]) -> T {
            match kind { $( ModifierKind::$name => given_or!(
                f; $( { let ($value_f, $value_p, $value_rows) = (f, p, rows); $value } )?
            ), )+ }
        }
    };
}

modifier_table! {
    Mirror {}
    Repeat {
        rows: 10,
        count: |rows| mod_repeat_count(rows),
        start: |p, rows| mod_repeat_start(p, rows),
        exists: |p, k, rows| mod_repeat_exists(p, k, rows),
        point: |p, k, rows| mod_repeat_point(p, k, rows),
        exact: |local, own| local,
    }
    Polar {}
    Recursion {
        rows: 6,
        count: |rows| rows[1][3] as u32,
        scale: |k, rows| f64::from(rows[0][3]).powi(k as i32),
        point: |p, k, rows| mod_recursion_point(p, k, rows),
        exact: |local, own| local / own(0, 3).min(1.0).powi(own(1, 3) as i32 - 1),
    }
    Twist {
        rows: 2,
        point: |p, k, rows| mod_twist_point(p, rows),
        value: |f, p, rows| mod_twist_value(f, p, rows),
        rough: true,
        exact: |local, own| local / own(0, 1),
    }
    Bend {
        rows: 4,
        point: |p, k, rows| mod_bend_point(p, rows),
        value: |f, p, rows| mod_bend_value(f, p, rows),
        rough: true,
        exact: |local, own| local / own(0, 1),
    }
    Taper {
        rows: 3,
        point: |p, k, rows| mod_taper_point(p, rows),
        value: |f, p, rows| mod_taper_value(f, p, rows),
        rough: true,
        exact: |local, own| local / own(0, 1),
    }
    Elongate {
        rows: 1,
        point: |p, k, rows| mod_elongate_point(p, rows),
        exact: |local, own| local,
    }
    Round {
        rows: 1,
        value: |f, p, rows| f - f64::from(rows[0][0]),
        exact: |local, own| local + own(0, 0).abs(),
    }
    Onion {
        rows: 1,
        value: |f, p, rows| mod_onion_value(f, rows),
        exact: |local, own| local + own(0, 0) + own(0, 1) * own(0, 2),
    }
    Waves {
        rows: 1,
        value: |f, p, rows| mod_waves_value(f, p, rows),
        rough: true,
        exact: |local, own| local / own(0, 3) + own(0, 0).abs(),
    }
    Noise {
        rows: 2,
        value: |f, p, rows| mod_noise_value(f, p, rows),
        rough: true,
        exact: |local, own| local / own(1, 0) + own(1, 1),
    }
    Displacement {
        rows: 3 with data,
        value: |f, p, rows| mod_displacement_value(f, p, rows, modifier_payload(ModifierKind::Displacement, rows)),
        rough: true,
        exact: |local, own| local / own(1, 0) + own(1, 1).abs().max(own(1, 2).abs()),
    }
}

/// The payload of the modifier whose own rows are the first of `rows`; empty for most.
pub fn modifier_payload(kind: ModifierKind, rows: &[ParamRow]) -> &[ParamRow] {
    modifier_payload_row(kind).map_or(&[], |row| payload_at(rows, row))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_row_says_what_a_modifier_of_its_kind_needs() {
        for &kind in ModifierKind::ALL {
            let has_rows = modifier_rows(kind) > 0;
            // Kinds with rows use them; kinds that are written as copies do nothing here.
            assert_eq!(has_rows, moves_point(kind) || changes_value(kind), "{kind:?}");
            assert!(has_rows || !(is_copying(kind) || is_rough(kind)), "{kind:?}");
            assert!(!is_copying(kind) || moves_point(kind), "{kind:?}: its copies stand somewhere");
            assert!(modifier_payload_row(kind).is_none_or(|row| row < modifier_rows(kind)), "{kind:?}");
            if has_rows {
                // The element in this place is a number of copies.
                let own = |row: usize, column: usize| if (row, column) == (1, 3) { 2.0 } else { 0.5 };
                assert!(content_exactness(kind, 1.0, &own) >= 1.0, "{kind:?}: never less exact than the field");
            }
        }
    }

    #[test]
    fn points_and_values_change_where_the_table_says_so() {
        let mut rows = [[0.5; 4]; 10];
        let p = [0.3, 0.2, 0.1];
        for &kind in ModifierKind::ALL.iter().filter(|kind| modifier_rows(**kind) > 0 && !is_copying(**kind)) {
            // An onion has at least one wall.
            rows[0][1] = if kind == ModifierKind::Onion { 1.0 } else { 0.5 };
            if modifier_payload_row(kind).is_none() {
                assert_eq!(modifier_value(kind, 0.25, p, &rows) == 0.25, !changes_value(kind), "{kind:?}");
            }
            assert_eq!(modifier_point(kind, p, 0, &rows) == p, !moves_point(kind), "{kind:?}");
            assert_eq!((modifier_count(kind, &rows), modifier_scale(kind, 0, &rows)), (1, 1.0), "{kind:?}");
        }
    }
}
