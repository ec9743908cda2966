//! The fit in words.

use super::{Band, Bands, Girth};

/// Growth of a girth, as a share of the cloth as cut, above which it is said.
const DRAWN_OUT: f64 = 0.02;

/// Remarks on the girths, the hardest pressed first.
pub(super) fn remarks(girths: &[Girth], bands: &Bands) -> Vec<String> {
    let mut tight: Vec<&Girth> = girths.iter().filter(|g| g.band.is_some_and(|band| band != Band::Ok)).collect();
    tight.sort_by(|a, b| max(b).total_cmp(&max(a)));
    let mut out: Vec<String> = tight.into_iter().map(pressed).collect();
    if out.is_empty() && girths.iter().any(|girth| girth.pressure.is_some()) {
        out.push(format!("no girth is tight: cloth presses with less than {} kPa at each", bands.tight));
    }
    let drawn = girths.iter().filter(|girth| girth.flat > 0.0 && girth.garment > (1.0 + DRAWN_OUT) * girth.flat);
    out.extend(drawn.map(|girth| {
        let percent = 100.0 * (girth.garment / girth.flat - 1.0);
        format!(
            "drawn out by {percent:.0} % at the {}: cut {:.0} mm, worn {:.0} mm",
            girth.name, girth.flat, girth.garment
        )
    }));
    if let Some(loose) = loosest(girths) {
        out.push(format!("loosest at the {}, with {:.0} mm of ease", loose.name, loose.ease));
    }
    out
}

/// Largest pressure, kPa.
fn max(girth: &Girth) -> f64 {
    girth.pressure.map_or(0.0, |pressure| pressure.max)
}

fn pressed(girth: &Girth) -> String {
    let band = girth.band.map_or("", Band::name);
    let side = girth.side.as_ref().filter(|side| !side.is_empty()).map(|side| format!(" ({side})"));
    let (name, side) = (&girth.name, side.unwrap_or_default());
    format!("{band} at the {name}{side}, {:.1} kPa, cloth at {:.0} % of its limit", max(girth), 100.0 * girth.cloth)
}

/// The girth that is pressed hardest, or where none is pressed the one with the least ease for its size.
pub(in crate::report) fn tightest(girths: &[Girth]) -> Option<&Girth> {
    // As it is shown: a thousandth of a kilopascal is no pressure.
    let shown = |girth: &Girth| (10.0 * max(girth)).round();
    girths.iter().max_by(|a, b| shown(a).total_cmp(&shown(b)).then(share(b).total_cmp(&share(a))))
}

/// The girth with the most ease for its size.
pub(in crate::report) fn loosest(girths: &[Girth]) -> Option<&Girth> {
    girths.iter().filter(|girth| girth.ease > 0.0).max_by(|a, b| share(a).total_cmp(&share(b)))
}

/// Ease as a share of the body's girth.
fn share(girth: &Girth) -> f64 {
    girth.ease / girth.body.max(f64::MIN_POSITIVE)
}

#[cfg(test)]
mod tests {
    use super::super::Pressure;
    use super::*;

    fn girth(name: &str, ease: f64, max: f64) -> Girth {
        let pressure = Some(Pressure { mean: 0.5 * max, max });
        let (body, garment) = (1000.0, 1000.0 + ease);
        let band = Some(Bands::default().of(max));
        Girth { name: name.into(), body, garment, flat: garment, ease, pressure, band, cloth: 0.8, ..Girth::default() }
    }

    #[test]
    fn what_is_tight_comes_first_with_its_figures() {
        let bust = Girth { side: Some("left front".into()), ..girth("bust", 2.0, 3.11) };
        let girths = [bust, girth("waist", 180.0, 0.2), girth("hip", 1.0, 5.0)];
        let said = remarks(&girths, &Bands::default());
        assert_eq!(
            said,
            [
                "too tight at the hip, 5.0 kPa, cloth at 80 % of its limit",
                "tight at the bust (left front), 3.1 kPa, cloth at 80 % of its limit",
                "loosest at the waist, with 180 mm of ease"
            ]
        );
        let tightest = |girths: &[Girth]| tightest(girths).map(|g| g.name.clone());
        assert_eq!(tightest(&girths).as_deref(), Some("hip"));
        let loose = [girth("bust", 120.0, 0.004), girth("waist", 90.0, 0.0)];
        assert_eq!(tightest(&loose).as_deref(), Some("waist"));
    }

    #[test]
    fn a_loose_garment_is_said_to_be_so_and_a_stretched_one_too() {
        let band = Girth { flat: 900.0, ..girth("waist", 2.0, 1.0) };
        let said = remarks(&[band], &Bands::default());
        assert_eq!(said[0], "no girth is tight: cloth presses with less than 2.3 kPa at each");
        assert_eq!(said[1], "drawn out by 11 % at the waist: cut 900 mm, worn 1002 mm");
    }
}
