//! `nephroid reproduce`: published figures are those of the papers, measured ones never stand alone, and what is not
//! run says why.

mod command;
mod published;
mod tiny;
