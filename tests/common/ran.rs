//! What a run of the program left.
#![allow(dead_code)] // each test binary uses its own part

use std::process::Output;

use serde_json::Value;

pub struct Ran {
    pub code: Option<i32>,
    pub out: String,
    pub err: String,
}

impl From<Output> for Ran {
    fn from(output: Output) -> Self {
        let text = |bytes: Vec<u8>| String::from_utf8(bytes).expect("the program writes UTF-8");
        let ran = Self { code: output.status.code(), out: text(output.stdout), err: text(output.stderr) };
        assert!(!ran.err.contains("panicked"), "{}", ran.err);
        assert!(!format!("{}{}", ran.out, ran.err).contains('\x1b'), "colours where no terminal is");
        ran
    }
}

impl Ran {
    #[track_caller]
    pub fn ok(self) -> Self {
        self.code(0)
    }

    #[track_caller]
    pub fn code(self, code: i32) -> Self {
        assert_eq!(self.code, Some(code), "{}{}", self.out, self.err);
        self
    }

    /// Every word stands on stderr.
    #[track_caller]
    pub fn says(self, words: &[&str]) -> Self {
        for word in words {
            assert!(self.err.contains(word), "no `{word}` in: {}", self.err);
        }
        self
    }

    #[track_caller]
    pub fn json(&self) -> Value {
        serde_json::from_str(&self.out).unwrap_or_else(|_| panic!("no JSON on stdout: {}{}", self.out, self.err))
    }

    #[track_caller]
    pub fn rows(&self) -> Vec<Vec<String>> {
        rows(self.out.as_bytes())
    }
}

/// Records of a CSV, the header first; all are of one length, or this fails.
#[track_caller]
pub fn rows(csv: &[u8]) -> Vec<Vec<String>> {
    let records = csv::ReaderBuilder::new().has_headers(false).from_reader(csv).into_records();
    records.map(|r| r.expect("a record of the header's length").iter().map(str::to_owned).collect()).collect()
}
