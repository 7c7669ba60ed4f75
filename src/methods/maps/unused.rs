//! What is set and would do nothing, or not what it says: refused with the reason.

use super::{Axes, CULL, RASTER_FROM, SPLAT_SIZE, large, splats};
use crate::{
    passes::{PlanError, refused},
    settings::Settings,
};

/// # Errors
/// Settings that these axes have no use for.
pub fn check(settings: &Settings, axes: Axes<'_>) -> Result<(), PlanError> {
    let Axes { traverse, merge, splat, .. } = axes;
    let drawn_otherwise = ["interpolated", "elliptic"].contains(&splat);
    if settings.choice(&CULL) == "geometry" && traverse == "fetch" && drawn_otherwise {
        return refused(
            format!("maps.cull=geometry with maps.splat={splat}"),
            "the geometry shader hands on no count and no shape of a splat",
            "set maps.cull=clip",
        );
    }
    // Where none is large enough, all are summed, whatever they are.
    let from = settings.whole(&RASTER_FROM);
    if (1..=large::MOST).contains(&from) && traverse == "compute" && !large::can_draw(axes) {
        let (what, reason) = match (splat, merge) {
            ("cells", _) => ("maps.splat=cells".to_owned(), "cells are added in integers alone"),
            ("elliptic", _) => {
                ("maps.splat=elliptic".to_owned(), "ellipses are thin, and are summed whatever their size")
            }
            _ => (format!("maps.merge={merge}"), "clusters of fixed splats are summed whatever their size"),
        };
        return refused(
            format!("maps.raster_from={from} with {what}"),
            reason,
            "do not set maps.raster_from, or set maps.splat=varying",
        );
    }
    let most = splats::most_interpolated();
    if splat == "interpolated" && settings.whole(&SPLAT_SIZE) > most {
        return refused(
            format!("maps.splat_size={} with maps.splat=interpolated", settings.whole(&SPLAT_SIZE)),
            format!(
                "the widest of its four sizes is 8 times as wide, and no splat is wider than {} texels",
                large::MOST
            ),
            &format!("set maps.splat_size={most} or less"),
        );
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Scene;

    #[test]
    fn what_would_do_nothing_is_refused() {
        let scene = Scene::load("glass-sphere", &[]).unwrap();
        let of = |set: &[(&str, &str)]| {
            let mut settings = Settings::default();
            set.iter().for_each(|(key, value)| settings.set(super::super::SETTINGS, key, value).unwrap());
            Axes::checked(&settings, &scene).map(|_| ()).map_err(|error| error.to_string())
        };
        let refused: [&[(&str, &str)]; 6] = [
            &[("maps.cull", "geometry"), ("maps.traverse", "fetch"), ("maps.splat", "interpolated")],
            &[("maps.cull", "geometry"), ("maps.traverse", "fetch"), ("maps.splat", "elliptic")],
            &[("maps.raster_from", "8"), ("maps.merge", "exact")],
            &[("maps.raster_from", "8"), ("maps.splat", "elliptic")],
            &[("maps.raster_from", "8"), ("maps.gather", "cells")],
            &[("maps.splat_size", "32"), ("maps.traverse", "fetch"), ("maps.splat", "interpolated")],
        ];
        for set in refused {
            let text = of(set).unwrap_err();
            assert!(text.contains(&format!("{}={}", set[0].0, set[0].1)), "{text}");
        }
        let taken: [&[(&str, &str)]; 5] = [
            &[("maps.cull", "geometry"), ("maps.gather", "fetch")],
            &[("maps.raster_from", "256"), ("maps.gather", "elliptic")],
            &[("maps.raster_from", "8"), ("maps.splat", "varying"), ("maps.merge", "all")],
            &[("maps.raster_from", "8")],
            &[("maps.splat_size", "31"), ("maps.traverse", "fetch"), ("maps.splat", "interpolated")],
        ];
        for set in taken {
            assert_eq!(of(set), Ok(()), "{set:?}");
        }
    }
}
