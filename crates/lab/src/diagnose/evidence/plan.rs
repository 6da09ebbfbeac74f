//! Without data: what an experiment can see and tell apart.

use nalgebra::DMatrix;

use super::baseline::Baseline;
use super::directions::{INVISIBLE, without};
use super::question::{Atom, Candidate, Kind, Question, Settings, Shape};
use super::separate::SEPARATED;
use super::space::{Block, Space};

/// What an experiment of this design can see and tell apart. Sizes refer to the noise of the baseline.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    /// One for each named atom, in their order.
    pub seen: Vec<Seen>,
    /// Named atoms of different candidates that are one in this experiment, two or more in each class.
    pub classes: Vec<Vec<usize>>,
}

/// How well an experiment sees one atom.
#[derive(Debug, Clone, PartialEq)]
pub struct Seen {
    /// Index of the atom.
    pub atom: usize,
    /// Share of its whitened length that the parameters do not absorb, 0 … 1; the smallest of its columns'.
    pub visibility: f64,
    /// Coefficient that is detected as good as always, λ = 6: that of the column seen worst. `None` if a
    /// column is invisible.
    pub detectable: Option<f64>,
    /// Its nearest rival, exact aliases included; none where it is invisible.
    pub rival: Option<Pair>,
}

/// How well an experiment tells an atom from its nearest rival.
#[derive(Debug, Clone, PartialEq)]
pub struct Pair {
    /// The atom of another candidate that resembles it most.
    pub rival: usize,
    /// Cosine of the angle between the two.
    pub cosine: f64,
    /// Coefficient of the atom that is told from the rival as good as always, κ = 5; `None` for exact
    /// aliases.
    pub separable: Option<f64>,
}

/// Strength with which effects are mostly detected.
pub(super) const DETECTED: f64 = 6.0;
/// Sine of the angle under which two effects are one.
const ALIAS: f64 = 1e-3;

/// What an experiment can see and tell apart. The residuals of the baseline do not matter.
pub fn visibility(baseline: &Baseline, candidates: &[Candidate], atoms: &[Atom]) -> Plan {
    let question = Question {
        baseline,
        candidates,
        atoms,
        settings: Settings::default(),
    };
    let space = Space::new(&question);
    let blocks = space.blocks.iter();
    let named: Vec<&Block> = blocks.filter(|block| block.kind() == Kind::Named).collect();
    let nearest = |block: &&Block| {
        let is_rival = |rival: &&&Block| {
            rival.candidate != block.candidate && !extends(candidates, rival, block)
        };
        let rivals = named
            .iter()
            .filter(is_rival)
            .map(|rival| pair(block, rival));
        rivals.max_by(|a, b| a.cosine.total_cmp(&b.cosine))
    };
    let seen = |(index, atom): (usize, &Atom)| match &atom.shape {
        Shape::Columns(columns) => Some(Seen {
            rival: (named.iter().find(|block| block.atom == index)).and_then(nearest),
            ..seen(baseline, index, columns)
        }),
        Shape::Smooth { .. } | Shape::Scatter => None,
    };
    Plan {
        seen: atoms.iter().enumerate().filter_map(seen).collect(),
        classes: classes(&named),
    }
}

fn seen(baseline: &Baseline, atom: usize, columns: &DMatrix<f64>) -> Seen {
    let visibility = baseline.visibility(columns);
    let seen = baseline.project(columns);
    let lengths = seen.column_iter().map(|column| column.norm());
    let shortest = lengths.fold(f64::INFINITY, f64::min);
    Seen {
        atom,
        visibility,
        detectable: (visibility > INVISIBLE).then(|| DETECTED / shortest),
        rival: None,
    }
}

/// Whether one effect is another with more freedom, as a curved drift is a drift: no rival to it.
fn extends(candidates: &[Candidate], more: &Block, less: &Block) -> bool {
    more.basis.ncols() > less.basis.ncols()
        && candidates[more.candidate].family == candidates[less.candidate].family
}

/// The column of `block` that `rival` comes nearest to.
fn pair(block: &Block, rival: &Block) -> Pair {
    let columns = block.determined();
    let left = without(&columns, &rival.basis);
    let lengths = columns.column_iter().zip(left.column_iter());
    let lengths = lengths.map(|(column, left)| (column.norm(), left.norm()));
    let nearest = lengths.min_by(|a, b| (a.1 / a.0).total_cmp(&(b.1 / b.0)));
    let (length, left) = nearest.unwrap_or((1.0, 1.0));
    let sine = (left / length).min(1.0);
    Pair {
        rival: rival.atom,
        cosine: (1.0 - sine * sine).sqrt(),
        separable: (sine > ALIAS).then(|| SEPARATED / left),
    }
}

/// Groups of atoms of several candidates that span the same directions.
fn classes(named: &[&Block]) -> Vec<Vec<usize>> {
    let mut classes: Vec<Vec<&Block>> = Vec::new();
    for block in named {
        match classes.iter_mut().find(|class| same(class[0], block)) {
            Some(class) => class.push(block),
            None => classes.push(vec![block]),
        }
    }
    classes.retain(|class| class.iter().any(|b| b.candidate != class[0].candidate));
    let atoms = |class: &Vec<&Block>| class.iter().map(|block| block.atom).collect();
    classes.iter().map(atoms).collect()
}

fn same(a: &Block, b: &Block) -> bool {
    a.basis.ncols() == b.basis.ncols() && without(&a.basis, &b.basis).norm() < ALIAS
}

#[cfg(test)]
mod tests {
    use super::super::fixture::{Tumble, shape};
    use super::*;

    type Law = (&'static str, fn(f64, f64) -> f64);
    const LAWS: [Law; 9] = [
        ("K2", |a, _| a.sin().powi(2)),
        ("Kpp", |a, _| a.cos().powi(2)),
        ("K3", |a, _| a.sin().powi(3)),
        ("Kip", |a, _| a.sin() * a.cos()),
        ("ASYM", |a, _| a.sin().abs()),
        ("ECC1 sin", |a, h| a.cos() * h.sin()),
        ("ECC1 cos", |a, h| a.cos() * h.cos()),
        ("ECC2 sin", |a, h| a.cos() * (2.0 * h).sin()),
        ("ECC2 cos", |a, h| a.cos() * (2.0 * h).cos()),
    ];

    fn plan(tumble: &Tumble) -> Plan {
        let laws = LAWS.iter().enumerate();
        let candidates = laws
            .clone()
            .map(|(index, (name, _))| Candidate::plain(name, index));
        let candidates: Vec<Candidate> = candidates.collect();
        let atoms = laws.map(|(candidate, (_, law))| Atom {
            candidate,
            variant: 0,
            shape: shape(tumble.column(law)),
            share: 1.0,
        });
        let atoms: Vec<Atom> = atoms.collect();
        visibility(&tumble.baseline(), &candidates, &atoms)
    }

    fn index(name: &str) -> usize {
        LAWS.iter().position(|(other, _)| *other == name).unwrap()
    }

    fn class_of<'a>(plan: &'a Plan, name: &str) -> Vec<&'a str> {
        let mut classes = plan.classes.iter();
        let class = classes.find(|class| class.contains(&index(name)));
        class.map_or_else(Vec::new, |class| {
            class.iter().map(|atom| LAWS[*atom].0).collect()
        })
    }

    #[test]
    fn visibilities_of_twelve_positions_are_the_closed_forms() {
        let plan = plan(&Tumble::new(12, &[0.0]));
        for (name, expected) in [("K2", 1.0 / 3.0), ("K3", 0.1), ("Kip", 1.0)] {
            let seen = &plan.seen[index(name)];
            assert!((seen.visibility - expected).abs() < 1e-12, "{name}");
        }
        // ‖PWh‖² of s² is 12/8: its mean is taken out, cos 2α/2 stays.
        let detectable = plan.seen[index("K2")].detectable.unwrap();
        assert!((detectable - 6.0 / 1.5_f64.sqrt()).abs() < 1e-12);
    }

    #[test]
    fn aliases_of_one_mount_are_one_class() {
        let plan = plan(&Tumble::new(12, &[0.0]));
        assert_eq!(class_of(&plan, "K2"), ["K2", "Kpp", "ECC1 cos"]);
        assert_eq!(class_of(&plan, "Kip"), ["Kip", "ECC1 sin"]);
        assert_eq!(class_of(&plan, "K3"), ["K3", "ECC2 sin"]);
        assert_eq!(class_of(&plan, "ASYM"), [""; 0]);
        let pair = plan.seen[index("ASYM")].rival.as_ref().unwrap();
        // 24 positions and more: 0.957; twelve leave a little more between them.
        assert!(pair.cosine > 0.9 && pair.cosine < 0.99);
    }

    #[test]
    fn four_positions_leave_one_contrast() {
        let plan = plan(&Tumble::new(4, &[0.0]));
        assert_eq!(class_of(&plan, "K2"), ["K2", "Kpp", "ASYM", "ECC1 cos"]);
        for name in ["K3", "Kip", "ECC1 sin", "ECC2 sin", "ECC2 cos"] {
            assert!(plan.seen[index(name)].detectable.is_none(), "{name}");
        }
    }

    #[test]
    fn a_second_mount_separates_if_it_is_the_right_one() {
        let quarter = plan(&Tumble::new(12, &[0.0, 90.0]));
        assert!(!class_of(&quarter, "K3").contains(&"ECC2 sin"));
        let half = plan(&Tumble::new(12, &[0.0, 180.0]));
        assert!(class_of(&half, "K3").contains(&"ECC2 sin"));
        assert!(!class_of(&half, "K2").contains(&"ECC1 cos"));
    }
}
