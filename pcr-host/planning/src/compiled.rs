//! What takes long to compile, once for each number format.
//!
//! A generic function is compiled again in every crate that calls it. So the largest ones are methods of [`Format`](crate::fleet::Format)
//! that are not generic, because each format has its own; this macro writes them. The public functions call these methods.

macro_rules! compiled {
    () => {
        fn fleet(
            scenario: &pcr_formats::scenario::Scenario,
        ) -> Result<$crate::fleet::Fleet<Self>, $crate::fleet::Refused> {
            $crate::fleet::Fleet::converted(scenario)
        }
        fn bodies(
            scenario: &pcr_formats::scenario::Scenario,
        ) -> Result<$crate::bodies::Bodies<Self>, $crate::fleet::Refused> {
            $crate::bodies::Bodies::covered(scenario)
        }
        fn rounded(scenario: &pcr_formats::scenario::Scenario) -> Result<Option<String>, $crate::fleet::Refused> {
            $crate::fleet::rounding::warning::<Self>(scenario)
        }
        fn table(motions: &[pcr_core::Motion<'_, Self>]) -> Result<$crate::fleet::HostEcm<Self>, pcr_core::Full> {
            pcr_core::Ecm::grown(motions)
        }
        fn orders(motions: &[pcr_core::Motion<'_, Self>]) -> Result<$crate::fleet::HostOrders<Self>, pcr_core::Full> {
            pcr_core::Orders::grown(motions)
        }
        fn row(
            table: &mut $crate::fleet::HostEcm<Self>,
            motions: &[pcr_core::Motion<'_, Self>],
            ego: usize,
        ) -> Result<(), pcr_core::TableError> {
            table.fill_row(motions, ego)
        }
        fn regions(
            sheet: &$crate::regions::Sheet<'_, Self>,
            motions: &[pcr_core::Motion<'_, Self>],
            grid: &$crate::rows::Grid,
            ego: usize,
        ) -> Result<Vec<$crate::regions::Region>, $crate::regions::Failure> {
            sheet.regions(motions, grid, ego)
        }
        fn verdict(
            scenario: &pcr_formats::scenario::Scenario,
            closest: bool,
            told: $crate::regions::Told<'_>,
        ) -> Result<$crate::check::Verdict, $crate::regions::Failure> {
            $crate::check::Verdict::found::<Self>(scenario, closest, told)
        }
        fn has_conflict(
            scenario: &pcr_formats::scenario::Scenario,
            told: $crate::regions::Told<'_>,
        ) -> Result<bool, $crate::regions::Failure> {
            $crate::check::Verdict::has_any::<Self>(scenario, told)
        }
        fn proof(scenario: &pcr_formats::scenario::Scenario) -> Result<$crate::certify::Proof, $crate::fleet::Refused> {
            $crate::certify::Proof::checked::<Self>(scenario)
        }
        fn certificate(
            scenario: &pcr_formats::scenario::Scenario,
        ) -> Result<Vec<pcr_certify::data::Table>, $crate::regions::Failure> {
            $crate::regions::certified::<Self>(scenario)
        }
    };
}

pub(crate) use compiled;
