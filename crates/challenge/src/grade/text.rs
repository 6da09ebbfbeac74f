//! A graded diagnosis in words.

use serde_json::Value;

use super::score::{Finding, Graded, GradedEffect};
use crate::report::Language;

/// Format of the JSON.
const FORMAT: &str = "gumption-grade-1";

/// Everything for machines.
pub fn json(graded: &Graded) -> Value {
    let mut value = serde_json::to_value(graded).unwrap_or(Value::Null);
    if let Value::Object(map) = &mut value {
        map.insert("format".into(), FORMAT.into());
    }
    value
}

/// A few lines for the terminal.
pub fn text(graded: &Graded, language: Language) -> String {
    let pick = |english: &str, chinese: &str| match language {
        Language::English => english.to_string(),
        Language::Chinese => chinese.to_string(),
    };
    let mut lines = vec![
        format!("{}: {}", pick("concealed", "隐藏情形"), graded.scenario),
        format!(
            "{}: {}",
            pick("verdict of the diagnosis", "诊断结论"),
            graded.verdict
        ),
    ];
    lines.extend(graded.effects.iter().map(|effect| line(effect, language)));
    for (name, probability) in &graded.wrong_names {
        lines.push(format!(
            "  {} {name} ({} {probability:.3}): −1",
            pick("wrong name", "错误名称"),
            pick("posterior", "后验概率")
        ));
    }
    for list in &graded.wrong_lists {
        lines.push(format!(
            "  {}: {}",
            pick("list without anything that is there", "列表中无真实效应"),
            list.join(" | ")
        ));
    }
    if graded.false_alarm {
        lines.push(format!(
            "  {}: −1",
            pick("alarm where nothing is concealed", "无隐藏效应却报警")
        ));
    }
    if graded.prediction_points > 0.0 {
        lines.push(format!(
            "  {}: +{}",
            pick("prediction improved", "预测得到改进"),
            graded.prediction_points
        ));
    }
    lines.push(format!(
        "{}: {:.2} / {:.2}",
        pick("points", "得分"),
        graded.points,
        graded.attainable
    ));
    lines.join("\n") + "\n"
}

fn line(effect: &GradedEffect, language: Language) -> String {
    let chinese = language == Language::Chinese;
    let finding = match (effect.finding, chinese) {
        (Finding::Unique, false) => "named".to_string(),
        (Finding::Unique, true) => "已唯一命名".to_string(),
        (Finding::Listed(count), false) => format!("in a list of {count}"),
        (Finding::Listed(count), true) => format!("在 {count} 个名称的列表中"),
        (Finding::Unexplained, false) => "reported without a name".to_string(),
        (Finding::Unexplained, true) => "报告为未解释".to_string(),
        (Finding::Missed, false) => "not found".to_string(),
        (Finding::Missed, true) => "未发现".to_string(),
    };
    let overclaim = match (effect.overclaimed, chinese) {
        (false, _) => "",
        (true, false) => ", though another name gives the same recording",
        (true, true) => "，但另有名称可给出同样的记录",
    };
    format!(
        "  {} (λ = {:.1}, κ = {:.1}): {finding}{overclaim}: {:+.2}",
        effect.truth.physics.name(),
        effect.truth.lambda_beside,
        effect.truth.kappa,
        effect.points
    )
}
