//! Tests of the table of shapes against the code generated from it.

use super::*;
use crate::params::{LIST_COLUMNS, ParamValue};

#[test]
fn every_parameter_can_be_read_written_and_packed() {
    for &kind in ShapeKind::ALL {
        let mut shape = kind.default_shape();
        assert_eq!(shape.kind(), kind);
        let values = shape.values();
        assert_eq!(values.len(), kind.params().len());
        assert!(kind.parameter_rows() * 4 <= SHAPE_FLOATS);
        assert_eq!(kind.unpacked(&shape.packed()).is_none(), kind.has_data());
        let unpacked = kind.unpacked(&shape.packed()).map_or(Vec::new(), |shape| shape.values());
        for (before, after) in values.iter().zip(unpacked) {
            let [before, after] = [before, &after].map(|v| match v {
                ParamValue::Scalar(v) => glam::DVec3::splat(*v),
                ParamValue::Vector(v) => *v,
                _ => panic!("{kind:?} has data"),
            });
            assert!(before.abs_diff_eq(after, 1e-12), "{kind:?}");
        }
        for (i, value) in values.iter().enumerate() {
            let changed = match value {
                ParamValue::Scalar(v) => ParamValue::Scalar(v + 0.25),
                ParamValue::Vector(v) => ParamValue::Vector(*v + 0.25),
                ParamValue::Flag(v) => ParamValue::Flag(!v),
                ParamValue::Text(v) => ParamValue::Text(format!("{v}!")),
                ParamValue::File(_) | ParamValue::Choice(_) => continue,
                ParamValue::List(list) => {
                    let mut list = list.clone();
                    list.rows.push([0.0; LIST_COLUMNS]);
                    ParamValue::List(list)
                }
                other => unreachable!("no shape has {other:?}"),
            };
            assert!(shape.set_value(i, changed.clone()));
            assert_eq!(shape.values()[i], changed);
        }
        assert!(!shape.set_value(values.len(), ParamValue::Scalar(1.0)));
    }
}
