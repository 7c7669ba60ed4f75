//! Floor 5: experiments and their reports. A report is data; writers draw tables, Markdown, CSV and JSON from it and
//! never time anything.

mod catalogue;
mod colour_bar;
mod compare;
mod compare_error;
mod compare_maps;
mod compare_report;
mod compare_scene;
mod compare_warnings;
mod devices;
mod doctor;
mod experiment;
mod files;
mod picture;
mod plan_report;
pub mod plot;
mod provenance;
mod reference;
mod render_report;
mod report;
mod scene_report;
mod sequence;
mod table;
pub mod timing;
mod tracers;

pub use catalogue::{MethodsReport, ScenesReport};
pub use compare::{Comparison, Constants, MEASURES, compare};
pub use compare_error::CompareError;
pub use compare_maps::error_maps;
pub use compare_report::{CompareReport, Limit};
pub use devices::{DeviceRow, DevicesReport};
pub use doctor::DoctorReport;
pub use experiment::{Experiment, LabError, Measured, Step};
pub use files::{dump_file, write_dump, write_outputs, write_pictures, write_result};
pub use picture::Picture;
pub use plan_report::PlanReport;
pub use provenance::{Provenance, Run, exposure};
pub use reference::{Auto, Making, SUMS, Sparing, TRUTHS};
pub use render_report::RenderReport;
pub use report::{Format, Report};
pub use scene_report::SceneReport;
pub use sequence::{Sequence, SequenceFrame, SequenceReport};
pub use table::{Cell, Table, to_csv};
pub use tracers::{Compared, Figures, Spread, Subject, TracersReport, Verdict, compare_tracers, tracer_map};
