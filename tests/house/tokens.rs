//! Rust source as tokens with their lines: comments, strings and characters are gone, so words in them mean nothing.

/// A word, a number, or one sign (`::` counts as one).
#[derive(Clone, Debug, PartialEq)]
pub struct Token {
    pub text: String,
    /// From 1.
    pub line: usize,
}

/// Cuts source into tokens. Unfinished strings and comments reach to the end of the source.
pub fn tokens(source: &str) -> Vec<Token> {
    let mut cutter = Cutter { chars: source.chars().collect(), at: 0, line: 1 };
    let mut found = Vec::new();
    while let Some(here) = cutter.peek(0) {
        let (from, line) = (cutter.at, cutter.line);
        if cutter.skip_comment() || cutter.skip_string() || cutter.skip_character() {
            continue;
        }
        cutter.step();
        if is_word(here) {
            while cutter.peek(0).is_some_and(is_word) {
                cutter.step();
            }
        } else if here == ':' && cutter.peek(0) == Some(':') {
            cutter.step();
        }
        if !here.is_whitespace() {
            found.push(Token { text: cutter.chars[from..cutter.at].iter().collect(), line });
        }
    }
    found
}

fn is_word(c: char) -> bool {
    c.is_alphanumeric() || c == '_'
}

struct Cutter {
    chars: Vec<char>,
    at: usize,
    line: usize,
}

impl Cutter {
    fn peek(&self, ahead: usize) -> Option<char> {
        self.chars.get(self.at + ahead).copied()
    }

    fn step(&mut self) {
        self.line += usize::from(self.peek(0) == Some('\n'));
        self.at += 1;
    }

    fn starts(&self, text: &str) -> bool {
        text.chars().enumerate().all(|(i, c)| self.peek(i) == Some(c))
    }

    fn steps(&mut self, count: usize) {
        for _ in 0..count {
            self.step();
        }
    }

    fn skip_until(&mut self, end: &str) {
        while self.peek(0).is_some() && !self.starts(end) {
            self.step();
        }
    }

    /// Line comments and nested block comments.
    fn skip_comment(&mut self) -> bool {
        if self.starts("//") {
            self.skip_until("\n");
            return true;
        }
        if !self.starts("/*") {
            return false;
        }
        let mut depth = 0;
        while self.peek(0).is_some() {
            let (opens, closes) = (self.starts("/*"), self.starts("*/"));
            self.steps(if opens || closes { 2 } else { 1 });
            depth += i32::from(opens) - i32::from(closes);
            if depth == 0 {
                break;
            }
        }
        true
    }

    /// `"…"`, `b"…"`, `c"…"`, `r"…"`, `r#"…"#`; a raw identifier (`r#type`) is none of these.
    fn skip_string(&mut self) -> bool {
        if self.at > 0 && is_word(self.chars[self.at - 1]) {
            return false;
        }
        let letters = (0..).take_while(|&i| matches!(self.peek(i), Some('b' | 'c' | 'r'))).count();
        let raw = letters > 0 && self.peek(letters - 1) == Some('r');
        let hashes = if raw { (letters..).take_while(|&i| self.peek(i) == Some('#')).count() } else { 0 };
        if letters > 2 || self.peek(letters + hashes) != Some('"') {
            return false;
        }
        self.steps(letters + hashes + 1);
        if raw {
            let end = format!("\"{}", "#".repeat(hashes));
            self.skip_until(&end);
            self.steps(end.len());
        } else {
            while self.peek(0).is_some_and(|c| c != '"') {
                self.steps(if self.peek(0) == Some('\\') { 2 } else { 1 });
            }
            self.step();
        }
        true
    }

    /// `'a'`, `'\''`, `'\u{e9}'`; of a lifetime (`'a`) only the quote is skipped.
    fn skip_character(&mut self) -> bool {
        if self.peek(0) != Some('\'') {
            return false;
        }
        if self.peek(1) == Some('\\') {
            self.steps(3);
            self.skip_until("'");
            self.step();
        } else if self.peek(2) == Some('\'') {
            self.steps(3);
        } else {
            self.step();
        }
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texts(source: &str) -> Vec<String> {
        tokens(source).into_iter().map(|t| t.text).collect()
    }

    #[test]
    fn words_and_signs_are_cut_with_their_lines() {
        assert_eq!(texts("use crate::a;"), ["use", "crate", "::", "a", ";"]);
        assert_eq!(tokens("a\n\n b").last(), Some(&Token { text: "b".into(), line: 3 }));
    }

    #[test]
    fn comments_strings_and_characters_say_nothing() {
        assert_eq!(texts("a // b\nc /* d /* e */ f */ g"), ["a", "c", "g"]);
        assert_eq!(texts(r##"a("b\"c", r#"d"e"#, b"f", r"\") g"##), ["a", "(", ",", ",", ",", ")", "g"]);
        assert_eq!(texts(r"x = '\''; y = 'z'; w = '\u{e9}'"), ["x", "=", ";", "y", "=", ";", "w", "="]);
    }

    #[test]
    fn lifetimes_and_raw_words_stay() {
        assert_eq!(texts("&'a str"), ["&", "a", "str"]);
        assert_eq!(texts("r#type"), ["r", "#", "type"]);
        assert_eq!(tokens("\"\n\n\" a"), [Token { text: "a".into(), line: 3 }]);
    }
}
