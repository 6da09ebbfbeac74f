//! Which effects a reader asks about, by whatever name.

use gumption_fault::{Said, nearest, say};

use crate::diagnose::catalogue::{Effect, EffectId, Kind, effects};

/// The effects of which a diagnosis is to say why they are not the answer.
#[derive(Debug, Clone, Default, PartialEq)]
pub enum Asked {
    /// None.
    #[default]
    Nothing,
    /// All that the case can have.
    Everything,
    /// These.
    These(Vec<Called>),
}

/// An effect that is asked about.
#[derive(Debug, Clone, PartialEq)]
pub enum Called {
    /// One of the catalogue.
    Effect(EffectId),
    /// An explanation of the user's own, by its name.
    Own(String),
    /// All that follow a column, by its name.
    Along(String),
}

impl Asked {
    /// Others besides.
    pub fn add(&mut self, others: Asked) {
        match (&mut *self, others) {
            (Asked::Everything, _) | (_, Asked::Nothing) => {}
            (Asked::These(these), Asked::These(others)) => {
                for other in others {
                    if !these.contains(&other) {
                        these.push(other);
                    }
                }
            }
            (asked, others) => *asked = others,
        }
    }

    /// What is meant by `all`, by an identifier of the catalogue, the name of an explanation of the user's own or of a column, by
    /// words of the name of an effect in either language, by its name as it is printed, or by words of its description: those
    /// that have all of them in the closest of these.
    ///
    /// # Errors
    /// Nothing is called so, with what may have been meant.
    pub fn of<'o>(
        words: &str,
        own: impl Iterator<Item = &'o str>,
        columns: impl Iterator<Item = &'o str>,
    ) -> Result<Asked, Said> {
        let wanted = plain(words);
        let wanted = wanted.trim();
        if ["all", "全部"].contains(&wanted) {
            return Ok(Asked::Everything);
        }
        let own = own.map(|own| Called::Own(own.to_owned()));
        let columns = columns.map(|column| Called::Along(column.to_owned()));
        let is_meant = |called: &Called| match called {
            Called::Own(name) | Called::Along(name) => plain(name) == wanted,
            Called::Effect(_) => false,
        };
        if let Some(called) = own.chain(columns).find(is_meant) {
            return Ok(Asked::These(vec![called]));
        }
        let known = effects().iter();
        let known = known.filter(|effect| matches!(effect.kind, Kind::Physics | Kind::Record));
        let of = |says: fn(&Effect) -> String, is_meant: &dyn Fn(&str) -> bool| -> Vec<Called> {
            let meant = known
                .clone()
                .filter(|effect| is_meant(&plain(&says(effect))));
            meant.map(|effect| Called::Effect(effect.id)).collect()
        };
        let has_all = |text: &str| {
            let mut words = wanted.split_whitespace();
            !wanted.is_empty() && words.all(|word| text.contains(word))
        };
        let mut closest = [
            of(|effect| effect.id.to_string(), &|text| text == wanted),
            of(names, &has_all),
            of(|effect| effect.name.en.clone(), &|name| {
                is_filled(name, wanted)
            }),
            of(|effect| effect.name.zh.clone(), &|name| {
                is_filled(name, wanted)
            }),
            of(descriptions, &has_all),
        ]
        .into_iter();
        closest
            .find(|found| !found.is_empty())
            .map(Asked::These)
            .ok_or_else(|| {
                let all = say!(
                    "`--why all` (in Python, `why=\"all\"`) accounts for every effect that the case can have"
                );
                let ids = known.clone().map(|effect| effect.id.as_str());
                let near = nearest(words, ids).map(str::to_owned);
                let near = near.or_else(|| respelt(wanted, known.clone().map(names)));
                let mend = near.map_or(all, |near| say!("did you mean \"{near}\"?"));
                say!("the catalogue has no effect \"{words}\": {mend}")
            })
    }
}

fn names(effect: &Effect) -> String {
    format!("{} {} {}", effect.id, effect.name.en, effect.name.zh)
}

/// Whether words are a name with something in its places, `zero error of {p}`.
fn is_filled(name: &str, words: &str) -> bool {
    let parts: Vec<&str> = name.split(['{', '}']).step_by(2).collect();
    let [start, within @ .., end] = &parts[..] else {
        return name == words;
    };
    let rest = words.strip_prefix(start);
    let rest = rest.and_then(|rest| rest.strip_suffix(end));
    let behind = |rest: Option<_>, part: &&str| {
        let (filled, rest): (&str, &str) = rest.and_then(|rest: &str| rest.split_once(*part))?;
        (!filled.is_empty()).then_some(rest)
    };
    let rest = within.iter().fold(rest, behind);
    rest.is_some_and(|rest| !rest.is_empty())
}

/// The words as the nearest words of some name have them, where one name has all of these.
fn respelt(wanted: &str, names: impl Iterator<Item = String> + Clone) -> Option<String> {
    // What stands in brackets is no part of a word.
    let names = names.map(|name| plain(&name).replace(['(', ')'], " "));
    names.into_iter().find_map(|name| {
        let near = wanted
            .split_whitespace()
            .map(|word| nearest(word, name.split_whitespace()));
        let near: Vec<&str> = near.collect::<Option<_>>()?;
        (!near.is_empty()).then(|| near.join(" "))
    })
}

fn descriptions(effect: &Effect) -> String {
    format!("{} {} {}", effect.family, effect.prose.en, effect.prose.zh)
}

/// In lower case, with blanks between words.
fn plain(text: &str) -> String {
    text.to_lowercase().replace(['-', '_'], " ")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// In a case without explanations of its own, and without columns.
    fn alone(words: &str) -> Result<Asked, Said> {
        Asked::of(words, [].into_iter(), [].into_iter())
    }

    #[test]
    fn one_may_ask_for_several() {
        let of = |words: &str| alone(words).unwrap();
        let both = [EffectId::TemperatureLag, EffectId::Cubic];
        let mut asked = Asked::default();
        for id in both.iter().chain(&both) {
            asked.add(of(id.as_str()));
        }
        assert_eq!(asked, Asked::These(both.map(Called::Effect).into()));
        asked.add(Asked::Everything);
        asked.add(of(EffectId::Cubic.as_str()));
        assert_eq!(asked, Asked::Everything);
    }

    fn asked(words: &str) -> Vec<Called> {
        match Asked::of(
            words,
            ["bending"].into_iter(),
            ["T", "humidity"].into_iter(),
        ) {
            Ok(Asked::These(these)) => these,
            other => panic!("{words}: {other:?}"),
        }
    }

    #[test]
    fn effects_are_found_by_identifier_name_and_description() {
        let lag = [Called::Effect(EffectId::TemperatureLag)];
        assert_eq!(asked(EffectId::TemperatureLag.as_str()), lag);
        assert_eq!(asked("Thermal lag"), lag);
        assert_eq!(asked("热滞后"), lag);
        assert_eq!(asked("Bending"), [Called::Own("bending".to_owned())]);
        assert_eq!(asked("humidity"), [Called::Along("humidity".to_owned())]);
        // The identifier goes before names that have it in them.
        let cube = EffectId::Cubic;
        assert_eq!(asked(cube.as_str()), [Called::Effect(cube)]);
        assert!(asked("temperature").len() > 3);
        assert!(asked("dead zone").contains(&Called::Effect(EffectId::ZeroStep)));
        assert_eq!(alone("ALL"), Ok(Asked::Everything));
        // As it is printed.
        let zero = [Called::Effect(EffectId::ZeroOf)];
        assert_eq!(asked("zero error of theta"), zero);
        assert_eq!(asked("theta 的零位误差"), zero);
    }

    #[test]
    fn what_nobody_knows_is_refused() {
        let refused = alone("hystersis").unwrap_err().to_string();
        assert!(refused.contains(EffectId::Hysteresis.as_str()), "{refused}");
        for (words, near) in [
            ("termal", "\"thermal\""),
            ("thermal lagg", "\"thermal lag\""),
        ] {
            let refused = alone(words).unwrap_err().to_string();
            assert!(refused.contains(near), "{refused}");
        }
        assert!(alone("").is_err());
        assert!(
            alone("astrology")
                .unwrap_err()
                .to_string()
                .contains("--why all")
        );
    }
}
