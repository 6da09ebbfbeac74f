//! The calibrations of `calibrations/` against the values that their readings were made with, closed forms
//! and independent solutions.

use std::path::{Path, PathBuf};

use gumption::calibrate::{Calibration, Coefficient, Purpose, calibrate, load};

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("calibrations")
}

#[test]
fn scratch() {
    let mut files: Vec<PathBuf> = std::fs::read_dir(folder())
        .unwrap()
        .map(|e| e.unwrap().path())
        .filter(|p| p.extension().is_some_and(|e| e == "toml"))
        .collect();
    files.sort();
    for file in files {
        println!("=== {}", file.display());
        let plan = file.to_string_lossy().contains("plan");
        match load(
            &file,
            if plan {
                Purpose::Plan
            } else {
                Purpose::Calibrate
            },
        ) {
            Err(r) => println!("{}", r.render(false)),
            Ok(e) if plan => match gumption::calibrate::plan(&e) {
                Ok(p) => println!("{p:#?}"),
                Err(t) => println!("{t:?}"),
            },
            Ok(e) => match calibrate(&e) {
                Err(t) => println!("{t:?}"),
                Ok(c) => {
                    for k in &c.figures.coefficients {
                        println!(
                            "{} = {} u {:.3e} {} dof {:.1}",
                            k.name, k.value, k.u, k.unit.symbol, k.dof
                        );
                    }
                    println!("id {:?}", c.identifiability);
                    for a in &c.aliases {
                        println!("alias {} visible {:.3} {:?}", a.name, a.visible, a.shifts);
                    }
                }
            },
        }
    }
}
