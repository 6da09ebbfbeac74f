//! Workbooks whose cells hold other figures than their formulas give, or none.

use crate::claim::Claimed;
use crate::read::Mapping;
use crate::search::Gap;
use crate::sheet::Grid;
use crate::{Verdict, audit, read, sheet};

/// The budget of a sheet with formulas in some of its cells.
fn of_formulas(text: &str, formulas: &[(usize, usize, &str)]) -> Claimed {
    let mut grids = sheet::grids("sheet.csv", text.as_bytes()).unwrap();
    for (row, column, formula) in formulas {
        let cells = &mut grids[0].rows[*row];
        cells.resize(cells.len().max(column + 1), sheet::Cell::default());
        cells[*column].formula = Some((*formula).into());
    }
    sheet::mark_stale(&mut grids);
    claimed(&grids)
}

fn claimed(grids: &[Grid]) -> Claimed {
    read::budgets(grids, &Mapping::default()).remove(0)
}

fn ids(claimed: &Claimed) -> Vec<String> {
    let audited = audit(claimed);
    let best = audited.found.explanations.first();
    let acts = best.into_iter().flat_map(|best| &best.acts);
    acts.map(|act| act.id(&audited.found.case)).collect()
}

const FORMULAS: [(usize, usize, &str); 3] = [(1, 3, "B2/C2"), (2, 3, "B3/C3"), (3, 3, "B4/C4")];

fn sheet_of(u: &str, u_c: &str, expanded: &str) -> String {
    format!(
        "Source,Value (g),Divisor,u (g)\nRef certificate k=2,0.02,2,0.01\n\
         Repeatability of the mean,0.03,1,0.03\nResolution 0.04 g,0.02,1.7320508075688772,{u}\n\
         Combined standard uncertainty,,,{u_c}\nExpanded uncertainty (k=2),,,{expanded}\n"
    )
}

/// A short number beside those with all digits is one that was not computed, of u_c, of U and of a row.
#[test]
fn stale_cells_are_named() {
    let whole = [(4, 3, "SQRT(SUMSQ(D2:D4))"), (5, 3, "2*D5")];
    let formulas: Vec<_> = FORMULAS.into_iter().chain(whole).collect();
    let u = "0.011547005383792516";
    for (sheet, id) in [
        (sheet_of(u, "0.05", "0.1"), "hard-coded"),
        (sheet_of(u, "0.033665016461206926", "0.09"), "hard-coded"),
        (
            sheet_of("0.03", "0.04358898943540673", "0.08717797887081347"),
            "hard-coded@Resolution 0.04 g",
        ),
    ] {
        assert_eq!(ids(&of_formulas(&sheet, &formulas)), [id], "{sheet}");
    }
    let sound = of_formulas(
        &sheet_of(u, "0.033665016461206926", "0.06733003292241385"),
        &formulas,
    );
    assert_eq!(audit(&sound).verdict, Verdict::Sound);
}

/// Where U is what its wrong u_c and k come to, it departs nowhere else.
#[test]
fn a_product_of_a_wrong_sum_departs_once() {
    let claimed = of_formulas(&sheet_of("0.0115", "0.0451", "0.090"), &[]);
    assert_eq!(audit(&claimed).found.gaps, [Gap::Sum]);
}

/// A formula that is not known stands in the list of what was not used, and no other figure in its place.
#[test]
fn unknown_formulas_are_listed() {
    let text =
        sheet_of("0.0115", "", "0.067").replace("uncertainty,,,\n", "uncertainty,,,,,100.02\n");
    let claimed = of_formulas(&text, &[(4, 3, "AGGREGATE(9,6,D2:D4)")]);
    assert_eq!(claimed.footer.u_c, None);
    let mut lines = claimed.unplaced.iter();
    assert!(lines.any(|line| line.text == "=AGGREGATE(9,6,D2:D4)"));
}

/// One sheet says what is known, another evaluates it; one source of three is called by more words there.
#[test]
fn sheets_of_inputs_may_call_a_source_by_more_words() {
    let of = |name: &str, u: &str, u_c: &str, expanded: &str| {
        let inputs = format!(
            "Quantity,U or half-width (mg),k / divisor,Basis\nReference weight certificate W-7,0.3,2,\"certificate, U, k=2\"\n\
             Drift,0.1,1.7321,rectangular\n{name},0.08,1,\"type A, n=10, ν=9\"\n"
        );
        let budget = format!(
            "Source,Standard uncertainty u (mg),c,c·u (mg)\nReference weight certificate W-7,{u},1,{u}\nDrift,0.0577,1,0.0577\n\
             Repeatability,0.08,1,0.08\nCombined standard uncertainty u_c,,,{u_c}\nExpanded uncertainty U (k=2),,,{expanded}\n"
        );
        let grids = [inputs, budget].map(|text| sheet::grids("sheet.csv", text.as_bytes()));
        let budgets = read::budgets(
            &grids.map(|grids| grids.unwrap().remove(0)),
            &Mapping::default(),
        );
        let [one] = budgets.as_slice() else {
            panic!("{} budgets", budgets.len());
        };
        (audit(one).verdict, ids(one))
    };
    for name in ["Repeatability", "Repeatability s of mean", "Scatter"] {
        assert_eq!(
            of(name, "0.15", "0.1795", "0.36").0,
            Verdict::Sound,
            "{name}"
        );
        let (_, slips) = of(name, "0.3", "0.3158", "0.63");
        assert_eq!(
            slips,
            ["cert-undivided@Reference weight certificate W-7"],
            "{name}"
        );
    }
}
