//! Why effects that were asked about are not the answer.

use crate::figures::with_unit;
use crate::language::Language;
use crate::number::{aligned, percent, significant};
use crate::phrase::{section, table};
use gumption_fault::say;
use gumption_format::document::{
    Block,
    ColumnKind::{Names as NamesColumn, Numbers, Wrapped},
};
use gumption_lab::diagnose::case::Case;
use gumption_lab::diagnose::catalogue::{EffectId, Words};
use gumption_lab::diagnose::evidence::{Against, Alternative, Beside, Instead, Verdict};
use gumption_lab::diagnose::{Account, Diagnosis, Standing};

use super::labels::spoken;
use super::names::Names;
use super::words::{below_p, chance, p_found};

/// So many effects have their sentences; more are a table.
const READ: usize = 5;

/// What was asked about, effect by effect.
pub(super) fn blocks(case: &Case, diagnosis: &Diagnosis, l: Language) -> Vec<Block> {
    let teller = Teller {
        case,
        diagnosis,
        names: Names::of_diagnosis(diagnosis, l),
    };
    let accounts = &diagnosis.accounts;
    let told = match accounts.len() {
        0 => return Vec::new(),
        n if n > READ => teller.table(),
        _ => vec![Block::List(
            accounts.iter().map(|one| teller.account(one)).collect(),
        )],
    };
    let heading = section(l, "What was asked about", "所询问的影响");
    [vec![heading], told].concat()
}

/// The name of an effect that acts on nothing in this case.
pub(super) fn nowhere(id: EffectId, l: Language) -> String {
    letters().fill(id.entry().name.of(l))
}

/// What stands for the columns and quantities that there are not.
fn letters() -> Words {
    let [x, y, z, p] = ["x", "y", "z", "p"].map(str::to_owned);
    Words { x, y, z, p }
}

struct Teller<'t> {
    case: &'t Case,
    diagnosis: &'t Diagnosis,
    names: Names<'t>,
}

impl Teller<'_> {
    fn account(&self, account: &Account) -> String {
        let l = self.names.l;
        match account {
            Account::LeftOut(id) => {
                let name = nowhere(*id, l);
                say!("{name}: not considered; [diagnosis] leaves it out.").in_language(l)
            }
            Account::NothingToActOn(id) => {
                let (name, formula) = (nowhere(*id, l), letters().fill(&id.entry().formula));
                say!(
                    "{name}: not considered. The case has nothing that it could act on, or its rows would not show it as such: too few where it acts, or no order between them ({formula})."
                )
                .in_language(l)
            }
            Account::NothingAlong(column) => {
                say!("{column}: nothing in the catalogue follows it in this case.").in_language(l)
            }
            Account::OfNoise(id) => {
                let name = nowhere(*id, l);
                say!("{name}: a part of the noise, where the line of the noise tells it.")
                    .in_language(l)
            }
            Account::Impossible(cell) => {
                let name = self.names.full(*cell);
                say!("{name}: it would have a size that it cannot have.").in_language(l)
            }
            Account::Considered(against) => self.considered(against),
        }
    }

    /// What was considered, with the figures of the sentences.
    fn table(&self) -> Vec<Block> {
        let l = self.names.l;
        let mut table = table(
            l,
            [
                ("effect", "影响", Wrapped),
                ("standing", "地位", NamesColumn),
                ("χ²", "χ²", Numbers),
                ("ν", "ν", Numbers),
                ("p", "p", Numbers),
                ("noise", "噪声", Numbers),
                ("λ", "λ", Numbers),
            ],
        );
        for account in &self.diagnosis.accounts {
            let against = match account {
                Account::Considered(against) => against,
                Account::Impossible(cell) => {
                    let standing = l.pick("impossible size", "大小不可能");
                    let cells = [self.names.full(*cell), standing.to_owned()].into_iter();
                    let cells = cells.chain(vec![String::new(); 5]);
                    table.push(cells.map(Into::into).collect());
                    continue;
                }
                Account::LeftOut(_)
                | Account::NothingToActOn(_)
                | Account::NothingAlong(_)
                | Account::OfNoise(_) => continue,
            };
            let figures = against.instead.as_ref().map(|instead| {
                [
                    significant(instead.chi_squared, 3),
                    instead.dof.to_string(),
                    below_p(&p_found(instead.p, instead.draws)),
                    instead.noise.map_or(String::new(), |noise| {
                        format!("× {}", significant(noise, 2))
                    }),
                ]
            });
            let own = against.beside.as_ref().map(|beside| &beside.own);
            let own = own.or(against.instead.as_ref().map(|instead| &instead.own));
            let lambda = own.map_or(String::new(), |own| significant(own.lambda, 2));
            let name = self.names.full(against.candidate);
            let standing = self.standing(self.diagnosis.standing(against));
            let cells = [name, standing.to_owned()].into_iter();
            let cells = cells.chain(figures.unwrap_or_default()).chain([lambda]);
            table.push(cells.map(Into::into).collect());
        }
        let key = Block::Paragraph(say!("χ² for ν degrees of freedom, with the noise as the answer has it, is what each leaves in the place of the likeliest effect of the answer, or of what has no name; p the probability of what stands out beside it; with noise so many times larger than claimed it would not be excluded; λ is its strength beside the answer. `--why EFFECT` has sizes.").in_language(l));
        vec![Block::Table(table), key]
    }

    fn standing(&self, standing: Standing) -> &'static str {
        let l = self.names.l;
        match standing {
            Standing::Named(_) => l.pick("in the answer", "在结论中"),
            Standing::Tentative(_) => l.pick("tentative", "仅供参考"),
            Standing::Absorbed => l.pick("absorbed", "被吸收"),
            Standing::Excluded => l.pick("excluded", "已排除"),
            Standing::LessLikely => l.pick("less likely", "可能性较小"),
            Standing::NotSeen => l.pick("not seen", "未见到"),
        }
    }

    fn considered(&self, against: &Against) -> String {
        let l = self.names.l;
        let name = self.names.plain(against.candidate);
        let beside = || against.beside.as_ref().map(|beside| self.beside(beside));
        let instead = || {
            against
                .instead
                .as_ref()
                .map(|instead| self.instead(instead))
        };
        let both = || {
            let both = [instead(), beside()].into_iter().flatten();
            both.collect::<Vec<_>>().join(l.pick(" ", ""))
        };
        match self.diagnosis.standing(against) {
            Standing::Named(p) => {
                let p = chance(p);
                say!("{name}: in the answer ({p} %).").in_language(l)
            }
            Standing::Tentative(p) => {
                let p = chance(p);
                say!("{name}: among the tentative names ({p} %).").in_language(l)
            }
            Standing::Absorbed => say!("{name}: the parameters absorb it, or leave less than a hundredth of it, which the curvature of a model may be; it is not considered.").in_language(l),
            Standing::Excluded => {
                let why = both();
                say!("{name}: excluded. {why}").in_language(l)
            }
            Standing::LessLikely => {
                let why = both();
                say!("{name}: not excluded, but less likely. {why}").in_language(l)
            }
            Standing::NotSeen => {
                let why = beside().unwrap_or_default();
                say!("{name}: not seen. {why}").in_language(l)
            }
        }
    }

    /// It in the place of another.
    fn instead(&self, instead: &Instead) -> String {
        let l = self.names.l;
        let place = match instead.of {
            Some(of) => {
                let other = self.names.plain(of);
                say!("In the place of {other}").in_language(l)
            }
            None => say!("As the name of what has none").in_language(l),
        };
        let own = self.described(&instead.own);
        let (chi_squared, dof) = (significant(instead.chi_squared, 3), instead.dof);
        let p = p_found(instead.p, instead.draws);
        let left = match instead.strongest {
            Some(atom) if instead.is_excluded => {
                let other = self.names.variant(self.diagnosis.atoms[atom]);
                say!("{other} stands out beside it ({p}).").in_language(l)
            }
            _ => {
                let share = percent(instead.own.probability);
                say!("nothing stands out beside it ({p}), and the answer leaves it a probability of {share} %.").in_language(l)
            }
        };
        let fit =
            say!("{place}{own} it leaves χ² = {chi_squared} for {dof} degrees of freedom; {left}")
                .in_language(l);
        fit + &self.brought_back(instead)
    }

    /// What would make it possible.
    fn brought_back(&self, instead: &Instead) -> String {
        let times = instead.noise.map(|noise| significant(noise, 2));
        times.map_or_else(String::new, |times| {
            say!(" It would not be excluded if the noise were {times} times that which is claimed.")
                .in_language(self.names.l)
        })
    }

    /// It beside the answer.
    fn beside(&self, beside: &Beside) -> String {
        let l = self.names.l;
        let (lambda, own) = (
            significant(beside.own.lambda, 2),
            self.described(&beside.own),
        );
        let seen = match self.diagnosis.examination.verdict {
            Verdict::None => {
                say!("Beside the declared model{own} its strength is λ = {lambda}").in_language(l)
            }
            _ => say!("Beside the answer{own} its strength is λ = {lambda}").in_language(l),
        };
        let unit = self.units(&beside.own).next().unwrap_or_default();
        match beside.detectable {
            Some(size) => {
                let size = with_unit(&significant(size, 2), &unit);
                say!("{seen}; from a size of about {size} on it would be seen.").in_language(l)
            }
            None => seen + l.pick(".", "。"),
        }
    }

    /// Variant and sizes, in brackets with a blank before them; nothing where there are too many.
    fn described(&self, own: &Alternative) -> String {
        /// More are in the JSON.
        const MOST: usize = 2;
        let l = self.names.l;
        let variation = self.diagnosis.variation(own);
        let label = variation.map(|variation| spoken(&variation.short_label(), l));
        let label = label.filter(|label| !label.is_empty());
        let sizes = own
            .estimate
            .iter()
            .zip(own.u().iter().copied().collect::<Vec<_>>());
        let sizes = sizes.zip(self.units(own)).map(|((size, u), unit)| {
            with_unit(
                &format!("{} ± {}", aligned(*size, u, 2), significant(u, 2)),
                &unit,
            )
        });
        let sizes = sizes.filter(|_| own.estimate.len() <= MOST);
        let all: Vec<String> = label.into_iter().chain(sizes).collect();
        match all.is_empty() {
            true => String::new(),
            false => l.with_aside("", &all.join(l.comma())),
        }
    }

    fn units(&self, own: &Alternative) -> impl Iterator<Item = String> {
        let terms = self.diagnosis.terms(own).into_iter();
        terms.map(|term| term.unit_of_size(self.case).typeset())
    }
}
