//! What a file says of its numbers → their [`Light`], or why that is not known.

use super::tones::{Light, Table, srgb, table};
use crate::numeric::cast::single;
use crate::scan::header;
use hayro_syntax::object::{Array, Dict, Name, Object};
use image::ImageDecoder;
use moxcms::{CicpProfile, ColorProfile, DataColorSpace, MatrixCoefficients, ToneReprCurve};
use std::fmt::Display;

/// The least light, of 1, that each half of a curve's numbers adds: gammas of 0.02 to 6.6 do.
const RISE: f32 = 0.01;
/// What `gAMA` writes for a gamma of 1.
const GAMA: f64 = 100_000.0;

/// The light of a picture file's numbers, in the order of PNG (third edition, sec. 4.3): what `cICP` says, an ICC
/// profile, `sRGB`, `gAMA`, and then Exif.
pub(super) fn of_file(bytes: &[u8], decoder: &mut dyn ImageDecoder) -> Result<Light, String> {
    let chunk = |kind| header::png_chunk(bytes, kind);
    if let Some(points) = chunk(b"cICP") {
        return cicp(points);
    }
    // a decoder of TIFF leaves out what is larger than a part of the pixels
    let profile = decoder.icc_profile().map_err(damaged)?;
    if let Some(profile) = profile.or_else(|| header::tiff_profile(bytes)) {
        return icc(&profile);
    }
    if chunk(b"sRGB").is_some() {
        return Ok(Light::alike(table(srgb)));
    }
    if let Some(&gamma) = chunk(b"gAMA").and_then(<[u8]>::first_chunk) {
        return grey(power(GAMA / f64::from(u32::from_be_bytes(gamma))));
    }
    if header::exif_is_srgb(bytes) {
        return Ok(Light::alike(table(srgb)));
    }
    Err("it has no colour profile that can be read, and does not say that it is in sRGB".to_owned())
}

/// The light of the numbers of a picture in a PDF file, by its colour space.
pub(super) fn of_pdf(picture: &Dict<'_>) -> Result<Light, String> {
    let space = picture.get::<Array<'_>>("ColorSpace");
    let mut space = space.iter().flat_map(Array::iter::<Object<'_>>);
    let name = space.next().and_then(Object::into_name);
    match (name.as_ref().map(Name::as_str), space.next()) {
        (Some("ICCBased"), Some(Object::Stream(profile))) => icc(&profile
            .decoded()
            .map_err(|_| damaged("it cannot be unpacked"))?),
        (Some("CalGray"), Some(Object::Dict(d))) => {
            grey(power(d.get::<f64>("Gamma").unwrap_or(1.0)))
        }
        (Some("CalRGB"), Some(Object::Dict(d))) => {
            let gamma = d.get::<[f64; 3]>("Gamma").unwrap_or([1.0; 3]);
            let unit = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
            let xyz = d.get::<[f64; 9]>("Matrix").unwrap_or(unit);
            rgb(gamma.map(power), [xyz[1], xyz[4], xyz[7]])
        }
        _ => Err("its scan's colour space says nothing of light".to_owned()),
    }
}

fn damaged(why: impl Display) -> String {
    format!("its colour profile is damaged ({why})")
}

/// ITU-T H.273's code points of primaries, curve and matrix, and whether numbers use the full range.
fn cicp(points: &[u8]) -> Result<Light, String> {
    let &[primaries, curve, 0, 1] = points else {
        return Err("its cICP is not for red, green and blue of the full range".to_owned());
    };
    let profile = ColorProfile::new_from_cicp(CicpProfile {
        color_primaries: primaries.try_into().map_err(damaged)?,
        transfer_characteristics: curve.try_into().map_err(damaged)?,
        matrix_coefficients: MatrixCoefficients::Identity,
        full_range: true,
    });
    if profile.cicp.is_none() {
        return Err("its cICP names no primaries or no curve".to_owned());
    }
    of_profile(&profile)
}

/// An ICC profile's, of grey numbers or of red, green and blue ones.
pub(super) fn icc(bytes: &[u8]) -> Result<Light, String> {
    of_profile(&ColorProfile::new_from_slice(bytes).map_err(damaged)?)
}

fn of_profile(profile: &ColorProfile) -> Result<Light, String> {
    match profile.color_space {
        // its curve is lightness where the profile is connected by that (ICC.1:2022 sec. F.2)
        DataColorSpace::Gray if profile.pcs == DataColorSpace::Lab => {
            let curve = curve(profile.gray_trc.as_ref())?;
            grey(move |number| of_lightness(curve(number)))
        }
        DataColorSpace::Gray => grey(curve(profile.gray_trc.as_ref())?),
        DataColorSpace::Rgb => {
            let [red, green, blue] = [&profile.red_trc, &profile.green_trc, &profile.blue_trc]
                .map(|c| curve(c.as_ref()));
            let primaries = [
                profile.red_colorant,
                profile.green_colorant,
                profile.blue_colorant,
            ];
            rgb([red?, green?, blue?], primaries.map(|p| p.y))
        }
        _ => Err("its colour profile is neither for grey nor for red, green and blue".to_owned()),
    }
}

/// A tone curve, of numbers and light 0 to 1.
fn curve(of: Option<&ToneReprCurve>) -> Result<impl Fn(f32) -> f32 + use<>, String> {
    let curve = of.ok_or("its colour profile has no tone curves, only tables of colours")?;
    let curve = curve.make_linear_evaluator().map_err(damaged)?;
    Ok(move |number| curve.evaluate_value(number))
}

fn power(gamma: f64) -> impl Fn(f32) -> f32 {
    // what is infinite is no curve that rises
    let gamma = single(gamma);
    move |number: f32| libm::powf(number, gamma)
}

/// The luminance of a CIE lightness, both 0 to 1.
fn of_lightness(lightness: f32) -> f32 {
    /// Where the standard's line and cube meet (CIE 15:2004 sec. 8.2.1.1).
    const MEET: f32 = 0.08;
    /// The line's slope.
    const SLOPE: f32 = 9.033;
    if lightness > MEET {
        ((lightness + 0.16) / 1.16).powi(3)
    } else {
        lightness / SLOPE
    }
}

/// A curve's light, which must rise from black to white.
fn rising(curve: impl Fn(f32) -> f32) -> Result<Table, String> {
    let table = table(|number| curve(number).clamp(0.0, 1.0));
    let places = [0, table.len() / 2, table.len() - 1].map(|i| table[i]);
    let rises = places.windows(2).all(|p| p[1] - p[0] >= RISE);
    if rises && table.iter().all(|v| v.is_finite()) {
        Ok(table)
    } else {
        Err("its colour profile's tone curve does not rise from black to white".to_owned())
    }
}

/// Light of grey numbers, whose curve is that of red, green and blue where the picture has them all the same.
fn grey(curve: impl Fn(f32) -> f32) -> Result<Light, String> {
    rising(curve).map(Light::alike)
}

/// Light of red, green and blue by their curves, and the luminance of each of them.
fn rgb(curves: [impl Fn(f32) -> f32; 3], luminance: [f64; 3]) -> Result<Light, String> {
    let [red, green, blue] = curves.map(rising);
    // a scanner's own primaries may be no light that there is, and blue a little less than none
    let weights = luminance.map(|v| v.max(0.0));
    let sum: f64 = weights.iter().sum();
    if !(sum.is_finite() && sum > 0.0) {
        return Err("its colour profile's primaries give no light".to_owned());
    }
    let weights = weights.map(|v| single(v / sum));
    Ok(Light::apart([red?, green?, blue?], weights))
}
