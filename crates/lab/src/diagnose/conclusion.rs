//! What a diagnosis says: which names are told, which are tentative, and what stays without a name.
//!
//! Everything that is weighed is weighed here; reports put it into words.

use super::case::Case;
use super::catalogue::{EffectId, Term, Variation};
use super::confirm::Estimated;
use super::evidence::{self, Against, Alternative, Likeness, Slot, State, Verdict};
use super::run::Diagnosis;

/// What a diagnosis says, in one sentence.
#[derive(Debug, Clone, PartialEq)]
pub enum Conclusion<'d> {
    /// Model and recording agree.
    Agreement,
    /// The model meets every reading, to the rounding of numbers.
    Exact,
    /// Nothing disagrees, and nothing could: the noise is estimated, and any effect would leave no degree of freedom for it.
    Untested,
    /// The model leaves out named effects, and nothing else.
    LeavesOut {
        /// Effects with one name, or one that is far likelier than the others.
        told: Vec<&'d Slot>,
        /// Effects with several names that the recording cannot tell apart.
        open: Vec<&'d Slot>,
    },
    /// The model leaves out a named effect, and something without a name.
    AndMore {
        /// The effect with a name.
        named: Vec<&'d Slot>,
        /// Names that are not certain.
        tentative: Vec<&'d Alternative>,
        /// Where the rest sits.
        places: Vec<&'d Alternative>,
    },
    /// No name is certain.
    Tentative {
        /// Names that are not certain.
        names: Vec<&'d Alternative>,
        /// Where the rest sits.
        places: Vec<&'d Alternative>,
    },
    /// A name is about as likely as something without one.
    Undecided {
        /// The name.
        name: &'d Alternative,
        /// Where what has no name sits.
        places: Vec<&'d Alternative>,
    },
    /// Nothing in the catalogue explains the recording.
    Unexplained {
        /// Where the mismatch sits.
        places: Vec<&'d Alternative>,
    },
}

/// Why the names of an unexplained slot are to be taken with care.
#[derive(Debug, Clone, PartialEq)]
pub enum Doubt<'d> {
    /// There is neither a name nor a place.
    Nothing,
    /// The name may be the shape of another effect.
    Uncertain,
    /// It sits here; names, where there are any, are tentative.
    At {
        /// Competitors without a name that are likely enough.
        places: Vec<&'d Alternative>,
        /// Whether names resemble it.
        resembles: bool,
    },
}

/// How an effect that was considered stands to the answer.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Standing {
    /// It is in the answer, with this probability.
    Named(f64),
    /// It is among the tentative names, with this probability.
    Tentative(f64),
    /// The parameters absorb it.
    Absorbed,
    /// In the place of another it leaves more than chance does.
    Excluded,
    /// In the place of another it would do, and is less likely.
    LessLikely,
    /// There is nothing in whose place it could stand.
    NotSeen,
}

/// Less likely than this, what has no name is out of the question.
const UNLIKELY: f64 = 0.05;
/// A name of this probability is not much less likely than what has none.
const LIKELY_NAME: f64 = 0.2;

impl Slot {
    /// Whether no explanation of a list is far likelier than the others.
    pub fn is_open(&self) -> bool {
        /// Probability of a first one that leads.
        const LEADS: f64 = 0.95;
        let first = self.named.first();
        self.state == State::Ambiguous && first.is_none_or(|first| first.probability < LEADS)
    }

    /// The probability that something without a name stands here instead of names that hold; `None` where that is out of the
    /// question.
    pub fn doubted(&self) -> Option<f64> {
        let share = Some(self.generic_share).filter(|share| *share >= UNLIKELY);
        share.filter(|_| self.is_explained())
    }

    /// Whether its names say no more than what the effect acts like. One that leads a list says no more than it would alone.
    pub fn acts_like(&self) -> bool {
        let says_little = || self.doubted().is_some() || !(self.is_open() || self.is_severe());
        self.state == State::Like || (self.state == State::Ambiguous && says_little())
    }

    /// Whether it has names that hold.
    pub fn is_explained(&self) -> bool {
        self.state != State::Unexplained
    }

    /// Whether a name holds, or is at least not much less likely than what has none.
    pub fn has_likely_name(&self) -> bool {
        let mut first = self.named.iter().take(1);
        self.is_explained() || first.any(|one| one.probability >= LIKELY_NAME)
    }

    /// Names worth telling: all that hold, and of those that do not the likely ones.
    pub fn told(&self) -> impl Iterator<Item = &Alternative> {
        let named = self.named.iter();
        named.filter(|one| self.is_explained() || one.weighs())
    }
}

impl Alternative {
    /// Whether it is likely enough to be told although it is not certain.
    pub fn weighs(&self) -> bool {
        const LEAST: f64 = 0.005;
        self.probability >= LEAST
    }

    /// Whether nothing else comes near.
    pub fn is_sure(&self) -> bool {
        const SURE: f64 = 0.999;
        self.probability > SURE
    }
}

impl Diagnosis {
    /// The answer in one sentence.
    pub fn conclusion(&self) -> Conclusion<'_> {
        let slots = self.examination.slots.iter();
        let named = slots.clone().filter(|slot| slot.is_explained());
        let (open, told): (Vec<&Slot>, Vec<&Slot>) = named.partition(|slot| slot.is_open());
        match self.examination.verdict {
            Verdict::None if self.noise.is_of_arithmetic() => return Conclusion::Exact,
            Verdict::None if self.noise.is_estimated() && self.before.dof <= 1.0 => {
                return Conclusion::Untested;
            }
            Verdict::None => return Conclusion::Agreement,
            Verdict::Identified | Verdict::Like | Verdict::Ambiguous => {
                return Conclusion::LeavesOut { told, open };
            }
            Verdict::Partly | Verdict::Unexplained => {}
        }
        let named: Vec<&Slot> = told.into_iter().chain(open).collect();
        // Another form of what has its name already has none of its own.
        let is_told = |one: &&Alternative| {
            let mut firsts = named.iter().filter_map(|slot| slot.named.first());
            firsts.any(|first| first.candidate == one.candidate)
        };
        let tentative = slots.filter_map(|slot| self.tentative(slot));
        let tentative: Vec<&Alternative> = tentative.filter(|one| !is_told(one)).collect();
        let places = self.places();
        match (named.is_empty(), tentative.is_empty(), self.undecided()) {
            (false, ..) => Conclusion::AndMore {
                named,
                tentative,
                places,
            },
            (true, false, _) => Conclusion::Tentative {
                names: tentative,
                places,
            },
            (true, true, Some(name)) => Conclusion::Undecided { name, places },
            (true, true, None) => Conclusion::Unexplained { places },
        }
    }

    /// How an effect that is asked about stands to the answer.
    pub fn standing(&self, against: &Against) -> Standing {
        // Another order of a name may be what holds.
        let is_it = |atom: usize| self.atoms[atom].0 == against.candidate;
        let share = |one: &Alternative| {
            let own = one.variants.iter().filter(|variant| is_it(variant.atom));
            one.probability * own.map(|variant| variant.share).sum::<f64>()
        };
        let slots = self.examination.slots.iter();
        let told = slots.flat_map(|slot| slot.told().map(move |one| (slot, share(one))));
        let named = told.filter(|(_, probability)| *probability > 0.0);
        let named = named.max_by(|a, b| a.1.total_cmp(&b.1));
        match (named, &against.instead) {
            (Some((slot, probability)), _) => match slot.is_explained() {
                true => Standing::Named(probability),
                false => Standing::Tentative(probability),
            },
            (None, _) if !against.visible => Standing::Absorbed,
            (None, Some(instead)) if instead.is_excluded => Standing::Excluded,
            (None, Some(_)) => Standing::LessLikely,
            (None, None) => Standing::NotSeen,
        }
    }

    /// Why a slot says no more than what its effect acts like.
    pub fn likeness(&self, slot: &Slot) -> Likeness {
        let of = |candidate: usize| {
            let cell = &self.cells[candidate];
            evidence::Nature {
                place: &cell.place,
                describes: cell.effect.pattern.is_some(),
                is_scatter: cell.is_scatter(),
            }
        };
        match evidence::likeness(slot, &self.examination.slots, of) {
            Likeness::Form => self.likened.unwrap_or(Likeness::Form),
            other => other,
        }
    }

    /// Why the names of a slot are to be taken with care; `None` where they hold.
    pub fn doubt<'d>(&self, slot: &'d Slot) -> Option<Doubt<'d>> {
        if slot.is_explained() {
            return None;
        }
        let places: Vec<&Alternative> = slot.generic.iter().filter(|one| one.weighs()).collect();
        let resembles = slot.named.iter().any(Alternative::weighs);
        Some(match (places.is_empty(), resembles) {
            (true, false) => Doubt::Nothing,
            (true, true) => Doubt::Uncertain,
            _ if self.tentative(slot).is_some() => Doubt::Uncertain,
            _ => Doubt::At { places, resembles },
        })
    }

    /// The name of a slot that is not certain, but far likelier than everything without a name.
    fn tentative<'d>(&self, slot: &'d Slot) -> Option<&'d Alternative> {
        /// A name is tentative from here on.
        const LIKELY: f64 = 0.5;
        let unlikely = slot.generic.iter().all(|one| one.probability < UNLIKELY);
        let first = slot.named.first().filter(|one| one.probability > LIKELY);
        let first = first.filter(|one| !self.describes(one));
        first.filter(|_| !slot.is_explained() && unlikely)
    }

    /// Whether a name only tells how the recording looks, which is no name beside something unexplained.
    fn describes(&self, one: &Alternative) -> bool {
        self.cells[one.candidate].effect.only_describes()
    }

    /// The first name of the first slot, if it is not much less likely than what has no name.
    fn undecided(&self) -> Option<&Alternative> {
        let slot = self.examination.slots.first()?;
        let first = (slot.named.first()).filter(|one| one.probability >= LIKELY_NAME);
        slot.generic.first()?;
        first.filter(|one| !self.describes(one))
    }

    /// Where what is unexplained sits: what is likely enough; else, where no name is tentative either, the best there is.
    fn places(&self) -> Vec<&Alternative> {
        let slots = self.examination.slots.iter();
        let slots = slots.filter(|slot| !slot.is_explained());
        let (tentative, nameless): (Vec<&Slot>, Vec<&Slot>) =
            slots.partition(|slot| self.tentative(slot).is_some());
        let found = nameless.iter().filter_map(|slot| slot.generic.first());
        let likely: Vec<&Alternative> = found.clone().filter(|one| one.weighs()).collect();
        match likely.is_empty() && tentative.is_empty() {
            true => found.collect(),
            false => likely,
        }
    }

    /// The most probable variant of an alternative.
    pub fn variation(&self, alternative: &Alternative) -> Option<&Variation> {
        let (cell, variation) = self.atoms[alternative.variants.first()?.atom];
        Some(&self.cells[cell].variants[variation])
    }

    /// The terms of that variant that have a size of their own.
    pub fn terms(&self, alternative: &Alternative) -> Vec<&Term> {
        let terms = self.variation(alternative).into_iter();
        let terms = terms.flat_map(|variation| &variation.terms);
        terms.filter(|term| !term.tied).collect()
    }

    /// Whether what an alternative adds comes late.
    pub fn lags(&self, alternative: &Alternative) -> bool {
        let variation = self.variation(alternative);
        let late = |term: &Term| term.modifier.text.contains("lag(");
        variation.is_none_or(|variation| variation.terms.iter().any(late))
    }

    /// Candidates of the same cause and another order that may stand instead of an alternative, with their shares.
    pub fn other_orders(&self, alternative: &Alternative) -> Vec<(usize, f64)> {
        /// Orders of less than this share are out of the question.
        const SHARE: f64 = 0.01;
        let mut shares = std::collections::BTreeMap::new();
        for variant in &alternative.variants {
            *shares.entry(self.atoms[variant.atom].0).or_insert(0.0) += variant.share;
        }
        shares.remove(&alternative.candidate);
        let shares = shares.into_iter();
        shares.filter(|(_, share)| *share >= SHARE).collect()
    }

    /// The effect on the scale that gives the same recording as an alternative, because the readings hardly vary.
    pub fn same_on_scale(&self, alternative: &Alternative) -> Option<EffectId> {
        let effect = self.cells[alternative.candidate].effect;
        effect.on_scale.filter(|_| self.steady)
    }

    /// The amplitude of what repeats with the sine and the cosine of one argument, in the unit of the sine's size.
    pub fn amplitude(&self, case: &Case, alternative: &Alternative) -> Option<Estimated> {
        let [sine, cosine] = self.terms(alternative)[..] else {
            return None;
        };
        let argument = sine.written().text.strip_prefix("sin(")?;
        if cosine.written().text.strip_prefix("cos(") != Some(argument) {
            return None;
        }
        let value = alternative.estimate.norm();
        let gradient = &alternative.estimate / value;
        let of_noise = gradient.dot(&(&alternative.covariance * &gradient)).sqrt();
        let of_choice = gradient.component_mul(&alternative.choice).norm();
        let u = alternative.widened(of_noise, of_choice);
        u.is_finite().then(|| Estimated {
            name: "amplitude".to_owned(),
            unit: sine.unit_of_size(case).typeset(),
            value,
            u,
            dof: alternative.dof,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_list_that_leaves_much_open_is_of_what_acts_alike() {
        let slot = |state: State, generic_share: f64| Slot {
            state,
            named: Vec::new(),
            generic: Vec::new(),
            generic_share,
            family: None,
        };
        assert!(!slot(State::Ambiguous, 0.02).acts_like());
        assert!(slot(State::Ambiguous, 0.85).acts_like());
        assert!(slot(State::Like, 0.0).acts_like());
        assert_eq!(slot(State::Ambiguous, 0.85).doubted(), Some(0.85));
        assert_eq!(slot(State::Identified, 0.02).doubted(), None);
        // What has no name that holds is told as that.
        assert_eq!(slot(State::Unexplained, 0.85).doubted(), None);
    }
}
