//! The modifiers, one row for each: all that other places know about a kind. Its parameters stand in `scene/modifier.rs`,
//! what they do to bounds and steps in `modify`; the functions that a row names in `counterpart/modifier.rs`, those of the same
//! names for the GPU in `shaders/mod/`.
//!
//! | entry | what it says |
//! |---|---|
//! | `rows` | how many rows its numbers take; `with data`: the last one says where its data are |
//! | `count`, `start`, `exists`, `scale` | of one that evaluates its content several times: how often, what bounds the field besides, whether a copy is there, its size |
//! | `point` | where a point stands in the k-th copy of the content |
//! | `value` | the field, from that of the content |
//! | `rough` | its field may be far below the distance: only a change of sign is a hit |
//! | `exact` | how exact the content must be for the field to be exact up to `local`, `own` being its numbers |
//!
//! What has no rows is written as copies and has no entry of its own.

use super::arrays::{ParamRow, payload_at};
use super::eval::{
    Real, mod_bend_point, mod_bend_value, mod_displacement_value, mod_elongate_point, mod_noise_value, mod_onion_value,
    mod_recursion_point, mod_repeat_count, mod_repeat_exists, mod_repeat_point, mod_repeat_start, mod_taper_point,
    mod_taper_value, mod_twist_point, mod_twist_value, mod_waves_value,
};
use isolith_scene::ModifierKind;

/// Whether something is given.
macro_rules! is_given {
    () => {
        false
    };
    ($($given:tt)+) => {
        true
    };
}

/// What is given, or what else holds.
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
        /// How many rows a modifier's own numbers take, and behind them where its data are.
        pub const fn modifier_rows(kind: ModifierKind) -> usize {
            match kind { $( ModifierKind::$name => given_or!(0; $($rows)?), )+ }
        }

        /// Where the row that says where a modifier's data are stands among its own rows, the last of them; `None` for one
        /// without data.
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

        /// Whether its field may be far below the distance, so that rays come near to 0 and touch nothing.
        pub const fn is_rough(kind: ModifierKind) -> bool {
            match kind { $( ModifierKind::$name => given_or!(false; $($rough)?), )+ }
        }

        /// How exact the content must be for a modifier's field to be exact up to `local` in its own space; `own` are its
        /// numbers, by row and column.
        #[allow(unused_variables, reason = "some need no numbers of their own")]
        pub(super) fn content_exactness(kind: ModifierKind, local: f64, own: &dyn Fn(usize, usize) -> f64) -> f64 {
            match kind { $( ModifierKind::$name => given_or!(
                unreachable!("this is written as copies"); $( { let ($local, $own) = (local, own); $exact } )?
            ), )+ }
        }

        /// How often the content is evaluated for one point.
        pub(super) fn modifier_count(kind: ModifierKind, rows: &[ParamRow]) -> u32 {
            match kind { $( ModifierKind::$name => given_or!(1; $( { let $count_rows = rows; $count } )?), )+ }
        }

        /// What bounds the field besides the copies.
        pub(super) fn modifier_start<T: Real>(kind: ModifierKind, p: [T; 3], rows: &[ParamRow]) -> T {
            match kind { $( ModifierKind::$name => given_or!(
                T::constant(f64::INFINITY); $( { let ($start_p, $start_rows) = (p, rows); $start } )?
            ), )+ }
        }

        /// Whether the k-th copy is there.
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

        /// Where the point stands in the k-th copy of the content.
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

/// The data of the modifier whose own rows `rows` begins with; empty for most.
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
            // What has numbers does something with them, and what is written as copies does nothing here.
            assert_eq!(has_rows, moves_point(kind) || changes_value(kind), "{kind:?}");
            assert!(has_rows || !(is_copying(kind) || is_rough(kind)), "{kind:?}");
            assert!(!is_copying(kind) || moves_point(kind), "{kind:?}: its copies stand somewhere");
            assert!(modifier_payload_row(kind).is_none_or(|row| row < modifier_rows(kind)), "{kind:?}");
            if has_rows {
                // The one in this place is a number of copies.
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
            // An onion has one wall at least.
            rows[0][1] = if kind == ModifierKind::Onion { 1.0 } else { 0.5 };
            if modifier_payload_row(kind).is_none() {
                assert_eq!(modifier_value(kind, 0.25, p, &rows) == 0.25, !changes_value(kind), "{kind:?}");
            }
            assert_eq!(modifier_point(kind, p, 0, &rows) == p, !moves_point(kind), "{kind:?}");
            assert_eq!((modifier_count(kind, &rows), modifier_scale(kind, 0, &rows)), (1, 1.0), "{kind:?}");
        }
    }
}
