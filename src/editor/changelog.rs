//! The changelog as the window shows it: headings and items.

/// The changelog of the program.
const CHANGELOG: &str = include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/../../CHANGELOG.md"));

/// A line of the changelog.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum NewsLine {
    /// A version.
    Version(String),
    /// A kind of changes.
    Heading(String),
    /// A change.
    Item(String),
}

/// The lines of the latest `versions` versions.
pub fn news(versions: usize) -> Vec<NewsLine> {
    parsed(CHANGELOG, versions)
}

fn parsed(text: &str, versions: usize) -> Vec<NewsLine> {
    let mut lines: Vec<NewsLine> = Vec::new();
    let mut seen = 0;
    for line in text.lines() {
        if let Some(version) = line.strip_prefix("## ") {
            seen += 1;
            if seen > versions {
                break;
            }
            lines.push(NewsLine::Version(plain(version)));
        } else if let Some(heading) = line.strip_prefix("### ") {
            lines.push(NewsLine::Heading(plain(heading)));
        } else if let Some(item) = line.trim_start().strip_prefix("- ") {
            lines.push(NewsLine::Item(plain(item)));
        } else if let (Some(NewsLine::Item(item)), false) = (lines.last_mut(), line.trim().is_empty()) {
            // A paragraph goes on.
            item.push(' ');
            item.push_str(&plain(line.trim()));
        }
    }
    lines
}

/// The text without the signs of Markdown.
fn plain(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(at) = rest.find(['*', '`', '[']) {
        out.push_str(&rest[..at]);
        let sign = rest.as_bytes()[at];
        rest = &rest[at + 1..];
        if sign == b'[' {
            // A link keeps its text.
            let (name, after) = rest.split_once(']').unwrap_or((rest, ""));
            out.push_str(name);
            rest = match after.strip_prefix('(').and_then(|target| target.split_once(')')) {
                Some((_, after)) => after,
                None => after,
            };
        }
    }
    out + rest
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn headings_items_and_their_further_lines_are_read() {
        let text = "# Changelog\n\nAll changes.\n\n## 2.0\n\n### Added\n\n- *A* `thing`\n  that goes on.\n- [Link](x.md).\n\n## 1.0\n- old\n";
        let item = |text: &str| NewsLine::Item(text.into());
        let expected = [
            NewsLine::Version("2.0".into()),
            NewsLine::Heading("Added".into()),
            item("A thing that goes on."),
            item("Link."),
        ];
        assert_eq!(parsed(text, 1), expected);
        assert_eq!(parsed(text, 9).len(), 6);
    }

    #[test]
    fn there_is_something_new() {
        let lines = news(1);
        assert!(matches!(lines.first(), Some(NewsLine::Version(_))) && lines.len() > 3, "{lines:?}");
    }
}
