//! The report as tables: stages, frame, photons for readers; every sample for programs.

use serde_json::{Map, Value};

use super::{EnergyRow, RenderReport};
use crate::{
    lab::{Cell, Report, Table},
    passes::account::BUCKETS,
    stats,
};

/// Decimals of milliseconds: microseconds are the finest that repeat.
const MS: usize = 3;

impl Report for RenderReport {
    fn heading(&self) -> Vec<String> {
        let [width, height] = self.size;
        let device = &self.device;
        let frames = self.frames.span_ms.len();
        vec![
            format!("{}, method {}, camera {}, {width}x{height} pixels", self.scene, self.method, self.camera),
            format!("{} ({}), {}, {frames} timed frames", device.name, device.kind, device.driver),
        ]
    }

    fn tables(&self) -> Vec<Table> {
        vec![self.stage_table(), self.frame_table(), self.photon_table()]
    }

    fn csv_tables(&self) -> Vec<Table> {
        let device = [Cell::text(&self.device.name), Cell::text(self.device.kind)];
        let row =
            |path: &str, frame, ms: f64| [vec![Cell::text(path), frame, Cell::Real(ms, MS)], device.to_vec()].concat();
        let samples = |path: &str, samples: &[f64]| -> Vec<_> {
            samples.iter().enumerate().map(|(at, &ms)| row(path, Cell::Count(at as u64), ms)).collect()
        };
        let stages = self.stages.iter().flat_map(|s| samples(&s.path, &s.samples_ms));
        let whole = self.frames.rows().into_iter().flat_map(|(path, ms)| samples(path, ms));
        let prepare = self.prepare.iter().map(|p| row(p.path, Cell::None, p.ms));
        let columns = vec!["stage", "frame", "ms", "device", "device_kind"];
        vec![Table { name: "timings", columns, rows: stages.chain(whole).chain(prepare).collect() }]
    }

    fn notes(&self) -> Vec<String> {
        let mut notes: Vec<String> = self.energy.iter().map(light).collect();
        notes.push(format!(
            "image.png: exposure {} EV; pixels that are not finite: {}",
            self.exposure_ev, self.nonfinite_pixels
        ));
        notes.extend(self.energy.as_ref().and_then(|energy| energy.counted.as_ref()).map(|c| {
            format!(
                "cells: {} light samples, {} cells traced finer, {} left by maps.adapt_most; {:.6} W arrive in the map, of it \
                 {:.6} W as points",
                c.samples, c.refined, c.left, c.arrived_w, c.points_w
            )
        }));
        notes.extend(self.unresolved.as_ref().map(|left| {
            format!(
                "water: of {} triangles of rays {} are met from behind and {} grazed, and left out; {} pixels' searches were ended",
                left.triangles, left.dark, left.grazed, left.cut_pixels
            )
        }));
        notes.extend(self.warnings.iter().map(|warning| format!("warning: {warning}")));
        if self.device.software {
            let device = &self.device.name;
            notes.push(format!(
                "times: {device} is a software device; they compare designs on it, and are no figures for a GPU"
            ));
        }
        notes
    }
}

/// Where the light went, in a line.
fn light(energy: &EnergyRow) -> String {
    let ratio = energy.ratio.map_or("no photon is valid".to_owned(), |r| {
        let came = if energy.counted.is_some() { "arrived" } else { "valid" };
        format!("deposited / {came} {r:.6}")
    });
    let EnergyRow { emitted_w, valid_w, deposited_w, .. } = energy;
    format!("light: emitted {emitted_w:.6} W, valid {valid_w:.6} W, deposited {deposited_w:.6} W, {ratio}")
}

impl RenderReport {
    fn stage_table(&self) -> Table {
        let span = self.frame.span_ms;
        let rows = self.stages.iter().map(|s| {
            vec![
                Cell::text(&s.path),
                Cell::Real(s.median_ms, MS),
                Cell::Real(s.mad_ms, MS),
                Cell::Real(if span > 0.0 { 100.0 * s.median_ms / span } else { 0.0 }, 1),
                Cell::count(s.counters.points),
                Cell::count(s.counters.fragments),
                Cell::count(s.counters.invocations),
                Cell::Count(s.counters.bytes),
            ]
        });
        let columns =
            vec!["stage", "median ms", "MAD ms", "% of span", "points", "fragments", "invocations", "target bytes"];
        Table { name: "stages", columns, rows: rows.collect() }
    }

    fn frame_table(&self) -> Table {
        let row = |path: &str, median: f64, mad| vec![Cell::text(path), Cell::Real(median, MS), mad];
        let whole = self.frames.rows().map(|(path, ms)| row(path, stats::median(ms), Cell::Real(stats::mad(ms), MS)));
        let once = self.prepare.iter().map(|p| row(p.path, p.ms, Cell::None));
        let startup = row("startup", self.startup_ms, Cell::None);
        let rows = whole.into_iter().chain(once).chain([startup]).collect();
        Table { name: "frame", columns: vec!["frame, and once before it", "median ms", "MAD ms"], rows }
    }

    fn photon_table(&self) -> Table {
        let of = |values: &Map<String, Value>, name: &str| values.get(name).cloned().unwrap_or_default();
        let shown = self.photons.as_ref().zip(self.energy.as_ref());
        let shown = shown.filter(|(photons, _)| of(photons, BUCKETS[0]).as_u64() != Some(0));
        let row = |(photons, energy): (&Map<String, Value>, &EnergyRow), name: &str| {
            let flux = of(&energy.flux_w, name).as_f64().unwrap_or(f64::NAN);
            vec![Cell::text(name), Cell::count(of(photons, name).as_u64()), Cell::Real(flux, 6)]
        };
        let rows = |shown| BUCKETS.into_iter().chain(["other_paths"]).map(|name| row(shown, name)).collect();
        let rows = shown.map(rows).unwrap_or_default();
        Table { name: "photons", columns: vec!["photons", "count", "flux W"], rows }
    }
}
