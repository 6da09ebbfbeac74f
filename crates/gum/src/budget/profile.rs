//! Profiles: the conventions on which guides differ.

use super::conventions::{
    Confirmation, Conventions, CoverageRule, DofRule, OutputShape, StatementForm, TScale,
};
use gumption_core::quantity::Rounding;

/// A named set of conventions.
#[derive(Debug, Clone, Copy)]
#[non_exhaustive]
pub struct Profile {
    /// As the file names it.
    pub name: &'static str,
    /// What it changes in the conventions of the GUM, which are the default.
    changes: fn(&mut Conventions),
    /// What it is, in English.
    pub en: &'static str,
    /// What it is, in Chinese.
    pub zh: &'static str,
    /// The guide it follows.
    pub source: &'static str,
    /// What a certificate says of how the uncertainty was evaluated and is reported, in English.
    pub certified_en: &'static str,
    /// The same in Chinese.
    pub certified_zh: &'static str,
}

impl Profile {
    /// The conventions without overrides; two significant digits.
    pub fn conventions(&self) -> Conventions {
        // Those of the GUM, from which the profiles are told by what they change.
        let mut conventions = Conventions {
            profile: self.name.into(),
            overrides: Vec::new(),
            coverage_probability: 0.95,
            coverage_factor: CoverageRule::Output,
            confirmation: Confirmation::Interval,
            output_probability: 0.95,
            output_shape: OutputShape::Convolution,
            degrees_of_freedom: DofRule::Truncated,
            rounding: Rounding::HalfEven,
            digits: 2,
            up_if_lowered_by_5_percent: false,
            t_scale: TScale::Scale,
            state_probability: true,
            statement: StatementForm::PlusMinus,
        };
        (self.changes)(&mut conventions);
        conventions
    }
}

/// The known profiles; the first is the default.
pub const PROFILES: &[Profile] = &[
    Profile {
        name: "GUM",
        changes: |_| {},
        en: "Coverage probability 95 %; k from the t distribution at the effective degrees of freedom, or from the \
             output distribution when a non-normal component dominates; two digits, rounded half to even.",
        zh: "包含概率 95 %；k 由有效自由度按 t 分布确定，非正态分量占优时由输出量分布确定；不确定度取两位有效数字，四舍六入五成双。",
        source: "JCGM 100:2008, 7.2 and annex G; JCGM 101:2008",
        certified_en: "The uncertainty was evaluated and is stated in accordance with JCGM 100:2008 (GUM).",
        certified_zh: "不确定度按 JCGM 100:2008（GUM）评定和表示。",
    },
    Profile {
        name: "EA",
        changes: |c| {
            c.coverage_probability = 0.9545;
            c.confirmation = Confirmation::Moments;
            // S9, S10 and S11: k from a rectangle and from trapezoids for 95 %.
            c.output_shape = OutputShape::DominantAlone;
            c.up_if_lowered_by_5_percent = true;
        },
        en: "Coverage probability 95.45 %, so k = 2 for a normal output; k from t at few effective degrees of freedom, \
             from the output distribution for 95 % when one or two rectangles dominate; two digits, the rounded-up value when rounding would lower U by more than 5 %. k·u_c \
             stands as soon as Monte Carlo confirms y and u, with u = s/√n for few readings.",
        zh: "包含概率 95.45 %，正态分布时 k = 2；有效自由度小时按 t 分布取 k，一个或两个矩形分布占优时由输出量分布取 k（包含概率 95 %）；不确定度取两位有效数字，修约使 U 减小超过 5 % 时进位。只要蒙特卡洛法证实 y 和 u（少量重复测量取 u = s/√n），即采用 k·u_c。",
        source: "EA-4/02 M:2022, 6.3, appendix E, S9 to S11",
        certified_en: "The standard uncertainty was evaluated in accordance with EA-4/02 M:2022.",
        certified_zh: "标准不确定度按 EA-4/02 M:2022 评定。",
    },
    Profile {
        name: "JJF",
        changes: |c| {
            c.coverage_factor = CoverageRule::Fixed(2.0);
            c.state_probability = false;
            c.statement = StatementForm::Apart;
        },
        en: "k = 2, stated without a probability; two digits, rounded half to even (GB/T 8170).",
        zh: "取 k = 2，不注明包含概率；不确定度取两位有效数字，按 GB/T 8170 修约。",
        source: "JJF 1059.1-2012, 5.3.8; GB/T 8170-2008",
        certified_en: "The uncertainty was evaluated and is expressed in accordance with JJF 1059.1-2012.",
        certified_zh: "不确定度按 JJF 1059.1-2012《测量不确定度评定与表示》评定和表示。",
    },
    Profile {
        name: "JJF-up",
        changes: |c| {
            c.coverage_factor = CoverageRule::Fixed(2.0);
            c.rounding = Rounding::Up;
            c.state_probability = false;
            c.statement = StatementForm::Apart;
        },
        en: "As JJF, but digits beyond the last kept one are always carried up.",
        zh: "同 JJF，但末位以后的数字一律进位（只进不舍）。",
        source: "JJF 1059.1-2012, 5.3.8.2; as printed in JJF 2003-2022, annex A",
        certified_en: "The uncertainty was evaluated and is expressed in accordance with JJF 1059.1-2012, digits of the reported uncertainty in excess being carried up.",
        certified_zh: "不确定度按 JJF 1059.1-2012《测量不确定度评定与表示》评定和表示，所报告的不确定度末位以后的数字一律进位。",
    },
    Profile {
        name: "ILAC",
        changes: |c| c.confirmation = Confirmation::Moments,
        en: "As GUM: coverage probability about 95 %, y ± U with k beside it, two digits of U; reported as accredited laboratories do. k·u_c \
             stands as soon as Monte Carlo confirms y and u, with u = s/√n for few readings.",
        zh: "同 GUM：包含概率约 95 %，报告 y ± U 及 k，U 取两位有效数字；按认可实验室的要求报告。只要蒙特卡洛法证实 y 和 u（少量重复测量取 u = s/√n），即采用 k·u_c。",
        source: "ILAC-P14:09/2020, clause 5; JCGM 100:2008",
        certified_en: "The uncertainty was evaluated in accordance with JCGM 100:2008 and is reported as ILAC-P14:09/2020 requires.",
        certified_zh: "不确定度按 JCGM 100:2008 评定，按 ILAC-P14:09/2020 的要求报告。",
    },
    Profile {
        name: "CNAS",
        changes: |c| {
            c.confirmation = Confirmation::Moments;
            c.statement = StatementForm::Apart;
        },
        en: "Coverage probability 95 %, stated beside U and k; k from the t distribution at the effective degrees of freedom, or from the output \
             distribution when a non-normal component dominates; two digits, rounded half to even (GB/T 8170). k·u_c stands as soon as Monte Carlo \
             confirms y and u, with u = s/√n for few readings.",
        zh: "包含概率 95 %，与 U 和 k 一并给出；k 由有效自由度按 t 分布确定，非正态分量占优时由输出量分布确定；不确定度取两位有效数字，按 GB/T 8170 修约。只要蒙特卡洛法证实 y 和 u（少量重复测量取 u = s/√n），即采用 k·u_c。",
        source: "CNAS-CL01-G003; JJF 1059.1-2012, 4.5",
        certified_en: "The uncertainty was evaluated in accordance with JJF 1059.1-2012 and is reported as CNAS-CL01-G003 requires.",
        certified_zh: "不确定度按 JJF 1059.1-2012 评定，按 CNAS-CL01-G003 的要求报告。",
    },
    Profile {
        name: "NIST",
        changes: |c| {
            c.coverage_factor = CoverageRule::Fixed(2.0);
            c.t_scale = TScale::StandardDeviation;
        },
        en: "k = 2 for a coverage probability of about 95 %; the stated u of a t-distributed input is its standard deviation.",
        zh: "取 k = 2，包含概率约 95 %；t 分布输入量给出的 u 为其标准差。",
        source: "NIST TN 1297 (1994), section 6; NIST TN 1900 (2015)",
        certified_en: "The uncertainty was evaluated and is expressed in accordance with NIST Technical Note 1297.",
        certified_zh: "不确定度按 NIST TN 1297 评定和表示。",
    },
    Profile {
        name: "UKAS",
        changes: |c| {
            c.coverage_probability = 0.9545;
            c.coverage_factor = CoverageRule::StudentT;
            c.confirmation = Confirmation::Moments;
        },
        en: "Coverage probability 95.45 %; k from the t distribution at the effective degrees of freedom, 2 when they are many. k·u_c stands as soon as \
             Monte Carlo confirms y and u, with u = s/√n for few readings.",
        zh: "包含概率 95.45 %；k 由有效自由度按 t 分布确定，自由度大时为 2。只要蒙特卡洛法证实 y 和 u（少量重复测量取 u = s/√n），即采用 k·u_c。",
        source: "UKAS M3003, edition 4 (2019), appendix B",
        certified_en: "The uncertainty was evaluated in accordance with UKAS M3003.",
        certified_zh: "不确定度按 UKAS M3003 评定。",
    },
    Profile {
        name: "S1",
        changes: |c| {
            c.coverage_factor = CoverageRule::StudentT;
        },
        en: "As in the examples of JCGM 101: coverage probability 95 %; the GUM interval from the normal or t distribution whatever dominates.",
        zh: "同 JCGM 101 的算例：包含概率 95 %；GUM 区间始终按正态或 t 分布确定。",
        source: "JCGM 101:2008, clause 9",
        certified_en: "The uncertainty was evaluated in accordance with JCGM 100:2008 and JCGM 101:2008.",
        certified_zh: "不确定度按 JCGM 100:2008 和 JCGM 101:2008 评定。",
    },
];

/// The profile of this name.
pub fn profile_named(name: &str) -> Option<&'static Profile> {
    PROFILES.iter().find(|profile| profile.name == name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_default_comes_first_and_names_differ() {
        assert_eq!(PROFILES[0].name, "GUM");
        for (index, profile) in PROFILES.iter().enumerate() {
            let first = PROFILES.iter().position(|other| other.name == profile.name);
            assert_eq!(first, Some(index), "{}", profile.name);
        }
    }
}
