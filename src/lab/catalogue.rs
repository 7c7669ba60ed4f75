//! What there is: methods with their settings, and the shipped scenes.

use serde::Serialize;

use super::{Cell, Report, Table};
use crate::{
    methods, renderer,
    scene::Scene,
    settings::{Setting, Settings},
};

/// Every method and every setting.
#[derive(Debug, Serialize)]
pub struct MethodsReport {
    schema: &'static str,
    methods: Vec<MethodRow>,
    settings: Vec<SettingRow>,
}

#[derive(Debug, Serialize)]
struct MethodRow {
    name: &'static str,
    title: &'static str,
    paper: &'static str,
    slots: Vec<&'static str>,
    needs: Vec<&'static str>,
}

#[derive(Debug, Serialize)]
struct SettingRow {
    setting: &'static str,
    unit: &'static str,
    default: String,
    range: String,
    doc: &'static str,
}

impl MethodsReport {
    /// From the tables of the methods and of the rooms they share.
    pub fn new() -> Self {
        let method = |m: &&'static dyn methods::Method| MethodRow {
            name: m.name(),
            title: m.title(),
            paper: m.paper(),
            slots: m.slots().iter().map(|s| s.name()).collect(),
            needs: m.needs(&Settings::default()).iter().map(|f| f.name()).collect(),
        };
        let setting = |s: Setting| SettingRow {
            setting: s.key(),
            unit: s.unit(),
            default: s.default_text(),
            range: s.range_text(),
            doc: s.doc(),
        };
        Self {
            schema: "nephroid.methods/1",
            methods: methods::ALL.iter().map(method).collect(),
            settings: renderer::all_settings().into_iter().map(setting).collect(),
        }
    }
}

impl Default for MethodsReport {
    fn default() -> Self {
        Self::new()
    }
}

impl Report for MethodsReport {
    fn tables(&self) -> Vec<Table> {
        let methods = self.methods.iter().map(|m| {
            vec![
                Cell::text(m.name),
                Cell::text(m.slots.join(", ")),
                Cell::text(m.needs.join(", ")),
                Cell::text(m.paper),
                Cell::text(m.title),
            ]
        });
        let settings = self.settings.iter().map(|s| {
            vec![
                Cell::text(s.setting),
                Cell::text(s.unit),
                Cell::text(&s.default),
                Cell::text(&s.range),
                Cell::text(s.doc),
            ]
        });
        vec![
            Table {
                name: "methods",
                columns: vec!["method", "slots", "needs", "paper", "what it does"],
                rows: methods.collect(),
            },
            Table {
                name: "settings",
                columns: vec!["setting", "unit", "default", "range", "what it sets"],
                rows: settings.collect(),
            },
        ]
    }
}

/// Every shipped scene.
#[derive(Debug, Serialize)]
pub struct ScenesReport {
    schema: &'static str,
    scenes: Vec<SceneRow>,
}

#[derive(Debug, Serialize)]
struct SceneRow {
    name: &'static str,
    title: String,
}

impl ScenesReport {
    /// From what the program carries.
    pub fn new() -> Self {
        let scenes = Scene::shipped().chain(Scene::of_papers()).map(|(name, title)| SceneRow { name, title }).collect();
        Self { schema: "nephroid.scenes/1", scenes }
    }
}

impl Default for ScenesReport {
    fn default() -> Self {
        Self::new()
    }
}

impl Report for ScenesReport {
    fn tables(&self) -> Vec<Table> {
        let rows = self.scenes.iter().map(|s| vec![Cell::text(s.name), Cell::text(&s.title)]);
        vec![Table { name: "scenes", columns: vec!["name", "title"], rows: rows.collect() }]
    }
}
