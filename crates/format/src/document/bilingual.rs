//! Two documents that say the same in two languages, as one: figures stand once, words beside each other.

use std::mem::discriminant;

use super::{Block, Document, Plot, Sheet};

impl Document {
    /// This document with the words of the other beside its own, whatever both write alike once. Machines are told what
    /// this one tells them.
    #[must_use]
    pub fn beside_the_words_of(mut self, other: Document) -> Document {
        self.other = Some(other.language);
        self.blocks = side_by_side(self.blocks, other.blocks);
        self.beside = pairwise(self.beside, other.beside, Plot::texts_of, Plot::texts);
        self.sheets = pairwise(self.sheets, other.sheets, Sheet::texts_of, Sheet::texts);
        if let (Some(own), Some(other)) = (&mut self.certificate, other.certificate) {
            own.join(*other);
        }
        self
    }
}

/// The blocks of both, each beside its counterpart; from where they do not correspond, those of one after the other.
fn side_by_side(one: Vec<Block>, other: Vec<Block>) -> Vec<Block> {
    let alike = one.iter().zip(&other);
    let alike = alike.take_while(|(one, other)| discriminant(*one) == discriminant(*other));
    let alike = alike.count();
    let (mut one, mut other) = (one.into_iter(), other.into_iter());
    let mut blocks = Vec::with_capacity(one.len());
    let pairs = one.by_ref().take(alike).zip(other.by_ref());
    pairs.for_each(|(one, other)| blocks.extend(both(one, other)));
    blocks.extend(one.chain(other));
    blocks
}

/// Two blocks of one kind.
fn both(one: Block, other: Block) -> Vec<Block> {
    match (one, other) {
        (one, other) if one == other => vec![one],
        (one @ Block::Paragraph(_), other) => vec![one, other],
        (Block::List(one), Block::List(other)) => vec![Block::List(in_turn(one, other))],
        (Block::Findings(one), Block::Findings(other)) => {
            vec![Block::Findings(in_turn(one, other))]
        }
        (Block::Statement(one), Block::Statement(other)) => {
            vec![Block::Statement(in_turn(one, other))]
        }
        (Block::Closing(one), Block::Closing(other)) => vec![Block::Closing(in_turn(one, other))],
        (Block::Footer(one), Block::Footer(other)) => vec![Block::Footer(in_turn(one, other))],
        (one, other) => pairwise(vec![one], vec![other], Block::texts_of, Block::texts),
    }
}

/// Sentences in turn; those of one after those of the other where they do not correspond.
fn in_turn<T: PartialEq>(mut one: Vec<T>, other: Vec<T>) -> Vec<T> {
    if one.len() != other.len() {
        one.extend(other);
        return one;
    }
    let pairs = one.into_iter().zip(other);
    let pair = |(one, other)| match one == other {
        true => [Some(one), None],
        false => [Some(one), Some(other)],
    };
    pairs.flat_map(pair).flatten().collect()
}

/// Does something to every text.
type Walk<T> = fn(&mut T, &mut dyn FnMut(&mut String));

/// What is made of the same texts, text by text; what is not, one after the other.
fn pairwise<T>(
    one: Vec<T>,
    other: Vec<T>,
    texts: fn(&mut T) -> Vec<String>,
    walk: Walk<T>,
) -> Vec<T> {
    let mut all = Vec::with_capacity(one.len());
    let mut others = other.into_iter();
    for mut own in one {
        let Some(mut other) = others.next() else {
            all.push(own);
            continue;
        };
        let words = texts(&mut other);
        if words.len() != texts(&mut own).len() {
            all.extend([own, other]);
            continue;
        }
        let mut words = words.into_iter();
        walk(&mut own, &mut |text| match words.next() {
            Some(word) if word != *text => *text = beside_each_other(text, &word),
            _ => {}
        });
        all.push(own);
    }
    all.extend(others);
    all
}

/// Two words as one: `U, expanded 扩展 / V` of `U, expanded / V` and `扩展 / V`.
fn beside_each_other(one: &str, other: &str) -> String {
    let parts = one.rsplit_once(" / ").zip(other.rsplit_once(" / "));
    match parts {
        Some(((one, unit), (other, same))) if unit == same => format!("{one} {other} / {unit}"),
        _ => format!("{one} / {other}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::document::{ColumnKind, Finding, Severity, Table};
    use gumption_fault::language::Language;

    #[test]
    fn figures_stand_once_and_words_twice() {
        let table = |head: &str, word: &str| {
            let mut table = Table::new([(head, ColumnKind::Words), ("U", ColumnKind::Numbers)]);
            table.push(vec![word.into(), "0.13".into()]);
            Block::Table(table)
        };
        let sentences =
            |all: &[&str]| Block::Statement(all.iter().map(|s| s.to_string()).collect());
        let one = vec![
            Block::Section("Result".into()),
            table("verdict", "conforming"),
            sentences(&["U is expanded.", "k = 2"]),
        ];
        let other = vec![
            Block::Section("结果".into()),
            table("结论", "合格"),
            sentences(&["U 为扩展不确定度。", "k = 2"]),
            Block::Paragraph("更多".into()),
        ];
        assert_eq!(
            side_by_side(one, other),
            [
                Block::Section("Result / 结果".into()),
                table("verdict / 结论", "conforming / 合格"),
                sentences(&["U is expanded.", "U 为扩展不确定度。", "k = 2"]),
                Block::Paragraph("更多".into()),
            ]
        );
    }

    /// What stands before a finding is in the language of its sentence.
    #[test]
    fn findings_are_cautioned_of_in_their_own_language() {
        let findings = |language, text: &str| {
            Block::Findings(vec![Finding {
                id: "not_validated".into(),
                severity: Severity::Warning,
                language,
                text: text.into(),
            }])
        };
        let one = findings(Language::English, "not validated");
        let other = findings(Language::Chinese, "未通过验证");
        let [Block::Findings(both)] = &side_by_side(vec![one], vec![other])[..] else {
            panic!("one block");
        };
        let cautions: Vec<&str> = both.iter().map(Finding::caution).collect();
        assert_eq!(cautions, ["Caution: ", "注意："]);
    }

    #[test]
    fn a_unit_stands_behind_both_words() {
        assert_eq!(beside_each_other("U / V", "扩展 / V"), "U 扩展 / V");
        assert_eq!(beside_each_other("U / V", "扩展"), "U / V / 扩展");
    }

    #[test]
    fn tables_of_another_shape_stand_one_after_the_other() {
        let narrow = Block::Table(Table::new([("a", ColumnKind::Words)]));
        let wide = Block::Table(Table::new([
            ("a", ColumnKind::Words),
            ("b", ColumnKind::Words),
        ]));
        let all = side_by_side(vec![narrow.clone()], vec![wide.clone()]);
        assert_eq!(all, [narrow, wide]);
    }
}
