//! Tables of a report, and the three ways they are written.

use comfy_table::{
    Cell as Drawn, CellAlignment, ContentLineStyle, LineStyle, Row, Table as Drawing, TableStyle, presets,
};

/// A value of a table.
#[derive(Clone, Debug, PartialEq)]
pub enum Cell {
    /// Words.
    Text(String),
    /// A count.
    Count(u64),
    /// A measured number, and how many decimals of it are shown; CSV has them all.
    Real(f64, usize),
    /// Nothing to say.
    None,
}

impl Cell {
    /// Words.
    pub fn text(text: impl Into<String>) -> Self {
        Self::Text(text.into())
    }

    /// A count, where there is one.
    pub fn count(count: Option<u64>) -> Self {
        count.map_or(Self::None, Self::Count)
    }

    fn shown(&self) -> String {
        match self {
            Self::Text(text) => text.clone(),
            Self::Count(count) => count.to_string(),
            Self::Real(value, decimals) => format!("{value:.decimals$}"),
            Self::None => "-".to_owned(),
        }
    }

    fn plain(&self) -> String {
        match self {
            Self::Real(value, _) => value.to_string(),
            Self::None => String::new(),
            other => other.shown(),
        }
    }

    fn alignment(&self) -> CellAlignment {
        if matches!(self, Self::Text(_)) { CellAlignment::Left } else { CellAlignment::Right }
    }
}

/// Rows under named columns.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    /// What it lists.
    pub name: &'static str,
    /// Names of the columns, units included.
    pub columns: Vec<&'static str>,
    /// The rows, each as long as `columns`.
    pub rows: Vec<Vec<Cell>>,
}

/// Columns apart by their padding, one rule below the header.
const PLAIN: TableStyle = TableStyle::new()
    .header_lines(ContentLineStyle::none())
    .header_separator(LineStyle::none().fill('-').junction('-'))
    .content_lines(ContentLineStyle::none());

impl Table {
    /// For a terminal.
    pub fn to_text(&self) -> String {
        self.draw(PLAIN, |text| text)
    }

    /// As Markdown.
    pub fn to_markdown(&self) -> String {
        self.draw(presets::ASCII_MARKDOWN, |text| text.replace('|', "\\|"))
    }

    fn draw(&self, style: TableStyle, escape: impl Fn(String) -> String) -> String {
        let mut drawing = Drawing::new();
        drawing.load_style(style);
        let aligned = |at: usize| match self.rows.first().and_then(|row| row.get(at)) {
            Some(cell) => cell.alignment(),
            None => CellAlignment::Left,
        };
        let header = self.columns.iter().enumerate();
        drawing.set_header(Row::from(header.map(|(at, name)| Drawn::new(name).set_alignment(aligned(at)))));
        for row in &self.rows {
            let cells = row.iter().map(|cell| Drawn::new(escape(cell.shown())).set_alignment(cell.alignment()));
            drawing.add_row(Row::from(cells));
        }
        drawing.trim_fmt()
    }
}

/// Tables as one CSV (RFC 4180): of several, the first column names the table, and the others are those of all.
pub fn to_csv(tables: &[Table]) -> Result<Vec<u8>, csv::Error> {
    let mut columns: Vec<&str> = Vec::new();
    for name in tables.iter().flat_map(|table| &table.columns) {
        if !columns.contains(name) {
            columns.push(name);
        }
    }
    let named = tables.len() > 1;
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(named.then_some("table").iter().chain(&columns))?;
    for table in tables {
        for row in &table.rows {
            let of = |column: &str| table.columns.iter().position(|c| *c == column).and_then(|at| row.get(at));
            let cells = columns.iter().map(|column| of(column).map(Cell::plain).unwrap_or_default());
            writer.write_record(named.then(|| table.name.to_owned()).into_iter().chain(cells))?;
        }
    }
    writer.into_inner().map_err(|error| error.into_error().into())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table(name: &'static str, columns: &[&'static str], row: &[Cell]) -> Table {
        Table { name, columns: columns.to_vec(), rows: vec![row.to_vec()] }
    }

    #[test]
    fn csv_of_one_table_is_the_table() {
        let one = table("a", &["name", "ms"], &[Cell::text("x, y"), Cell::Real(1.25, 1)]);
        assert_eq!(String::from_utf8(to_csv(&[one]).unwrap()).unwrap(), "name,ms\n\"x, y\",1.25\n");
    }

    #[test]
    fn csv_of_several_tables_has_the_columns_of_all() {
        let a = table("a", &["name", "ms"], &[Cell::text("x"), Cell::None]);
        let b = table("b", &["name", "bytes"], &[Cell::text("y"), Cell::Count(7)]);
        let text = String::from_utf8(to_csv(&[a, b]).unwrap()).unwrap();
        assert_eq!(text, "table,name,ms,bytes\na,x,,\nb,y,,7\n");
    }

    #[test]
    fn markdown_keeps_bars_inside_cells() {
        let text = table("a", &["words"], &[Cell::text("one | two")]).to_markdown();
        assert!(text.contains("one \\| two"), "{text}");
    }

    #[test]
    fn text_has_a_header_a_rule_and_the_rows() {
        let text = table("a", &["stage", "ms"], &[Cell::text("maps/gather"), Cell::Real(12.345, 2)]).to_text();
        let lines: Vec<_> = text.lines().collect();
        assert_eq!(lines.len(), 3, "{text}");
        assert!(lines[0].contains("stage") && lines[1].trim().chars().all(|c| c == '-') && lines[2].contains("12.35"));
    }
}
