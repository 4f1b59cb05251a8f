//! Colours of the agents.
//!
//! The first twelve were found by a random search that maximizes the smallest distance in OKLab, for normal vision and,
//! at half the weight, for each of the three dichromacies (Machado, Oliveira and Fernandes 2009), at a relative
//! luminance below 0.45 so that thin lines are visible on white. From the thirteenth colour on, hues advance by the
//! golden angle, in three lightnesses. No colour repeats below 100 agents, but beyond a dozen or so the eye cannot
//! distinguish them; labels are for that.

use std::fmt;

/// A colour of the sRGB space.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct Colour(pub(super) [u8; 3]);

/// How many colours can be told apart by eye.
pub(super) const DISTINCT: usize = 12;

const FIRST: [Colour; DISTINCT] = [
    Colour([0x20, 0x78, 0xbf]),
    Colour([0xf2, 0x97, 0x5a]),
    Colour([0x65, 0x00, 0x11]),
    Colour([0x1c, 0xc0, 0xbb]),
    Colour([0x77, 0x1d, 0x99]),
    Colour([0x88, 0x8a, 0x03]),
    Colour([0xfa, 0x07, 0x80]),
    Colour([0x05, 0x39, 0x5e]),
    Colour([0xae, 0x93, 0xf8]),
    Colour([0xa9, 0x40, 0x22]),
    Colour([0xd2, 0x19, 0xfc]),
    Colour([0x19, 0x1a, 0xdb]),
];

/// Turn from one hue to the next after the first twelve: no two of many fall together.
const GOLDEN_ANGLE: f64 = 2.399_963_229_728_653;

/// Lightness and chroma (OKLab) of the colours after the first twelve, in turn.
const SHADES: [(f64, f64); 3] = [(0.45, 0.13), (0.62, 0.14), (0.71, 0.12)];

/// Luminance up to which a text is legible on white: contrast 5.5.
const INK_LUMINANCE: f64 = 1.05 / 5.5 - 0.05;

/// The colour of the agent at this place of a scenario.
pub(crate) fn colour(place: usize) -> Colour {
    FIRST.get(place).copied().unwrap_or_else(|| {
        let number = place - FIRST.len();
        let (lightness, chroma) = SHADES[number % SHADES.len()];
        let (sin, cos) = (number as f64 * GOLDEN_ANGLE).sin_cos();
        Colour::from_oklab([lightness, chroma * cos, chroma * sin])
    })
}

impl Colour {
    /// The colour, darkened as far as a text on white needs it.
    pub(super) fn ink(self) -> Self {
        let luminance = self.luminance();
        if luminance <= INK_LUMINANCE {
            return self;
        }
        Self::from_linear(self.linear().map(|value| value * INK_LUMINANCE / luminance))
    }

    /// Relative luminance of WCAG, 0 to 1.
    fn luminance(self) -> f64 {
        let [r, g, b] = self.linear();
        0.2126 * r + 0.7152 * g + 0.0722 * b
    }

    fn linear(self) -> [f64; 3] {
        self.0.map(|value| {
            let value = f64::from(value) / 255.0;
            if value <= 0.04045 { value / 12.92 } else { ((value + 0.055) / 1.055).powf(2.4) }
        })
    }

    fn from_linear(linear: [f64; 3]) -> Self {
        Self(linear.map(|value| {
            let value = value.clamp(0.0, 1.0);
            let value = if value <= 0.003_130_8 { 12.92 * value } else { 1.055 * value.powf(1.0 / 2.4) - 0.055 };
            (255.0 * value).round() as u8
        }))
    }

    /// Björn Ottosson's OKLab (2020), inverse.
    fn from_oklab([lightness, a, b]: [f64; 3]) -> Self {
        let cubed = |value: f64| value * value * value;
        let l = cubed(lightness + 0.396_337_777_4 * a + 0.215_803_757_3 * b);
        let m = cubed(lightness - 0.105_561_345_8 * a - 0.063_854_172_8 * b);
        let s = cubed(lightness - 0.089_484_177_5 * a - 1.291_485_548_0 * b);
        Self::from_linear([
            4.076_741_662_1 * l - 3.307_711_591_3 * m + 0.230_969_929_2 * s,
            -1.268_438_004_6 * l + 2.609_757_401_1 * m - 0.341_319_396_5 * s,
            -0.004_196_086_3 * l - 0.703_418_614_7 * m + 1.707_614_701_0 * s,
        ])
    }
}

impl fmt::Display for Colour {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [r, g, b] = self.0;
        write!(f, "#{r:02x}{g:02x}{b:02x}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashSet;

    /// Smallest distance (OKLab) of two of the first twelve colours for any eye: about five times what is noticed.
    const DISTINCT: f64 = 0.095;

    type Matrix = [[f64; 3]; 3];

    /// Machado, Oliveira and Fernandes 2009, severity 1, on linear values.
    const EYES: [Matrix; 4] = [
        [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        [[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216], [-0.003882, -0.048116, 1.051998]],
        [[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.011820, 0.042940, 0.968881]],
        [[1.255528, -0.076749, -0.178779], [-0.078411, 0.930809, 0.147602], [0.004733, 0.691367, 0.303900]],
    ];

    fn apply(matrix: Matrix, vector: [f64; 3]) -> [f64; 3] {
        matrix.map(|row| row.iter().zip(vector).map(|(a, b)| a * b).sum())
    }

    fn oklab(linear: [f64; 3]) -> [f64; 3] {
        let lms = apply(
            [
                [0.4122214708, 0.5363325363, 0.0514459929],
                [0.2119034982, 0.6806995451, 0.1073969566],
                [0.0883024619, 0.2817188376, 0.6299787005],
            ],
            linear,
        );
        apply(
            [
                [0.2104542553, 0.7936177850, -0.0040720468],
                [1.9779984951, -2.4285922050, 0.4505937099],
                [0.0259040371, 0.7827717662, -0.8086757660],
            ],
            lms.map(f64::cbrt),
        )
    }

    #[test]
    fn the_first_twelve_colours_differ_for_every_eye() {
        for eye in EYES {
            let seen: Vec<_> = FIRST
                .iter()
                .map(|colour| oklab(apply(eye, colour.linear()).map(|value| value.clamp(0.0, 1.0))))
                .collect();
            for (k, a) in seen.iter().enumerate() {
                for b in &seen[..k] {
                    let distance = a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt();
                    assert!(distance > DISTINCT, "{a:?} {b:?} {distance}");
                }
            }
        }
    }

    #[test]
    fn a_hundred_colours_are_a_hundred() {
        let colours: HashSet<_> = (0..100).map(colour).collect();
        assert_eq!(colours.len(), 100);
    }

    #[test]
    fn lines_and_texts_stand_out_on_white() {
        for place in 0..1000 {
            let colour = colour(place);
            assert!(colour.luminance() < 0.45, "{colour}");
            // The last bit of a channel.
            assert!(colour.ink().luminance() < INK_LUMINANCE + 0.01, "{colour}");
        }
    }
}
