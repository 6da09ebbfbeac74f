//! Experiments on the rigs: what the examination says of recordings whose truth is known.

use std::ops::ControlFlow;

use gumption::diagnose::evidence::{
    Atom, Baseline, Covariance, Examination, Kind, Noise, Prior, Question, Settings, Shape, State,
    Verdict, examine,
};
use gumption_lanes::sampler::gamma_block;
use gumption_lanes::{Block, Generator, level};
use nalgebra::{DMatrix, DVector};

use crate::rigs::{Rig, normals, rate, triad, tumble};

/// A rig with what all of its recordings share.
pub struct Bench {
    pub rig: Rig,
    lower: DMatrix<f64>,
    /// With the true covariance matrix, for λ and κ.
    truth: Baseline,
    pub settings: Settings,
}

/// What was put into a recording.
pub struct Hidden {
    pub atoms: Vec<usize>,
    pub effect: DVector<f64>,
}

/// How a single effect was reported.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Grade {
    Right,
    Listed,
    /// A unique name, although another candidate is an exact alias.
    Overclaim,
    Unexplained,
    Miss,
    WrongList,
    WrongName,
}

impl Bench {
    pub fn new(rig: Rig) -> Bench {
        let lower = rig
            .covariance
            .to_dense()
            .cholesky()
            .expect("a covariance matrix")
            .unpack();
        let zero = DVector::zeros(rig.jacobian.nrows());
        let prior = Prior::none(rig.jacobian.ncols());
        let truth = Baseline::new(&rig.jacobian, &zero, &Noise::known(rig.covariance.clone()), &prior)
            .expect("a design");
        Bench {
            rig,
            lower,
            truth,
            settings: Settings { draws: 2000, ..Settings::default() },
        }
    }

    pub fn all(seed: u64) -> Vec<Bench> {
        vec![
            Bench::new(tumble(seed, &[0.0])),
            Bench::new(tumble(seed, &[0.0, 90.0])),
            Bench::new(triad(seed)),
            Bench::new(rate(seed)),
        ]
    }

    pub fn columns(&self, atom: usize) -> Option<&DMatrix<f64>> {
        match &self.rig.atoms[atom].shape {
            Shape::Columns(columns) => Some(columns),
            _ => None,
        }
    }

    /// Visible named atoms that physics could hide (no single bad rows).
    pub fn physical(&self) -> Vec<usize> {
        (0..self.rig.atoms.len())
            .filter(|a| {
                let atom = &self.rig.atoms[*a];
                let name = &self.rig.candidates[atom.candidate].name;
                let decoy = ["HUMIDITY", "PRESSURE"].contains(&name.as_str());
                !decoy
                    && self.columns(*a).is_some_and(|h| {
                        let seen = self.truth.project(h).norm_squared();
                        let whole = self.truth_whole(h);
                        seen > 1e-3 * whole && seen > 0.0
                    })
            })
            .collect()
    }

    fn truth_whole(&self, h: &DMatrix<f64>) -> f64 {
        let solved = self.lower.solve_lower_triangular(h).expect("a factor");
        solved.norm_squared()
    }

    /// An effect of strength λ in a random direction of its coefficients.
    pub fn effect(&self, atom: usize, lambda: f64, seed: u64, stream: u64) -> DVector<f64> {
        let h = self.columns(atom).expect("a named atom");
        let beta = DVector::from_vec(normals(seed, stream, h.ncols()));
        let effect = h * beta;
        let size = self.visible(&effect).norm();
        effect * (lambda / size)
    }

    fn visible(&self, effect: &DVector<f64>) -> DVector<f64> {
        let n = effect.len();
        self.truth
            .project(&DMatrix::from_column_slice(n, 1, effect.as_slice()))
            .column(0)
            .into_owned()
    }

    /// What is left of an effect after each other named atom.
    pub fn kappa(&self, hidden: &Hidden) -> f64 {
        let a = self.visible(&hidden.effect);
        let own = self.rig.atoms[hidden.atoms[0]].candidate;
        (0..self.rig.atoms.len())
            .filter(|j| self.rig.atoms[*j].candidate != own)
            .filter_map(|j| self.columns(j))
            .map(|h| {
                let projected = self.truth.project(h);
                if projected.norm_squared() < 1e-6 * self.truth_whole(h) {
                    return a.norm();
                }
                let svd = projected.svd(true, false);
                let u = svd.u.expect("asked for");
                let keep: Vec<usize> = (0..u.ncols())
                    .filter(|k| svd.singular_values[*k] > 1e-6 * svd.singular_values[0])
                    .collect();
                let u = u.select_columns(&keep);
                (&a - &u * u.tr_mul(&a)).norm()
            })
            .fold(f64::INFINITY, f64::min)
    }

    /// Examines a recording with this effect, with these atoms on offer.
    pub fn examine(&self, effect: &DVector<f64>, atoms: &[Atom], seed: u64, stream: u64) -> Examination {
        let noise = DVector::from_vec(normals(seed, stream, effect.len()));
        let residuals = &self.lower * noise + effect;
        let nu = self.rig.scale_dof;
        let mut scale = Block::ZERO;
        let mut generator = Generator::new(seed, 78, stream);
        gamma_block(level(), &mut generator, 0.5 * nu, &mut scale);
        let known = if nu.is_finite() { 2.0 * scale.0[0] / nu } else { 1.0 };
        let covariance = Covariance::Dense(self.rig.covariance.to_dense() * known);
        let baseline = Baseline::new(
            &self.rig.jacobian,
            &residuals,
            &Noise::with_scale_dof(covariance, nu),
            &Prior::none(self.rig.jacobian.ncols()),
        )
        .expect("a design");
        let question = Question {
            baseline: &baseline,
            candidates: &self.rig.candidates,
            atoms,
            settings: Settings { seed: seed ^ (stream << 20), ..self.settings.clone() },
        };
        examine(&question, &|_| ControlFlow::Continue(())).expect("an answer")
    }
}

/// Grades a report on one hidden effect.
pub fn grade(bench: &Bench, found: &Examination, hidden: &Hidden, kappa: f64) -> Grade {
    let truth = bench.rig.atoms[hidden.atoms[0]].candidate;
    let named: Vec<&[_]> = found
        .slots
        .iter()
        .filter(|slot| slot.state != State::Unexplained)
        .map(|slot| slot.named.as_slice())
        .collect();
    let alias = kappa < 1e-3 * bench.visible(&hidden.effect).norm();
    match found.verdict {
        Verdict::None => Grade::Miss,
        Verdict::Unexplained | Verdict::Contested => Grade::Unexplained,
        _ => {
            let unique: Vec<usize> = named
                .iter()
                .filter(|list| list.len() == 1)
                .map(|list| list[0].candidate)
                .collect();
            let listed = named.iter().any(|list| list.iter().any(|one| one.candidate == truth));
            if unique.iter().any(|name| *name != truth) {
                Grade::WrongName
            } else if unique.contains(&truth) && named.len() == 1 {
                if alias { Grade::Overclaim } else { Grade::Right }
            } else if listed {
                Grade::Listed
            } else {
                Grade::WrongList
            }
        }
    }
}

fn arg(n: usize, default: usize) -> usize {
    std::env::args().nth(n).and_then(|a| a.parse().ok()).unwrap_or(default)
}

pub fn main() {
    match std::env::args().nth(1).as_deref() {
        Some("null") => null(arg(2, 200)),
        Some("single") => single(arg(2, 100), false),
        Some("open") => open(arg(2, 40)),
        Some("multi") => multi(arg(2, 40)),
        _ => single(arg(2, 20), true),
    }
}

fn null(count: usize) {
    for mut bench in Bench::all(1) {
        let start = std::time::Instant::now();
        let (mut alarms, mut wrong) = (0, 0);
        let zero = DVector::zeros(bench.rig.jacobian.nrows());
        bench.settings.draws = 2000;
        for k in 0..count {
            let found = bench.examine(&zero, &bench.rig.atoms, 11, k as u64);
            alarms += usize::from(found.verdict != Verdict::None);
            wrong += usize::from(
                found.verdict != Verdict::None
                    && found.slots.iter().any(|s| s.state == State::Identified),
            );
        }
        println!("{:8} null {count}: alarms {alarms}, names {wrong}, {:?}", bench.rig.name, start.elapsed() / count as u32);
    }
}

/// Singles over λ.
fn single(count: usize, verbose: bool) {
    let mut by_kappa = std::collections::BTreeMap::<usize, Vec<Grade>>::new();
    for lambda in [4.0, 6.0, 8.0, 12.0, 20.0] {
        let mut grades = Vec::new();
        for (b, bench) in Bench::all(1).iter().enumerate() {
            let start = std::time::Instant::now();
            let physical = bench.physical();
            let mut own = Vec::new();
            for k in 0..count {
                let stream = (b * 100_000 + k) as u64 * 4;
                let atom = pick(bench, &physical, 5, stream);
                let hidden = Hidden { atoms: vec![atom], effect: bench.effect(atom, lambda, 5, stream + 1) };
                let kappa = bench.kappa(&hidden);
                let found = bench.examine(&hidden.effect, &bench.rig.atoms, 5, stream + 2);
                let grade = grade(bench, &found, &hidden, kappa);
                if lambda >= 6.0 && kappa > 1e-3 * lambda {
                    by_kappa.entry((kappa.min(12.0)) as usize).or_default().push(grade);
                }
                if verbose && (grade == Grade::WrongName || grade == Grade::WrongList || grade == Grade::Unexplained) {
                    describe(bench, &found, &hidden, lambda, kappa, grade);
                }
                own.push(grade);
            }
            println!("λ {lambda:4} {:8} {} {:?}", bench.rig.name, shares(&own), start.elapsed() / count as u32);
            grades.extend(own);
        }
        println!("λ {lambda:4} all      {}", shares(&grades));
    }
    for (k, grades) in by_kappa {
        println!("κ {k:2} n {:4} {}", grades.len(), shares(&grades));
    }
}

/// A candidate at random, then a variant of it.
pub fn pick(bench: &Bench, physical: &[usize], seed: u64, stream: u64) -> usize {
    let mut names: Vec<usize> = physical.iter().map(|a| bench.rig.atoms[*a].candidate).collect();
    names.dedup();
    let mut block = Block::ZERO;
    Generator::new(seed, 79, stream).uniforms(level(), &mut block);
    let name = names[(block.0[0] * names.len() as f64) as usize];
    let own: Vec<usize> = physical.iter().copied().filter(|a| bench.rig.atoms[*a].candidate == name).collect();
    own[(block.0[1] * own.len() as f64) as usize]
}

fn shares(grades: &[Grade]) -> String {
    use Grade::*;
    [Right, Listed, Overclaim, Unexplained, Miss, WrongList, WrongName]
        .iter()
        .map(|g| {
            let n = grades.iter().filter(|x| *x == g).count();
            format!("{g:?} {:.1}", 100.0 * n as f64 / grades.len().max(1) as f64)
        })
        .collect::<Vec<_>>()
        .join(" | ")
}

fn describe(bench: &Bench, found: &Examination, hidden: &Hidden, lambda: f64, kappa: f64, grade: Grade) {
    let name = |c: usize| bench.rig.candidates[c].name.as_str();
    let truth: Vec<String> = hidden.atoms.iter().map(|a| format!("{}/{}", name(bench.rig.atoms[*a].candidate), bench.rig.atoms[*a].variant)).collect();
    println!("  {grade:?} {} truth {truth:?} λ {lambda} κ {kappa:.1} verdict {:?} pg {:.3} explained {:.2} χ² {:.0}/{} p {:?}", bench.rig.name, found.verdict, found.generic_probability, found.explained, found.chi_squared, found.dof, found.levels.iter().map(|l| (name(bench.rig.atoms[l.strongest].candidate), l.p)).collect::<Vec<_>>());
    for slot in &found.slots {
        println!("     {:?} {:?} generic {:.3} {:?}", slot.state, slot.named.iter().map(|a| (name(a.candidate), (a.probability * 1000.0).round() / 1000.0)).collect::<Vec<_>>(), slot.generic_share, slot.generic.iter().take(2).map(|a| (name(a.candidate), (a.probability * 1000.0).round() / 1000.0)).collect::<Vec<_>>());
    }
}

/// The true candidate removed.
fn open(count: usize) {
    let mut all = Vec::new();
    for lambda in [12.0] {
        for (b, bench) in Bench::all(1).iter().enumerate() {
            let physical = bench.physical();
            let mut own = Vec::new();
            let mut k = 0;
            while own.len() < count {
                k += 1;
                let stream = (b * 100_000 + k) as u64 * 4;
                let atom = pick(bench, &physical, 6, stream);
                let hidden = Hidden { atoms: vec![atom], effect: bench.effect(atom, lambda, 6, stream + 1) };
                let kappa = bench.kappa(&hidden);
                if kappa < 5.0 {
                    continue;
                }
                let candidate = bench.rig.atoms[atom].candidate;
                let atoms: Vec<Atom> = bench.rig.atoms.iter().filter(|a| a.candidate != candidate).cloned().collect();
                let found = bench.examine(&hidden.effect, &atoms, 6, stream + 2);
                let grade = grade_open(&found);
                if grade == "wrong name" {
                    let mut named = found.clone();
                    for slot in &mut named.slots {
                        slot.generic.truncate(2);
                    }
                    let c = |i: usize| bench.rig.candidates[i].name.as_str();
                    println!("  {} truth {}/{} κ {kappa:.1} {:?} expl {:.2} pg {:.3} χ²fit {:?} named {:?} gates {:?}", bench.rig.name, c(candidate), bench.rig.atoms[atom].variant, found.verdict, found.explained, found.generic_probability,
                        found.fitted.as_ref().map(|f| (f.chi_squared.round(), f.dof)),
                        found.slots.iter().map(|s| (s.state, s.named.iter().map(|a| (c(a.candidate), (a.lambda * 10.0).round() / 10.0)).collect::<Vec<_>>(), (s.generic_share * 1e3).round() / 1e3)).collect::<Vec<_>>(),
                        found.levels.iter().map(|l| l.p).collect::<Vec<_>>());
                }
                own.push(grade);
            }
            print!("λ {lambda} {:8}", bench.rig.name);
            tally(&own);
            all.extend(own);
        }
    }
    print!("all");
    tally(&all);
}

fn tally(grades: &[&str]) {
    for g in ["unexplained", "partly", "wrong list", "wrong name", "none"] {
        let n = grades.iter().filter(|x| **x == g).count();
        print!("  {g} {:.1}", 100.0 * n as f64 / grades.len() as f64);
    }
    println!("  of {}", grades.len());
}

fn grade_open(found: &Examination) -> &'static str {
    let unique = found.slots.iter().any(|s| s.state == State::Identified);
    match found.verdict {
        Verdict::None => "none",
        Verdict::Unexplained | Verdict::Contested => "unexplained",
        _ if unique => "wrong name",
        Verdict::Partly => "partly",
        _ => "wrong list",
    }
}

/// Two and three effects.
fn multi(count: usize) {
    for (effects, lambda) in [(2, 10.0), (2, 20.0), (3, 20.0)] {
        let mut tally = std::collections::BTreeMap::<&str, usize>::new();
        for (b, bench) in Bench::all(1).iter().enumerate() {
            let physical = bench.physical();
            for k in 0..count {
                let stream = (b * 100_000 + k) as u64 * 16;
                let mut atoms: Vec<usize> = Vec::new();
                let mut tries = 0;
                while atoms.len() < effects {
                    let atom = pick(bench, &physical, 7, stream + tries);
                    tries += 1;
                    let new = |a: &usize| bench.rig.atoms[*a].candidate != bench.rig.atoms[atom].candidate;
                    if atoms.iter().all(new) {
                        atoms.push(atom);
                    }
                }
                let effect = atoms.iter().enumerate().fold(DVector::zeros(bench.rig.jacobian.nrows()), |sum, (i, a)| sum + bench.effect(*a, lambda, 8, stream + i as u64));
                let found = bench.examine(&effect, &bench.rig.atoms, 7, stream + 9);
                let truths: Vec<usize> = atoms.iter().map(|a| bench.rig.atoms[*a].candidate).collect();
                let grade = grade_multi(&found, &truths);
                if grade == "wrong name" {
                    describe(bench, &found, &Hidden { atoms, effect }, lambda, 0.0, Grade::WrongName);
                }
                *tally.entry(grade).or_default() += 1;
            }
        }
        println!("{effects} effects at λ {lambda}: {:?}", tally);
    }
}

fn grade_multi(found: &Examination, truths: &[usize]) -> &'static str {
    let sure: Vec<_> = found.slots.iter().filter(|s| s.state != State::Unexplained).collect();
    if matches!(found.verdict, Verdict::Unexplained) {
        return "unexplained";
    }
    if matches!(found.verdict, Verdict::Contested) {
        return "contested";
    }
    if sure.iter().any(|s| s.state == State::Identified && !truths.contains(&s.named[0].candidate)) {
        return "wrong name";
    }
    let covered = truths.iter().filter(|t| sure.iter().any(|s| s.named.iter().any(|a| a.candidate == **t))).count();
    let unique = truths.iter().filter(|t| sure.iter().any(|s| s.state == State::Identified && s.named[0].candidate == **t)).count();
    match () {
        _ if unique == truths.len() && sure.len() == truths.len() => "right",
        _ if covered == truths.len() => "list",
        _ if covered > 0 => "part",
        _ => "wrong list",
    }
}

/// Whether the shapes of an atom are named: used by the experiments.
pub fn is_named(atom: &Atom) -> bool {
    atom.shape.kind() == Kind::Named
}
