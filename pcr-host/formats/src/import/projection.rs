//! Longitudes and latitudes to metres of a plane, as the building tools of Open-RMF compute them with PROJ.
//!
//! Transverse Mercator by the series of Krüger to the sixth power of the third flattening (Karney, *Transverse Mercator with an
//! accuracy of a few nanometers*, 2011, equations 7 to 11 and 35). Within [`FARTHEST`] of the central meridian the series leaves less
//! than 5 nm, and a coordinate of 1e7 m is rounded to some nanometres: the sum is less than [`ERROR`]. The ellipsoids of WGS 84 and of
//! GRS 80 count as the same datum, which is what PROJ does if nothing else is asked for.

use std::fmt;

/// Bound on the error of a coordinate \[m\].
#[cfg(test)]
const ERROR: f64 = 2e-8;

/// Largest angle to the central meridian \[degrees\]: a building that is farther is in another zone than its file says.
const FARTHEST: f64 = 15.0;

/// Largest latitude \[degrees\].
const POLAR: f64 = 85.0;

/// Equatorial radius of both ellipsoids \[m\], and their flattenings.
const RADIUS: f64 = 6_378_137.0;
const WGS_84: f64 = 1.0 / 298.257_223_563;
const GRS_80: f64 = 1.0 / 298.257_222_101;

/// Names of the systems that are known, for messages.
const KNOWN: &str = "EPSG:326xx and 327xx (UTM), 258xx (ETRS89), 3414 (SVY21), 2193 (NZTM2000) and 3857 (web Mercator)";

/// A projection with the order of its axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Projection {
    plane: Plane,
    /// Whether its northing is the first of its axes, which is what Open-RMF expects of all systems.
    northing_first: bool,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Plane {
    TransverseMercator(TransverseMercator),
    /// Pseudo-Mercator of the web: a sphere.
    WebMercator,
}

/// A transverse Mercator projection: its constants.
#[derive(Clone, Copy, Debug, PartialEq)]
struct TransverseMercator {
    /// Longitude of the central meridian \[degrees\].
    meridian: f64,
    eccentricity: f64,
    /// Scale on the meridian times the rectifying radius \[m\].
    radius: f64,
    coefficients: [f64; 6],
    /// Added to easting and northing \[m\].
    shift: [f64; 2],
}

impl TransverseMercator {
    /// From the flattening, the origin (longitude and latitude, degrees), the scale there, and the easting and northing of the origin.
    fn new(flattening: f64, [meridian, latitude]: [f64; 2], scale: f64, [easting, northing]: [f64; 2]) -> Self {
        let n = flattening / (2.0 - flattening);
        let series = |terms: &[f64]| terms.iter().rev().fold(0.0, |sum, term| (sum + term) * n);
        let coefficients = [
            series(&[1.0 / 2.0, -2.0 / 3.0, 5.0 / 16.0, 41.0 / 180.0, -127.0 / 288.0, 7891.0 / 37800.0]),
            n * series(&[13.0 / 48.0, -3.0 / 5.0, 557.0 / 1440.0, 281.0 / 630.0, -1_983_433.0 / 1_935_360.0]),
            n * n * series(&[61.0 / 240.0, -103.0 / 140.0, 15061.0 / 26880.0, 167_603.0 / 181_440.0]),
            n.powi(3) * series(&[49561.0 / 161_280.0, -179.0 / 168.0, 6_601_661.0 / 7_257_600.0]),
            n.powi(4) * series(&[34729.0 / 80640.0, -3_418_889.0 / 1_995_840.0]),
            n.powi(5) * series(&[212_378_941.0 / 319_334_400.0]),
        ];
        let squares = n * n;
        let mean = 1.0 + squares / 4.0 + squares * squares / 64.0 + squares * squares * squares / 256.0;
        let shifted = Self {
            meridian,
            eccentricity: (flattening * (2.0 - flattening)).sqrt(),
            radius: scale * RADIUS / (1.0 + n) * mean,
            coefficients,
            shift: [0.0; 2],
        };
        let [_, origin] = shifted.project([meridian, latitude]);
        Self { shift: [easting, northing - origin], ..shifted }
    }

    /// Easting and northing.
    fn project(&self, [longitude, latitude]: [f64; 2]) -> [f64; 2] {
        let (sin, cos) = (longitude - self.meridian).to_radians().sin_cos();
        let tangent = latitude.to_radians().tan();
        let secant = tangent.hypot(1.0);
        let sigma = (self.eccentricity * (self.eccentricity * tangent / secant).atanh()).sinh();
        let conformal = tangent * sigma.hypot(1.0) - sigma * secant;
        let (xi, eta) = (conformal.atan2(cos), (sin / conformal.hypot(cos)).asinh());
        let [mut north, mut east] = [xi, eta];
        for (coefficient, multiple) in self.coefficients.iter().zip([2.0, 4.0, 6.0, 8.0, 10.0, 12.0]) {
            let (sin, cos) = (multiple * xi).sin_cos();
            north += coefficient * sin * (multiple * eta).cosh();
            east += coefficient * cos * (multiple * eta).sinh();
        }
        [self.radius * east + self.shift[0], self.radius * north + self.shift[1]]
    }
}

/// Why a projection is not known, or does not reach a point.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum ProjectionError {
    /// The one of this name is not read.
    Unknown(String),
    /// A longitude and a latitude are out of range \[degrees\].
    OutOfRange([f64; 2]),
}

impl fmt::Display for ProjectionError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unknown(name) => write!(f, "{name} is not read; {KNOWN} are"),
            Self::OutOfRange([longitude, latitude]) => write!(
                f,
                "longitude {longitude}, latitude {latitude}: out of range of the projection of its building, in degrees"
            ),
        }
    }
}

impl Projection {
    /// The one of a name such as `EPSG:3414`.
    ///
    /// # Errors
    /// [`ProjectionError::Unknown`].
    pub(super) fn named(name: &str) -> Result<Self, ProjectionError> {
        let unknown = || ProjectionError::Unknown(name.to_owned());
        let code = name.trim().to_ascii_uppercase();
        let code: u32 = code.strip_prefix("EPSG:").and_then(|code| code.parse().ok()).ok_or_else(unknown)?;
        let zone = |first: u32| 6.0 * f64::from(code - first) - 183.0;
        let utm = |flattening, meridian, northing| {
            TransverseMercator::new(flattening, [meridian, 0.0], 0.9996, [5e5, northing])
        };
        let (series, northing_first) = match code {
            3857 => return Ok(Self { plane: Plane::WebMercator, northing_first: false }),
            32601..=32660 => (utm(WGS_84, zone(32600), 0.0), false),
            32701..=32760 => (utm(WGS_84, zone(32700), 1e7), false),
            25828..=25838 => (utm(GRS_80, zone(25800), 0.0), false),
            3414 => {
                // 103° 50' and 1° 22', with the digits of the database that PROJ uses.
                let origin = [103.833333333333, 1.36666666666667];
                (TransverseMercator::new(WGS_84, origin, 1.0, [28_001.642, 38_744.572]), true)
            }
            2193 => (TransverseMercator::new(GRS_80, [173.0, 0.0], 0.9996, [1.6e6, 1e7]), true),
            _ => return Err(unknown()),
        };
        Ok(Self { plane: Plane::TransverseMercator(series), northing_first })
    }

    /// Whether Open-RMF takes easting and northing one for the other, which mirrors the plane.
    pub(super) fn is_mirrored(&self) -> bool {
        !self.northing_first
    }

    /// The point of a longitude and a latitude \[degrees\] in the coordinates of Open-RMF \[m\].
    ///
    /// # Errors
    /// [`ProjectionError::OutOfRange`].
    pub(super) fn apply(&self, at: [f64; 2]) -> Result<[f64; 2], ProjectionError> {
        let [longitude, latitude] = at;
        let is_near = match &self.plane {
            Plane::WebMercator => true,
            Plane::TransverseMercator(series) => (longitude - series.meridian).abs() <= FARTHEST,
        };
        if !(-180.0..=180.0).contains(&longitude) || !(-POLAR..=POLAR).contains(&latitude) || !is_near {
            return Err(ProjectionError::OutOfRange(at));
        }
        let [easting, northing] = match &self.plane {
            Plane::TransverseMercator(series) => series.project(at),
            Plane::WebMercator => [RADIUS * longitude.to_radians(), RADIUS * latitude.to_radians().tan().asinh()],
        };
        Ok(if self.northing_first { [easting, northing] } else { [northing, easting] })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Results of pyproj 3.7 (PROJ 9), in the order of the axes of each system: first, second.
    #[test]
    fn coordinates_are_those_of_proj() {
        for (name, [longitude, latitude], [first, second]) in [
            ("EPSG:3414", [103.8198, 1.3521], [37133.868476454, 26495.534871029]),
            ("EPSG:3414", [103.9893, 1.3644], [38494.498067136, 45358.903854165]),
            ("EPSG:3414", [103.6, 1.2], [20316.540481286, 2032.680470951]),
            ("EPSG:32632", [8.5417, 47.3769], [465403.284465977, 5247150.839424513]),
            ("EPSG:32632", [11.58, 48.137], [691939.274499559, 5334746.800265323]),
            ("EPSG:32632", [6.0, 50.0], [285015.763265174, 5542944.018649102]),
            ("epsg:32632", [15.0, 60.0], [834359.667892285, 6666593.572146888]),
            ("EPSG:32756", [151.2093, -33.8688], [334368.633648097, 6250948.345385009]),
            ("EPSG:25833", [13.405, 52.52], [391779.259251629, 5820072.159087078]),
            ("EPSG:32648", [111.0, 80.0], [616114.651337263, 8887579.00772009]),
            ("EPSG:2193", [174.7633, -36.8485], [5920482.808890771, 1757209.253477841]),
            ("EPSG:3857", [103.8198, 1.3521], [11557167.270259503, 150529.055598964]),
            ("EPSG:3857", [8.5417, 47.3769], [950857.694508905, 6003812.204877847]),
        ] {
            let projection = Projection::named(name).unwrap();
            let [x, y] = projection.apply([longitude, latitude]).unwrap();
            // The first axis is the y of Open-RMF, whatever it is.
            assert!((y - first).abs() < ERROR && (x - second).abs() < ERROR, "{name}: {y:.9} {x:.9}");
            assert_eq!(projection.is_mirrored(), !["EPSG:3414", "EPSG:2193"].contains(&name));
        }
    }

    /// A meridian arc of the ellipsoid by its integral, and the scale on the meridian.
    #[test]
    fn northings_on_the_meridian_are_its_arcs() {
        let e2 = WGS_84 * (2.0 - WGS_84);
        for degrees in [10.0_f64, 47.0, 80.0] {
            let steps = 20_000;
            let step = degrees.to_radians() / f64::from(steps);
            let curvature = |latitude: f64| RADIUS * (1.0 - e2) / (1.0 - e2 * latitude.sin().powi(2)).powf(1.5);
            let simpson = |k: i32| {
                let at = f64::from(k) * step;
                (curvature(at) + 4.0 * curvature(at + 0.5 * step) + curvature(at + step)) * step / 6.0
            };
            let arc: f64 = (0..steps).map(simpson).sum();
            let [northing, easting] = Projection::named("EPSG:32632").unwrap().apply([9.0, degrees]).unwrap();
            assert!((northing - 0.9996 * arc).abs() < 1e-7 && (easting - 5e5).abs() < ERROR, "{degrees}: {northing}");
        }
    }

    #[test]
    fn what_is_out_of_range_is_refused() {
        for name in ["EPSG:4326", "EPSG:32600", "EPSG:32661", "3414", "EPSG:x", ""] {
            let unknown = Projection::named(name).unwrap_err().to_string();
            assert!(unknown.contains("is not read; EPSG:326xx"), "{name}");
        }
        let singapore = Projection::named("EPSG:3414").unwrap();
        for at in [[8.5, 47.0], [103.8, 91.0], [f64::NAN, 1.0], [119.0, 1.0], [103.8, -86.0]] {
            assert!(matches!(singapore.apply(at), Err(ProjectionError::OutOfRange(_))), "{at:?}");
        }
    }
}
