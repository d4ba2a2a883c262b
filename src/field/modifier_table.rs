//! The modifiers, one table row per kind: all that other modules know about it. The parameters of a kind stand in
//! `scene/modifier.rs`, its effects on bounds and steps in `modify`. The functions that a row names stand in
//! `eval/modifier.rs`, their counterparts of the same names for the GPU in `shaders/mod/`.
//!
//! | entry | what it says |
//! |---|---|
//! | `(Params)` | its parameters; `with data`: a row behind them locates its payload |
//! | `count` | number of evaluations of the content for one point |
//! | `start` | bound of the field besides the copies |
//! | `exists` | whether the k-th copy exists |
//! | `scale` | size of the k-th copy |
//! | `point` | position of a point in the k-th copy of the content |
//! | `value` | the field, from that of the content |
//! | `rough` | its field may be far below the distance: only a change of sign is a hit |
//! | `exact` | exactness of the content for a field exact up to `local` |
//!
//! `q` are the parameters, `rows` the rows that they come from. Kinds without parameters are written as
//! copies and have no entry of their own.

use super::arrays::{ParamRow, payload_at};
use super::eval::{
    Real, mod_bend_point, mod_bend_value, mod_displacement_value, mod_elongate_point, mod_noise_value, mod_onion_value,
    mod_recursion_point, mod_repeat_count, mod_repeat_exists, mod_repeat_point, mod_repeat_start, mod_taper_point,
    mod_taper_value, mod_twist_point, mod_twist_value, mod_waves_value,
};
use super::modifier_params::{
    BendParams, DisplacementParams, ElongateParams, NoParams, NoiseParams, OnionParams, RecursionParams, RepeatParams,
    RoundParams, TaperParams, TwistParams, WavesParams, params_of,
};
use isolith_scene::{EvalParams, ModifierKind, ParamLayout};

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
    ($( $name:ident($params:ident $(with $data:ident)?) {
        $(count: |$count_q:ident| $count:expr,)?
        $(start: |$start_p:ident, $start_q:ident| $start:expr,)?
        $(exists: |$exists_p:ident, $exists_k:ident, $exists_q:ident| $exists:expr,)?
        $(scale: |$scale_k:ident, $scale_q:ident| $scale:expr,)?
        $(point: |$point_p:ident, $point_k:ident, $point_q:ident| $point:expr,)?
        $(value: |$value_f:ident, $value_p:ident, $value_q:ident, $value_rows:ident| $value:expr,)?
        $(rough: $rough:literal,)?
        $(exact: |$local:ident, $exact_q:ident| $exact:expr,)?
    } )+) => {
        /// Number of own rows of a modifier, including the one that locates its payload.
        pub const fn modifier_rows(kind: ModifierKind) -> usize {
            match kind { $( ModifierKind::$name => {
                <$params as EvalParams>::LAYOUT.rows() + is_given!($($data)?) as usize
            } )+ }
        }

        /// The names of the parameters in these rows, and their places.
        pub const fn modifier_layout(kind: ModifierKind) -> ParamLayout {
            match kind { $( ModifierKind::$name => <$params as EvalParams>::LAYOUT, )+ }
        }

        /// Index of the row that locates the payload of a modifier, the last of its own rows; `None` for a kind
        /// without a payload.
        pub const fn modifier_payload_row(kind: ModifierKind) -> Option<usize> {
            let has_data = match kind { $( ModifierKind::$name => is_given!($($data)?), )+ };
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

        /// The exactness that the content needs for the modifier's field to be exact up to `local` in its own space.
        #[allow(unused_variables, reason = "some need no numbers of their own")]
        pub(super) fn content_exactness(kind: ModifierKind, local: f64, rows: &[ParamRow]) -> f64 {
            match kind { $( ModifierKind::$name => given_or!(
                unreachable!("this is written as copies");
                $( { let ($local, $exact_q) = (local, &params_of::<$params, _>(rows)); $exact } )?
            ), )+ }
        }

        /// Number of evaluations of the content for one point.
        pub(super) fn modifier_count(kind: ModifierKind, rows: &[ParamRow]) -> u32 {
            match kind { $( ModifierKind::$name => given_or!(1; $( { let $count_q = &params_of::<$params, _>(rows); $count } )?), )+ }
        }

        /// The bound of the field besides the copies.
        pub(super) fn modifier_start<T: Real>(kind: ModifierKind, p: [T; 3], rows: &[ParamRow]) -> T {
            match kind { $( ModifierKind::$name => given_or!(
                T::constant(f64::INFINITY); $( { let ($start_p, $start_q) = (p, &params_of::<$params, _>(rows)); $start } )?
            ), )+ }
        }

        /// Whether the k-th copy exists.
        pub(super) fn modifier_exists<T: Real>(kind: ModifierKind, p: [T; 3], k: u32, rows: &[ParamRow]) -> bool {
            match kind { $( ModifierKind::$name => given_or!(
                true; $( { let ($exists_p, $exists_k, $exists_q) = (p, k, &params_of::<$params, _>(rows)); $exists } )?
            ), )+ }
        }

        /// The size of the k-th copy.
        pub(super) fn modifier_scale(kind: ModifierKind, k: u32, rows: &[ParamRow]) -> f64 {
            match kind { $( ModifierKind::$name => given_or!(
                1.0; $( { let ($scale_k, $scale_q) = (k, &params_of::<$params, _>(rows)); $scale } )?
            ), )+ }
        }

        /// The position of the point in the k-th copy of the content.
        #[allow(unused_variables, reason = "most have one copy")]
        pub(super) fn modifier_point<T: Real>(kind: ModifierKind, p: [T; 3], k: u32, rows: &[ParamRow]) -> [T; 3] {
            match kind { $( ModifierKind::$name => given_or!(
                p; $( { let ($point_p, $point_k, $point_q) = (p, k, &params_of::<$params, _>(rows)); $point } )?
            ), )+ }
        }

        /// The field, from that of the content.
        #[allow(unused_variables, reason = "some are the same everywhere")]
        pub(super) fn modifier_value<T: Real>(kind: ModifierKind, f: T, p: [T; 3], rows: &[ParamRow]) -> T {
            match kind { $( ModifierKind::$name => given_or!(
                f; $( {
                    let ($value_f, $value_p) = (f, p);
                    let ($value_q, $value_rows) = (&params_of::<$params, _>(rows), rows);
                    $value
                } )?
            ), )+ }
        }
    };
}

modifier_table! {
    Mirror(NoParams) {}
    Repeat(RepeatParams) {
        count: |q| mod_repeat_count(q),
        start: |p, q| mod_repeat_start(p, q),
        exists: |p, k, q| mod_repeat_exists(p, k, q),
        point: |p, k, q| mod_repeat_point(p, k, q),
        exact: |local, q| local,
    }
    Polar(NoParams) {}
    Recursion(RecursionParams) {
        count: |q| q.count,
        scale: |k, q| q.scale.powi(k as i32),
        point: |p, k, q| mod_recursion_point(p, k, q),
        exact: |local, q| local / q.scale.min(1.0).powi(q.count as i32 - 1),
    }
    Twist(TwistParams) {
        point: |p, k, q| mod_twist_point(p, q),
        value: |f, p, q, rows| mod_twist_value(f, p, q),
        rough: true,
        exact: |local, q| local / q.slope,
    }
    Bend(BendParams) {
        point: |p, k, q| mod_bend_point(p, q),
        value: |f, p, q, rows| mod_bend_value(f, p, q),
        rough: true,
        exact: |local, q| local / q.slope,
    }
    Taper(TaperParams) {
        point: |p, k, q| mod_taper_point(p, q),
        value: |f, p, q, rows| mod_taper_value(f, p, q),
        rough: true,
        exact: |local, q| local / q.slope,
    }
    Elongate(ElongateParams) {
        point: |p, k, q| mod_elongate_point(p, q),
        exact: |local, q| local,
    }
    Round(RoundParams) {
        value: |f, p, q, rows| f - q.radius,
        exact: |local, q| local + q.radius.abs(),
    }
    Onion(OnionParams) {
        value: |f, p, q, rows| mod_onion_value(f, q),
        exact: |local, q| local + q.half + q.walls * q.spacing,
    }
    Waves(WavesParams) {
        value: |f, p, q, rows| mod_waves_value(f, p, q),
        rough: true,
        exact: |local, q| local / q.slope + q.amplitude.abs(),
    }
    Noise(NoiseParams) {
        value: |f, p, q, rows| mod_noise_value(f, p, q),
        rough: true,
        exact: |local, q| local / q.slope + q.reach,
    }
    Displacement(DisplacementParams with data) {
        value: |f, p, q, rows| mod_displacement_value(f, p, q, modifier_payload(ModifierKind::Displacement, rows)),
        rough: true,
        exact: |local, q| local / q.slope + q.least.abs().max(q.greatest.abs()),
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
                let mut rows = [[0.5; 4]; 10];
                // The number of copies of a recursion.
                rows[1][3] = 2.0;
                assert!(content_exactness(kind, 1.0, &rows) >= 1.0, "{kind:?}: never less exact than the field");
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
