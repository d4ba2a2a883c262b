//! Splits Rust and WGSL text into words and signs, without comments and the content of strings and numbers.

/// One word or sign of a source text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Token<'a> {
    /// The word, or one character.
    pub text: &'a str,
    /// Its line, from 1.
    pub line: usize,
}

/// The words and signs of `source` in order, without comments. A string or a character literal becomes an empty token.
/// Handles just enough of both languages: nested block comments, raw strings, and lifetimes that look like the start of
/// a character literal.
pub fn tokens(source: &str) -> Vec<Token<'_>> {
    let bytes = source.as_bytes();
    let (mut out, mut at, mut line) = (Vec::new(), 0, 1);
    while at < bytes.len() {
        let start = at;
        let rest = &source[at..];
        let mut literal = false;
        if rest.starts_with("//") {
            at += rest.find('\n').unwrap_or(rest.len());
            continue;
        } else if rest.starts_with("/*") {
            at += block_comment(rest);
            line += source[start..at].matches('\n').count();
            continue;
        } else if let Some(length) = string(rest) {
            (at, literal) = (at + length, true);
        } else if let Some(length) = character(rest) {
            (at, literal) = (at + length, true);
        } else {
            let word = rest.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(rest.len());
            at += if word > 0 { word } else { rest.chars().next().map_or(1, char::len_utf8) };
        }
        if literal {
            out.push(Token { text: "", line });
        } else if !source[start..at].trim().is_empty() {
            out.push(Token { text: &source[start..at], line });
        }
        line += source[start..at].matches('\n').count();
    }
    out
}

/// Length in bytes of the block comment at the start of `rest`.
fn block_comment(rest: &str) -> usize {
    let (mut depth, mut at) = (0_usize, 0);
    while at < rest.len() {
        match &rest.as_bytes()[at..] {
            [b'/', b'*', ..] => (depth, at) = (depth + 1, at + 2),
            [b'*', b'/', ..] => (depth, at) = (depth - 1, at + 2),
            _ => at += 1,
        }
        if depth == 0 {
            break;
        }
    }
    at
}

/// Length in bytes of the string literal at the start of `rest`, if any.
fn string(rest: &str) -> Option<usize> {
    let unprefixed = rest.trim_start_matches(['b', 'c']);
    let prefix = rest.len() - unprefixed.len();
    if let Some(raw) = unprefixed.strip_prefix('r') {
        let hashes = raw.len() - raw.trim_start_matches('#').len();
        let body = raw[hashes..].strip_prefix('"')?;
        let end = format!("\"{}", "#".repeat(hashes));
        return Some(prefix + 1 + hashes + 1 + body.find(&end).map_or(body.len(), |e| e + end.len()));
    }
    let body = unprefixed.strip_prefix('"').filter(|_| prefix <= 1)?;
    let mut escaped = false;
    for (i, c) in body.char_indices() {
        match c {
            _ if escaped => escaped = false,
            '\\' => escaped = true,
            '"' => return Some(prefix + 1 + i + 1),
            _ => {}
        }
    }
    Some(rest.len())
}

/// Length in bytes of the character literal at the start of `rest`, if any; `None` for a lifetime.
fn character(rest: &str) -> Option<usize> {
    let body = rest.strip_prefix('\'')?;
    if let Some(escape) = body.strip_prefix('\\') {
        // The first character after the backslash may be a quote itself.
        return escape.get(1..)?.find('\'').map(|i| 1 + 1 + 1 + i + 1);
    }
    let first = body.chars().next()?;
    body[first.len_utf8()..].starts_with('\'').then(|| first.len_utf8() + 2)
}

/// The index after the brace that closes the one at `open`.
pub fn closing(tokens: &[Token<'_>], open: usize) -> usize {
    let mut depth = 0_usize;
    for (i, token) in tokens.iter().enumerate().skip(open) {
        match token.text {
            "{" => depth += 1,
            "}" => depth = depth.saturating_sub(1),
            _ => continue,
        }
        if depth == 0 {
            return i + 1;
        }
    }
    tokens.len()
}

#[test]
fn comments_strings_and_lifetimes_do_not_confuse_it() {
    let source = "fn f<'a>(x: &'a str) { /* wgpu /* */ */ g(\"wgpu \\\" x\", 'x', '\\'', r#\"a\"b\"#) } // wgpu\nend";
    let words: Vec<_> = tokens(source).iter().map(|t| t.text).collect();
    assert!(!words.contains(&"wgpu") && !words.contains(&"b"), "{words:?}");
    assert_eq!(words.last(), Some(&"end"));
    assert_eq!(tokens(source).last().map(|t| t.line), Some(2));
    let open = words.iter().position(|w| *w == "{").unwrap();
    assert_eq!(words[closing(&tokens(source), open)], "end");
}
