//! Units in which the fields show lengths. The scene always holds meters.

use egui::{Context, Id};

use super::expression;

/// A unit of length.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LengthUnit {
    /// Meters, as in the file.
    #[default]
    Meters,
    /// Centimeters.
    Centimeters,
    /// Millimeters.
    Millimeters,
    /// Inches of 25.4 mm.
    Inches,
}

impl LengthUnit {
    /// Every unit.
    pub const ALL: [Self; 4] = [Self::Meters, Self::Centimeters, Self::Millimeters, Self::Inches];

    /// Its sign; also its name in the preferences.
    pub fn sign(self) -> &'static str {
        match self {
            Self::Meters => "m",
            Self::Centimeters => "cm",
            Self::Millimeters => "mm",
            Self::Inches => "in",
        }
    }

    /// Its name.
    pub fn label(self) -> &'static str {
        match self {
            Self::Meters => "Meters (m)",
            Self::Centimeters => "Centimeters (cm)",
            Self::Millimeters => "Millimeters (mm)",
            Self::Inches => "Inches (in)",
        }
    }

    /// Its length in meters.
    pub fn meters(self) -> f64 {
        match self {
            Self::Meters => 1.0,
            Self::Centimeters => 0.01,
            Self::Millimeters => 0.001,
            Self::Inches => 0.0254,
        }
    }

    /// The unit of this sign; meters if there is none.
    pub fn named(sign: &str) -> Self {
        Self::ALL.into_iter().find(|unit| unit.sign() == sign).unwrap_or_default()
    }

    /// The unit in use.
    pub fn of(ctx: &Context) -> Self {
        ctx.data(|data| data.get_temp(Id::unique("unit of lengths"))).unwrap_or_default()
    }

    /// Puts it to use. Call once a frame, before all panels.
    pub fn install(self, ctx: &Context) {
        ctx.data_mut(|data| data.insert_temp(Id::unique("unit of lengths"), self));
    }
}

/// How a field shows its numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FieldUnit {
    /// The sign behind them; empty for plain numbers.
    pub sign: &'static str,
    /// The value of a shown 1.
    pub one: f64,
}

impl FieldUnit {
    /// For a parameter of this unit.
    pub fn new(unit: &'static str, lengths: LengthUnit) -> Self {
        match unit {
            "m" => Self { sign: lengths.sign(), one: lengths.meters() },
            _ => Self { sign: unit, one: 1.0 },
        }
    }

    /// The value that a text means. A length may name its unit.
    pub fn typed(self, text: &str) -> Option<f64> {
        let is_length = LengthUnit::ALL.into_iter().any(|unit| unit.sign() == self.sign);
        // The longer signs first: `mm` ends in `m`, too.
        for unit in [LengthUnit::Millimeters, LengthUnit::Centimeters, LengthUnit::Inches, LengthUnit::Meters] {
            let trimmed = text.trim_end().to_ascii_lowercase();
            if let Some(number) = trimmed.strip_suffix(unit.sign()).filter(|_| is_length) {
                return expression::evaluate(number).map(|value| value * unit.meters());
            }
        }
        expression::evaluate(text).map(|value| value * self.one)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_typed_length_is_in_the_unit_in_use_or_in_its_own() {
        let inches = FieldUnit::new("m", LengthUnit::Inches);
        for (text, meters) in
            [("10", 0.254), ("10 in", 0.254), ("3 mm", 0.003), ("2*3 cm", 0.06), ("1.5m", 1.5), ("1 M", 1.0)]
        {
            let typed = inches.typed(text).expect(text);
            assert!((typed - meters).abs() < 1e-12, "{text}: {typed}");
        }
        assert_eq!(inches.typed("ten in"), None);
        let angle = FieldUnit::new("°", LengthUnit::Inches);
        assert_eq!((angle.typed("90"), angle.typed("90°"), angle.sign), (Some(90.0), Some(90.0), "°"));
        assert_eq!(angle.typed("90 cm"), None);
    }

    #[test]
    fn every_unit_is_found_by_its_sign() {
        for unit in LengthUnit::ALL {
            assert_eq!(LengthUnit::named(unit.sign()), unit);
        }
        assert_eq!(LengthUnit::named("furlong"), LengthUnit::Meters);
    }
}
