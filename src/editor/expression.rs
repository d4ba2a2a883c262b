//! Expressions for number fields: numbers, + − × ÷ ^, brackets, `pi`, `sqrt`, `sin`, `cos`, `tan`.

/// The value of the text, or `None` if it is not a valid expression. Angles of functions are in degrees.
pub fn evaluate(text: &str) -> Option<f64> {
    let cleaned: String = text
        .chars()
        .filter(|c| !c.is_whitespace())
        .map(|c| match c {
            '−' => '-',
            '×' => '*',
            '÷' => '/',
            ',' => '.',
            c => c.to_ascii_lowercase(),
        })
        .collect();
    let number = cleaned.trim_end_matches(['m', '°']);
    let mut parser = Parser { rest: number, depth: 0 };
    let value = parser.sum()?;
    (parser.rest.is_empty() && value.is_finite()).then_some(value)
}

struct Parser<'a> {
    rest: &'a str,
    depth: u32,
}

impl Parser<'_> {
    /// Deeper nesting of brackets is refused, to protect the stack.
    const MAX_DEPTH: u32 = 64;

    fn take(&mut self, token: &str) -> bool {
        match self.rest.strip_prefix(token) {
            Some(rest) => {
                self.rest = rest;
                true
            }
            None => false,
        }
    }

    fn sum(&mut self) -> Option<f64> {
        let mut value = self.product()?;
        loop {
            if self.take("+") {
                value += self.product()?;
            } else if self.take("-") {
                value -= self.product()?;
            } else {
                return Some(value);
            }
        }
    }

    fn product(&mut self) -> Option<f64> {
        let mut value = self.power()?;
        loop {
            if self.take("*") {
                value *= self.power()?;
            } else if self.take("/") {
                value /= self.power()?;
            } else {
                return Some(value);
            }
        }
    }

    fn power(&mut self) -> Option<f64> {
        self.depth += 1;
        if self.depth > Self::MAX_DEPTH {
            return None;
        }
        let value = if self.take("-") {
            -self.power()?
        } else if self.take("+") {
            self.power()?
        } else {
            let base = self.atom()?;
            if self.take("^") { base.powf(self.power()?) } else { base }
        };
        self.depth -= 1;
        Some(value)
    }

    fn atom(&mut self) -> Option<f64> {
        if self.take("pi") || self.take("π") {
            return Some(std::f64::consts::PI);
        }
        for (name, function) in FUNCTIONS {
            if self.take(name) {
                return self.bracket().map(function);
            }
        }
        if self.rest.starts_with('(') {
            return self.bracket();
        }
        self.number()
    }

    fn bracket(&mut self) -> Option<f64> {
        self.take("(").then_some(())?;
        let value = self.sum()?;
        self.take(")").then_some(value)
    }

    fn number(&mut self) -> Option<f64> {
        let mut end = 0;
        let bytes = self.rest.as_bytes();
        while let Some(&b) = bytes.get(end) {
            let exponent_sign = end > 0 && matches!(b, b'+' | b'-') && bytes[end - 1] == b'e';
            if !(b.is_ascii_digit() || b == b'.' || (b == b'e' && end > 0) || exponent_sign) {
                break;
            }
            end += 1;
        }
        let value = self.rest[..end].parse().ok()?;
        self.rest = &self.rest[end..];
        Some(value)
    }
}

type Function = fn(f64) -> f64;

const FUNCTIONS: [(&str, Function); 4] = [
    ("sqrt", f64::sqrt),
    ("sin", |v| v.to_radians().sin()),
    ("cos", |v| v.to_radians().cos()),
    ("tan", |v| v.to_radians().tan()),
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_products_powers_and_names() {
        for (text, value) in [
            ("3*2", 6.0),
            ("1+2*3", 7.0),
            ("(1+2)*3", 9.0),
            ("-2^2", -4.0),
            ("2^-1", 0.5),
            ("10/4", 2.5),
            ("1e-3", 1e-3),
            ("1.5e+2", 150.0),
            ("pi*2", std::f64::consts::TAU),
            ("sqrt(2)^2", 2.0),
            ("sin(90)", 1.0),
            ("0,5 m", 0.5),
            ("45°", 45.0),
            ("−3", -3.0),
        ] {
            let got = evaluate(text).unwrap();
            assert!((got - value).abs() < 1e-12, "{text}: {got}");
        }
    }

    #[test]
    fn nonsense_and_infinity_are_refused() {
        for text in ["", "abc", "1/0", "2*", "(1", "1)", "1..2", "sqrt(-1)", "1e999"] {
            assert_eq!(evaluate(text), None, "{text}");
        }
        assert_eq!(evaluate(&"(".repeat(100_000)), None);
        assert_eq!(evaluate(&"+".repeat(100)), None);
    }
}
