//! Numbers typed during a transform: expressions, one for each axis.

use crate::expression;

/// The typed texts.
#[derive(Clone, Debug, Default)]
pub struct Typed {
    texts: [String; 3],
    at: usize,
}

impl Typed {
    /// Whether nothing has been typed.
    pub fn is_empty(&self) -> bool {
        self.texts.iter().all(String::is_empty)
    }

    /// Takes a character, if expressions have it.
    pub fn push(&mut self, character: char) {
        const LONGEST: usize = 64;
        let text = &mut self.texts[self.at];
        // Letters begin only functions and `pi`.
        let fits = character.is_ascii_digit() || ".,+-*/^() ".contains(character) || character.is_ascii_lowercase();
        if fits && text.len() < LONGEST {
            text.push(character);
        }
    }

    /// Takes the last character back.
    pub fn pop(&mut self) {
        self.texts[self.at].pop();
    }

    /// Continues with the next of `count` numbers.
    pub fn next(&mut self, count: usize) {
        self.at = (self.at + 1) % count.clamp(1, 3);
    }

    /// The number at an index; 0 if nothing has been typed there, `None` while the text is no number.
    pub fn value(&self, index: usize) -> Option<f64> {
        let text = self.texts.get(index)?;
        if text.is_empty() { Some(0.0) } else { expression::evaluate(text) }
    }

    /// The texts of `count` numbers, with a mark where the next character lands.
    pub fn shown(&self, count: usize) -> String {
        let text = |i: usize| {
            let mark = if i == self.at { "|" } else { "" };
            let text = if self.texts[i].is_empty() && i != self.at { "0" } else { &self.texts[i] };
            format!("{text}{mark}")
        };
        (0..count.clamp(1, 3)).map(text).collect::<Vec<_>>().join(", ")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn expressions_are_typed_one_after_the_other() {
        let mut typed = Typed::default();
        assert!(typed.is_empty());
        "3*2".chars().for_each(|c| typed.push(c));
        assert_eq!((typed.value(0), typed.value(1)), (Some(6.0), Some(0.0)));
        typed.next(2);
        "-sqrt(4".chars().for_each(|c| typed.push(c));
        assert_eq!(typed.value(1), None, "not yet a number");
        typed.push(')');
        assert_eq!(typed.value(1), Some(-2.0));
        assert_eq!(typed.shown(2), "3*2, -sqrt(4)|");
        typed.next(2);
        (0..5).for_each(|_| typed.pop());
        assert_eq!(typed.value(0), Some(0.0));
        typed.push('%');
        assert_eq!(typed.shown(1), "|");
    }
}
