//! `nephroid.reproductions/1`: every published table and figure, and what of it runs here.

use serde::Serialize;

use crate::lab::{
    Cell, Report, Table,
    papers::{self, Published},
    reproduce::columns,
};

/// Every table and figure, and whether it runs here.
#[derive(Debug, Serialize)]
pub struct CatalogueReport {
    schema: &'static str,
    entries: Vec<Entry>,
}

#[derive(Debug, Serialize)]
struct Entry {
    id: String,
    paper: String,
    figures: usize,
    /// Figures whose column can be run.
    runs: usize,
    missing: Vec<String>,
}

impl Default for CatalogueReport {
    fn default() -> Self {
        Self { schema: "nephroid.reproductions/1", entries: papers::all().iter().map(Entry::of).collect() }
    }
}

impl Entry {
    fn of(published: &Published) -> Self {
        let why = published.figures.iter().map(|figure| columns::asked(published, figure).err());
        let why: Vec<Option<String>> = why.collect();
        let mut missing: Vec<String> = why.iter().flatten().cloned().collect();
        missing.sort();
        missing.dedup();
        let runs = why.iter().filter(|w| w.is_none()).count();
        let (id, paper) = (published.id.clone(), published.paper.clone());
        Self { id, paper, figures: why.len(), runs, missing }
    }
}

impl Report for CatalogueReport {
    fn tables(&self) -> Vec<Table> {
        let rows = self.entries.iter().map(|e| {
            let missing = if e.missing.is_empty() { Cell::None } else { Cell::text(e.missing.join("; ")) };
            let (figures, runs) = (Cell::Count(e.figures as u64), Cell::Count(e.runs as u64));
            vec![Cell::text(&e.id), figures, runs, Cell::text(&e.paper), missing]
        });
        vec![Table {
            name: "reproductions",
            columns: vec!["id", "figures", "run here", "paper", "missing"],
            rows: rows.collect(),
        }]
    }
}
