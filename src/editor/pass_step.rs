//! Steps through the passes over the parts of a scene.

/// A step from one pass to another.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum PassStep {
    /// To the one after it; from the last, or from the whole picture, to the first.
    Next,
    /// To the one before it; from the first, or from the whole picture, to the last.
    Previous,
    /// To the whole picture.
    All,
}

impl PassStep {
    /// The pass that it leads to, of `count`; `None` for the whole picture.
    pub fn stepped(self, now: Option<u32>, count: u32) -> Option<u32> {
        match (self, now) {
            (Self::All, _) => None,
            _ if count == 0 => None,
            (Self::Next, Some(at)) if at < count => Some(at + 1),
            (Self::Next, _) => Some(1),
            (Self::Previous, Some(at)) if at > 1 => Some(at.min(count + 1) - 1),
            (Self::Previous, _) => Some(count),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_go_around_and_back_to_the_whole_picture() {
        let next = |now| PassStep::Next.stepped(now, 3);
        assert_eq!([next(None), next(Some(1)), next(Some(3))], [Some(1), Some(2), Some(1)]);
        let previous = |now| PassStep::Previous.stepped(now, 3);
        assert_eq!([previous(None), previous(Some(2)), previous(Some(1))], [Some(3), Some(1), Some(3)]);
        assert_eq!(previous(Some(9)), Some(3), "the scene had more passes before");
        assert_eq!(PassStep::All.stepped(Some(2), 3), None);
        assert_eq!(PassStep::Next.stepped(None, 0), None);
    }
}
