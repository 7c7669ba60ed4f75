//! What the prose of Wyman 2008 claims, as measured figures.

use super::{
    asked::{Asked, Pick, Place},
    columns::{COPY_2006, Part, Variant, gather},
    subject::Subject,
};

/// N of the largest photon buffer, where speed-ups are "up to".
const LARGEST: u32 = 4096;
/// "More than one million photons."
const MILLIONS: [u32; 3] = [1024, 2048, 4096];
/// All N of its tables.
const EVERY: [u32; 5] = [256, 512, 1024, 2048, 4096];
/// N of its Fig. 3, which shows what is dropped.
const SHOWN: u32 = 512;

/// What a claim asks; else what is missing.
pub fn asked(column: &str) -> Result<Asked, String> {
    let draw = |variant: Variant, side| Place { variant, side, part: Part::Gather };
    let preset = |name, side| draw(gather(name), side);
    let pairs = |sides: &[u32], a, b| sides.iter().map(|&side| (preset(a, side), preset(b, side))).collect();
    let shown = preset("hierarchical", SHOWN);
    Ok(match column {
        "saved_by_geometry_shader_discard" => {
            let discards = Variant { cull: "geometry", ..gather("fetch") };
            Asked::Saved(vec![(preset("fetch", SHOWN), draw(discards, SHOWN))], Pick::Most)
        }
        "dropped_a_level_least" => Asked::Dropped(shown, Pick::Least),
        "dropped_a_level_most" => Asked::Dropped(shown, Pick::Most),
        "hierarchical_pays_from" => Asked::PaysFrom(pairs(&EVERY, "fetch", "hierarchical")),
        "saved_by_combine_last_least" => Asked::Saved(pairs(&MILLIONS, "hierarchical", "combine-last"), Pick::Least),
        "saved_by_combine_last_most" => Asked::Saved(pairs(&MILLIONS, "hierarchical", "combine-last"), Pick::Most),
        "single_map_slowdown" => Asked::Times(preset("varying-single", LARGEST), preset("combine-all", LARGEST)),
        "speedup_of_map_creation" => Asked::Times(draw(COPY_2006, LARGEST), preset("combine-all", LARGEST)),
        "speedup_by_hierarchy" => Asked::Times(preset("fetch", LARGEST), preset("combine-all", LARGEST)),
        "fewer_points" => Asked::Fewer(dragon()?),
        "dragon_points" => Asked::Points(dragon()?),
        _ => return Err("not run here yet".to_owned()),
    })
}

/// Its traversal with two lights.
fn dragon() -> Result<Place, String> {
    let variant = gather("combine-all").with(Subject::room("dragon")?);
    Ok(Place { variant, side: LARGEST, part: Part::Gather })
}
