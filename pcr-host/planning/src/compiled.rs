//! What is large, compiled once for each number format.
//!
//! A generic function is compiled again in every crate that calls it. The functions here are not generic: every format has its own,
//! which calls the generic one. The public functions call these.

use crate::bodies::Bodies;
use crate::certify::Proof;
use crate::check::Verdict;
use crate::fleet::{Fleet, Format, Refused, rounding};
use crate::regions::{Failure, Region, Sheet, Told, tables};
use crate::rows::Grid;
use pcr_certify::data::Table;
use pcr_core::Motion;
#[cfg(feature = "micromath")]
use pcr_core::scalar::Micro;
use pcr_fixed::{Q12, Q16, Q20};
use pcr_formats::scenario::Scenario;

/// The functions of a number format.
pub trait Compiled: Sized {
    /// [`Fleet::new`].
    fn fleet(scenario: &Scenario) -> Result<Fleet<Self>, Refused>
    where
        Self: Format;
    /// [`Bodies::new`].
    fn bodies(scenario: &Scenario) -> Result<Bodies<Self>, Refused>
    where
        Self: Format;
    /// [`rounded`](crate::fleet::rounded).
    fn rounded(scenario: &Scenario) -> Result<Option<String>, Refused>;
    /// The regions of one agent of a sheet.
    fn regions(
        sheet: &Sheet<'_, Self>,
        motions: &[Motion<'_, Self>],
        grid: &Grid,
        ego: usize,
    ) -> Result<Vec<Region>, Failure>
    where
        Self: Format;
    /// [`Verdict::watched`].
    fn verdict(scenario: &Scenario, closest: bool, told: Told<'_>) -> Result<Verdict, Failure>;
    /// [`Verdict::any`].
    fn any(scenario: &Scenario, told: Told<'_>) -> Result<bool, Failure>;
    /// [`Proof::of`].
    fn proof(scenario: &Scenario) -> Result<Proof, Refused>;
    /// [`table_of`](crate::regions::table_of).
    fn certificate(scenario: &Scenario) -> Result<Vec<Table>, Failure>;
}

macro_rules! compiled {
    ($($(#[$attribute:meta])* $format:ty),+) => {
        $($(#[$attribute])*
        impl Compiled for $format {
            fn fleet(scenario: &Scenario) -> Result<Fleet<Self>, Refused> {
                Fleet::generic(scenario)
            }
            fn bodies(scenario: &Scenario) -> Result<Bodies<Self>, Refused> {
                Bodies::generic(scenario)
            }
            fn rounded(scenario: &Scenario) -> Result<Option<String>, Refused> {
                rounding::generic::<Self>(scenario)
            }
            fn regions(
                sheet: &Sheet<'_, Self>,
                motions: &[Motion<'_, Self>],
                grid: &Grid,
                ego: usize,
            ) -> Result<Vec<Region>, Failure> {
                sheet.regions(motions, grid, ego)
            }
            fn verdict(scenario: &Scenario, closest: bool, told: Told<'_>) -> Result<Verdict, Failure> {
                Verdict::generic::<Self>(scenario, closest, told)
            }
            fn any(scenario: &Scenario, told: Told<'_>) -> Result<bool, Failure> {
                Verdict::any_generic::<Self>(scenario, told)
            }
            fn proof(scenario: &Scenario) -> Result<Proof, Refused> {
                Proof::generic::<Self>(scenario)
            }
            fn certificate(scenario: &Scenario) -> Result<Vec<Table>, Failure> {
                tables::generic::<Self>(scenario)
            }
        })+
    };
}

compiled!(
    f64,
    f32,
    #[cfg(feature = "micromath")]
    Micro,
    Q12,
    Q16,
    Q20
);
