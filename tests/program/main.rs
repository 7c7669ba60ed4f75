//! The program as a user runs it, command by command.

#[path = "../common/mod.rs"]
mod common;
#[path = "../common/gltf.rs"]
mod gltf;
#[path = "../common/ran.rs"]
mod ran;

mod budget;
mod cli;
mod compare;
mod references;
mod reproduce;
mod sweep;
mod truth_command;
