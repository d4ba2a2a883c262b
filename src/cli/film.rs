//! Options of `isolith render` for the light of the picture: samples, background, exposure, view transform.

use super::failure::Failure;
use crate::field::{GBuffer, HitTarget};
use crate::geometry::Lens;
use crate::render::Film;
use crate::scene::limits::EXPOSURE;
use crate::scene::{DisplaySettings, ParamField as _, ViewTransform};
use crate::session::{DEFAULT_SAMPLES, MAX_SAMPLES};

/// These options.
#[derive(Clone, Debug, Default, clap::Args)]
pub struct FilmArguments {
    /// Samples per pixel [default: 16; 1 with --reference and views other than shaded]. Depth, normal and node id are
    /// always those at the pixel's center
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=i64::from(MAX_SAMPLES)))]
    samples: Option<u32>,
    /// Leave out the background: alpha is the share of the pixel that the scene covers
    #[arg(long)]
    transparent: bool,
    /// Exposure in stops, instead of the scene's
    #[arg(long, value_name = "STOPS", allow_negative_numbers = true, value_parser = parse_exposure)]
    exposure: Option<f64>,
    /// View transform instead of the scene's: none, agx or pbr_neutral
    #[arg(long, value_name = "NAME", value_parser = parse_view_transform)]
    view_transform: Option<ViewTransform>,
}

impl FilmArguments {
    /// Puts the options in the place of the scene's settings.
    pub fn apply(&self, display: &mut DisplaySettings) {
        display.exposure = self.exposure.unwrap_or(display.exposure);
        display.view_transform = self.view_transform.unwrap_or(display.view_transform);
    }

    /// The film. `is_single`: whether the picture is one of those that have a single sample; `is_colored`: whether it
    /// shows light.
    pub fn film(&self, is_single: bool, is_colored: bool) -> Result<Film, Failure> {
        let refuse = |option: &str, reason: &str| Err(Failure::Usage(format!("{option}: {reason}")));
        let samples = self.samples.unwrap_or(if is_single { 1 } else { DEFAULT_SAMPLES });
        if is_single && samples > 1 {
            return refuse("--samples", "the reference and views other than shaded have one sample per pixel");
        }
        if self.transparent && !is_colored {
            return refuse("--transparent", "views other than shaded have no background to leave out");
        }
        Ok(Film { samples, is_transparent: self.transparent, lens: Lens::default() })
    }
}

/// Leaves the background out of a picture of a single sample.
pub fn clear_background(buffers: &mut GBuffer) {
    for pixel in 0..buffers.depth.len() {
        if buffers.hit_target(pixel) == HitTarget::Background {
            buffers.color[pixel] = [0; 4];
            buffers.radiance[pixel] = [0.0; 4];
        }
    }
}

fn parse_exposure(text: &str) -> Result<f64, String> {
    let [least, most] = EXPOSURE.hard;
    let stops = text.parse().ok().filter(|stops| EXPOSURE.accept(*stops));
    stops.ok_or(format!("give a number of stops, {least} to {most}"))
}

fn parse_view_transform(text: &str) -> Result<ViewTransform, String> {
    let keys = ViewTransform::choices().iter().map(|choice| choice.key.as_str());
    let found = ViewTransform::ALL.into_iter().zip(keys.clone()).find(|(_, key)| *key == text);
    found.map(|(transform, _)| transform).ok_or_else(|| format!("there is {}", keys.collect::<Vec<_>>().join(", ")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn options_are_read_or_refused() {
        assert_eq!(parse_exposure("-1.5"), Ok(-1.5));
        assert_eq!(parse_view_transform("agx"), Ok(ViewTransform::Agx));
        assert!(["21", "nan", "", "bright"].iter().all(|bad| parse_exposure(bad).is_err()));
        assert!(parse_view_transform("filmic").is_err_and(|error| error.contains("none, agx, pbr_neutral")));
        let options = |samples| FilmArguments { samples, ..FilmArguments::default() };
        let samples = |samples, is_single| options(samples).film(is_single, true).ok().map(|film| film.samples);
        assert_eq!((samples(None, false), samples(None, true)), (Some(DEFAULT_SAMPLES), Some(1)));
        assert_eq!((samples(Some(3), false), samples(Some(3), true)), (Some(3), None));
    }
}
