//! A graded diagnosis as a document.

use gumption_fault::say;
use gumption_format::document::{Block, Cell, ColumnKind, Document, Table};
use gumption_format::machine::{self, Machine, Number, record};
use serde_json::Value;

use super::score::{FAINT, Finding, Graded, GradedEffect};
use crate::truth::TrueEffect;
use gumption_core::special::normal_two_sided_quantile;
use gumption_report::{Language, significant};

/// The document of a graded diagnosis.
pub fn document(graded: &Graded, language: Language) -> Document {
    Document::new(&form(graded), language, blocks(graded, language))
}

/// JSON Schema of the output of `gumption grade --json`.
pub fn grade_schema() -> Value {
    machine::schema::<GradeJson<'_>>("gumption grade --json")
}

record! {
    /// A diagnosis held against the truth of a sealed case.
    GradeJson<'a> {
        /// The scenario.
        scenario: &'a str,
        /// The verdict of the diagnosis.
        verdict: &'a str,
        /// Every concealed effect.
        effects: Vec<EffectJson>,
        /// Identified names for which there is nothing.
        wrong_names: &'a [String],
        /// Names that it is said to act like, and for which there is nothing.
        wrong_likes: &'a [String],
        /// Lists without anything that is there.
        wrong_lists: Vec<Vec<String>>,
        /// Something was found where nothing is concealed.
        false_alarm: bool,
        /// Points of the prediction: a quarter if half of what can be gained is gained.
        prediction_points: Number,
        /// All points.
        points: Number,
        /// The most that could have been reached.
        attainable: Number,
    }

    /// A concealed effect and what became of it.
    EffectJson {
        /// The truth.
        truth: TruthJson,
        /// What became of it: identified, acts-like, listed, unexplained, missed.
        finding: &'static str,
        /// Names in the list, where it is in one.
        listed: Option<usize>,
        /// A unique name was asserted although the recording cannot tell it from another.
        overclaimed: bool,
        /// Largest minus smallest of what it leaves in the residuals, as answered, in the unit of the output.
        answered_size: Option<Number>,
        /// Points.
        points: Number,
    }

    /// A concealed effect.
    TruthJson {
        /// What it is.
        physics: String,
        /// Its size: a fraction of full scale per unit of what it follows, or radians.
        size: Number,
        /// Largest minus smallest of what it leaves in the residuals of the declared model, in the unit of the output.
        in_residuals: Number,
        /// Whether a diagnosis can be expected to name it.
        nameable: bool,
        /// Visible strength λ, in standard deviations.
        lambda: Number,
        /// What is left of λ beside the other effects of the case.
        lambda_beside: Number,
        /// Separability κ: what is left after the nearest rival.
        kappa: Number,
    }
}

impl Machine for GradeJson<'_> {
    const KIND: &'static str = "grade";
    const VERSION: u32 = 3;
}

fn form(graded: &Graded) -> GradeJson<'_> {
    GradeJson {
        scenario: &graded.scenario,
        verdict: &graded.verdict,
        effects: graded.effects.iter().map(effect_form).collect(),
        wrong_names: &graded.wrong_names,
        wrong_likes: &graded.wrong_likes,
        wrong_lists: graded.wrong_lists.clone(),
        false_alarm: graded.false_alarm,
        prediction_points: Number(graded.prediction_points),
        points: Number(graded.points),
        attainable: Number(graded.attainable),
    }
}

fn effect_form(effect: &GradedEffect) -> EffectJson {
    let (finding, listed) = match effect.finding {
        Finding::Identified => ("identified", None),
        Finding::ActsLike => ("acts-like", None),
        Finding::Listed(count) => ("listed", Some(count)),
        Finding::Unexplained => ("unexplained", None),
        Finding::Missed => ("missed", None),
    };
    EffectJson {
        truth: truth_form(&effect.truth),
        finding,
        listed,
        overclaimed: effect.overclaimed,
        answered_size: effect.answered_size.map(Number),
        points: Number(effect.points),
    }
}

fn truth_form(truth: &TrueEffect) -> TruthJson {
    TruthJson {
        physics: truth.physics.clone(),
        size: Number(truth.size),
        in_residuals: Number(truth.in_residuals),
        nameable: truth.nameable,
        lambda: Number(truth.lambda),
        lambda_beside: Number(truth.lambda_beside),
        kappa: Number(truth.kappa),
    }
}

fn blocks(graded: &Graded, language: Language) -> Vec<Block> {
    let pick = |english: &str, chinese: &str| language.pick(english, chinese).to_owned();
    let mut blocks = vec![Block::Fields(vec![
        (pick("concealed", "隐藏情形"), graded.scenario.clone()),
        (
            pick("verdict of the diagnosis", "诊断结论"),
            verdict(graded, language),
        ),
    ])];
    if !graded.effects.is_empty() {
        blocks.push(Block::Table(effects(graded, language)));
    }
    let mut sentences = Vec::new();
    for name in &graded.wrong_names {
        sentences.push(say!("wrong name {name}: −1").in_language(language));
    }
    for name in &graded.wrong_likes {
        sentences
            .push(say!("said to act like {name}, which is not there: −0.5").in_language(language));
    }
    for list in &graded.wrong_lists {
        let list = list.join(" | ");
        sentences.push(say!("list without anything that is there: {list}").in_language(language));
    }
    if graded.false_alarm {
        sentences.push(pick(
            "alarm where nothing is concealed: −1",
            "无隐藏效应却报警：−1",
        ));
    }
    if graded.prediction_points > 0.0 {
        let points = graded.prediction_points;
        sentences.push(say!("prediction improved: +{points}").in_language(language));
    }
    for effect in &graded.effects {
        sentences.extend(size(effect, language));
    }
    if graded.effects.is_empty() && !graded.false_alarm {
        sentences.push(pick(
            "nothing is concealed, and nothing was found: right",
            "没有隐藏任何效应，也未报告：正确",
        ));
    }
    if !sentences.is_empty() {
        blocks.push(Block::List(sentences));
    }
    let (points, attainable) = (graded.points, graded.attainable);
    blocks.push(Block::Closing(vec![match attainable > 0.0 {
        true => say!("points: {points:.2} of {attainable:.2}").in_language(language),
        false => say!("points: {points:.2}; where nothing is concealed there are none to be won")
            .in_language(language),
    }]));
    blocks
}

/// What was said of the recording as a whole.
fn verdict(graded: &Graded, language: Language) -> String {
    match graded.verdict.as_str() {
        "agrees" | "none" => language.pick("recording and model agree", "记录与模型相符"),
        "departs" => language.pick("something is left out", "有遗漏"),
        other => other,
    }
    .to_owned()
}

fn effects(graded: &Graded, language: Language) -> Table {
    let mut table = Table::new([
        (language.pick("effect", "效应"), ColumnKind::Names),
        ("λ", ColumnKind::Numbers),
        ("κ", ColumnKind::Numbers),
        (language.pick("finding", "诊断"), ColumnKind::Wrapped),
        (language.pick("points", "得分"), ColumnKind::Numbers),
    ]);
    for effect in &graded.effects {
        table.push(vec![
            Cell::from(effect.truth.physics.clone()),
            Cell::from(format!("{:.1}", effect.truth.lambda_beside)),
            Cell::from(format!("{:.1}", effect.truth.kappa)),
            Cell::from(finding(effect, language)),
            Cell::from(format!("{:+.2}", effect.points)),
        ]);
    }
    table
}

/// The answered size beside the true one. A fit of the effect alone finds its size with the relative standard uncertainty
/// 1/λ: that is what λ is.
fn size(effect: &GradedEffect, language: Language) -> Option<String> {
    let (answered, truth) = (effect.answered_size?, &effect.truth);
    let half_width = normal_two_sided_quantile(0.95) * truth.in_residuals / truth.lambda_beside;
    let (name, right) = (&truth.physics, truth.in_residuals);
    let [answered, right] = [answered, right].map(|size| significant(size, 4));
    let half_width = significant(half_width, 2);
    Some(say!("size of {name} in the residuals: {answered} answered, {right} in truth; the recording tells it to ± {half_width} (95 %)").in_language(language))
}

fn finding(effect: &GradedEffect, language: Language) -> String {
    let finding = match effect.finding {
        Finding::Identified => language.pick("named", "已唯一命名").to_owned(),
        Finding::ActsLike => language
            .pick("said to act like it", "称其表现如同此效应")
            .to_owned(),
        Finding::Listed(count) => say!("in a list of {count}").in_language(language),
        Finding::Unexplained => language
            .pick("reported without a name", "报告为未解释")
            .to_owned(),
        Finding::Missed if effect.truth.lambda_beside < FAINT => {
            say!("not found, and too weak to be required (λ < {FAINT})").in_language(language)
        }
        Finding::Missed => language.pick("not found", "未发现").to_owned(),
    };
    if !effect.overclaimed {
        return finding;
    }
    finding
        + language.pick(
            ", though another name gives the same recording",
            "，但另有名称可给出同样的记录",
        )
}
