//! What speaks against candidates that the answer does not name: each is put in the place of what the answer has, and
//! beside it.

use super::choice::block_of;
use super::closed_form::Scale;
use super::departure::FORM;
use super::detection;
use super::findings::{Alternative, Examination, Variant, Verdict};
use super::null::Simulated;
use super::plan::DETECTED;
use super::question::{Kind, Question};
use super::space::{Frame, Space};

/// What a recording says of a candidate beyond the answer.
#[derive(Debug, Clone, PartialEq)]
pub struct Against {
    /// Index of the candidate.
    pub candidate: usize,
    /// Whether anything of it is seen whatever its size; else the parameters absorb it.
    pub visible: bool,
    /// It in place of an effect of the answer, or of what has no name: the likeliest set of that kind. `None` where there is nothing
    /// in whose place it could stand.
    pub instead: Option<Instead>,
    /// It beside all effects of the answer; `None` where it adds nothing to what these may do, and where it stands beside them as the
    /// name of what has none.
    pub beside: Option<Beside>,
}

/// A candidate in the place of another effect.
#[derive(Debug, Clone, PartialEq)]
pub struct Instead {
    /// With the probability that remains for it where the answer and this set are all there is.
    pub own: Alternative,
    /// The candidate that gives way; `None` for something without a name, beside all names.
    pub of: Option<usize>,
    /// χ² of the residuals, with the noise of the answer, …
    pub chi_squared: f64,
    /// … and its degrees of freedom.
    pub dof: usize,
    /// By what noise that is claimed would have to be multiplied for it not to be excluded; `None` where it is not excluded, or where the
    /// residuals tell the noise.
    pub noise: Option<f64>,
    /// The atom that explains most of what is left.
    pub strongest: Option<usize>,
    /// Probability that as much would be left by chance, among all atoms, if this set were the truth.
    pub p: f64,
    /// Simulated recordings behind it.
    pub draws: usize,
    /// Whether that is less than the probability of a false alarm.
    pub is_excluded: bool,
}

/// A candidate beside the answer.
#[derive(Debug, Clone, PartialEq)]
pub struct Beside {
    /// With the probability of one that was not chosen, against none.
    pub own: Alternative,
    /// The size from which on it is detected mostly; `None` for an effect with several sizes.
    pub detectable: Option<f64>,
}

/// What speaks against some candidates, given what was found.
pub fn against(question: &Question, found: &Examination, candidates: &[usize]) -> Vec<Against> {
    let space = Space::new(question);
    let simulated = Simulated::new(&space, question.settings.draws);
    let trial = Trial::new(&space, &simulated, found);
    let each = candidates.iter();
    each.map(|candidate| trial.of(*candidate)).collect()
}

/// The answer, before which candidates are heard.
struct Trial<'t> {
    space: &'t Space<'t>,
    simulated: &'t Simulated<'t>,
    /// The named effects of the answer.
    answer: Frame,
    /// Logarithm of its odds against none; where something has no name, of the best explanation with it.
    score: f64,
    /// Whether something has no name.
    is_open: bool,
}

impl<'t> Trial<'t> {
    fn new(space: &'t Space<'t>, simulated: &'t Simulated<'t>, found: &Examination) -> Trial<'t> {
        let atoms = found.fitted.iter().flat_map(|fitted| &fitted.atoms);
        let blocks: Vec<usize> = atoms.filter_map(|atom| block_of(space, *atom)).collect();
        let answer = space.frame_of(&blocks);
        let is_open = matches!(found.verdict, Verdict::Partly | Verdict::Unexplained);
        let own = space.score(&answer);
        Trial {
            space,
            simulated,
            score: if is_open { own.max(found.score) } else { own },
            answer,
            is_open,
        }
    }

    fn of(&self, candidate: usize) -> Against {
        let blocks = self.space.blocks.iter().enumerate();
        let own =
            blocks.filter(|(_, block)| block.candidate == candidate && block.kind() == Kind::Named);
        let blocks: Vec<usize> = own.map(|(index, _)| index).collect();
        let instead = self.instead(candidate, &blocks);
        let is_beside = instead.as_ref().is_some_and(|instead| instead.of.is_none());
        Against {
            candidate,
            visible: !blocks.is_empty(),
            beside: (!is_beside).then(|| self.beside(&blocks)).flatten(),
            instead,
        }
    }

    /// The likeliest set with one of these blocks in it and without one of the answer, or, where something has no name, with all of
    /// the answer.
    fn instead(&self, candidate: usize, blocks: &[usize]) -> Option<Instead> {
        let is_other = |block: &&usize| self.space.blocks[**block].candidate != candidate;
        let given_way = self.answer.blocks.iter().filter(is_other);
        let given_way = given_way.map(|block| Some(*block));
        let nameless = self.is_open.then_some(None);
        let places: Vec<Option<usize>> = given_way.chain(nameless).collect();
        let sets = places.into_iter().flat_map(|of| {
            let rest = self.without(of);
            let with = blocks.iter().filter_map(move |block| {
                let set = self.joined(&rest, *block)?;
                Some((of, *block, self.space.score(&set), set))
            });
            with.collect::<Vec<_>>()
        });
        let (of, block, score, set) = sets.max_by(|a, b| a.2.total_cmp(&b.2))?;
        let space = self.space;
        let left = space.residual(&set);
        let outcome = detection::test(space, &set, FORM, None, self.simulated);
        let is_excluded = outcome.p <= space.question.settings.alpha;
        let is_claimed = is_excluded && matches!(space.scale, Scale::Known);
        let noise = || detection::tolerable(space, &set, FORM, self.simulated);
        Some(Instead {
            own: Alternative {
                probability: 1.0 / (1.0 + libm::exp(self.score - score)),
                ..self.alternative(&self.without(of), block)
            },
            of: of.map(|of| space.blocks[of].candidate),
            chi_squared: left.chi_squared,
            dof: left.dof,
            noise: is_claimed.then(noise).flatten(),
            strongest: outcome.strongest.map(|block| space.blocks[block].atom),
            p: outcome.p,
            draws: outcome.draws,
            is_excluded,
        })
    }

    /// The likeliest of these blocks beside the answer.
    fn beside(&self, blocks: &[usize]) -> Option<Beside> {
        let space = self.space;
        let none = space.score(&self.answer);
        let sets = blocks.iter().filter_map(|block| {
            let set = self.joined(&self.answer, *block)?;
            Some((*block, space.score(&set) - none))
        });
        let (block, odds) = sets.max_by(|a, b| a.1.total_cmp(&b.1))?;
        let own = Alternative {
            probability: 1.0 / (1.0 + libm::exp(-odds)),
            ..self.alternative(&self.answer, block)
        };
        let detectable = match own.covariance.as_slice() {
            [variance] => Some(DETECTED * variance.sqrt()),
            _ => None,
        };
        Some(Beside { own, detectable })
    }

    /// The answer without one of its blocks.
    fn without(&self, of: Option<usize>) -> Frame {
        let blocks = self.answer.blocks.iter().copied();
        let rest: Vec<usize> = blocks.filter(|block| Some(*block) != of).collect();
        self.space.frame_of(&rest)
    }

    fn joined(&self, rest: &Frame, block: usize) -> Option<Frame> {
        let may = self.space.may_join(rest, &self.space.blocks[block]);
        may.then(|| self.space.extended(rest, block)).flatten()
    }

    /// A block beside a set, with its sizes.
    fn alternative(&self, rest: &Frame, block: usize) -> Alternative {
        let found = &self.space.blocks[block];
        let variant = Variant {
            atom: found.atom,
            share: 1.0,
        };
        let mut alternative = Alternative {
            variants: vec![variant],
            ..Alternative::bare(found.candidate)
        };
        alternative.stated(self.space, rest, block);
        // It was asked for, and not found.
        alternative.selection = 1.0;
        alternative
    }
}
