//! What every report can do: be JSON, be tables, and so be written in any format.

use super::table::{Table, to_csv};

/// How a report is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Aligned columns, for a terminal.
    Table,
    /// The report itself, versioned by its `schema`.
    Json,
    /// Rows under a header.
    Csv,
    /// Markdown.
    Markdown,
}

/// Data that writers draw from.
pub trait Report: serde::Serialize {
    /// Its tables, for readers.
    fn tables(&self) -> Vec<Table>;

    /// Its tables, for programs that read CSV.
    fn csv_tables(&self) -> Vec<Table> {
        self.tables()
    }

    /// What stands above the tables.
    fn heading(&self) -> Vec<String> {
        Vec::new()
    }

    /// What stands below them.
    fn notes(&self) -> Vec<String> {
        Vec::new()
    }

    /// The report in a format, ending in a new line. Errors are those of the encoders: none is expected.
    fn write(&self, format: Format) -> std::io::Result<Vec<u8>> {
        match format {
            Format::Json => {
                let mut bytes = serde_json::to_vec_pretty(self)?;
                bytes.push(b'\n');
                Ok(bytes)
            }
            Format::Csv => to_csv(&self.csv_tables()).map_err(std::io::Error::other),
            Format::Table => Ok(self.prose(Table::to_text, "\n").into_bytes()),
            Format::Markdown => Ok(self.prose(Table::to_markdown, "\n\n").into_bytes()),
        }
    }

    /// Heading, tables with rows, notes: paragraphs, with an empty line between. `line` ends a line of the prose.
    fn prose(&self, draw: fn(&Table) -> String, line: &str) -> String {
        let drawn = self.tables().into_iter().filter(|table| !table.rows.is_empty()).map(|table| draw(&table));
        let [heading, notes] = [self.heading(), self.notes()].map(|lines| lines.join(line));
        let parts = [heading].into_iter().chain(drawn).chain([notes]);
        let parts: Vec<_> = parts.filter(|part| !part.is_empty()).collect();
        parts.join("\n\n") + "\n"
    }
}
