//! Sealed budgets as a folder: what is handed out, and what is kept.

use std::path::Path;

use gumption_fault::of_system;
use gumption_format::files::Files;

use super::case::{Sheet, SheetTruth, sheet};
use crate::grade::Refused;
use crate::truth::{salt, seal};

/// The file that is handed out beside the budgets and holds the seal of the truth.
const NOTE: &str = "SEAL.md";

/// The format that this version writes.
const FORMAT: &str = "gumption audit truth 1";

/// Budgets, and the truth about them.
#[derive(Debug, Clone, PartialEq)]
pub struct SealedSheets {
    /// Files to hand out: name and content.
    pub files: Vec<(String, Vec<u8>)>,
    /// The text of `truth.json`.
    pub truth_text: String,
}

/// What `truth.json` of sealed budgets holds.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct SheetsTruth {
    /// Name and version of this format.
    pub format: String,
    /// Random, so that nobody finds the truth by trying.
    pub salt: String,
    /// The seed of the challenge.
    pub seed: u64,
    /// The budgets.
    pub sheets: Vec<SealedSheet>,
}

/// One budget of them.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct SealedSheet {
    /// Its file.
    pub file: String,
    /// SHA-256 of the file.
    pub sha256: String,
    /// What is concealed in it.
    #[serde(flatten)]
    pub truth: SheetTruth,
}

impl SheetsTruth {
    /// The truth about budgets of a seed, with the salt that the seed alone gives.
    pub fn of(seed: u64, sheets: Vec<SealedSheet>) -> SheetsTruth {
        SheetsTruth {
            format: FORMAT.into(),
            salt: salt(seed, 0),
            seed,
            sheets,
        }
    }
}

impl SealedSheet {
    /// A budget under the name of its file.
    pub fn new(file: String, sheet: Sheet) -> SealedSheet {
        SealedSheet {
            file,
            sha256: seal(&sheet.bytes),
            truth: sheet.truth,
        }
    }
}

/// So many budgets of a seed. `entropy` is mixed into the salt, so that a seed alone does not give the truth.
pub fn sealed_sheets(seed: u64, entropy: u64, count: u64) -> SealedSheets {
    let digits = count.to_string().len().max(2);
    let (mut files, mut sheets) = (Vec::new(), Vec::new());
    for number in 1..=count {
        let sheet = sheet(seed, number);
        let file = format!("budget-{number:0digits$}.{}", sheet.ending);
        files.push((file.clone(), sheet.bytes.clone()));
        sheets.push(SealedSheet::new(file, sheet));
    }
    let truth = SheetsTruth {
        salt: salt(seed, entropy),
        ..SheetsTruth::of(seed, sheets)
    };
    // A struct of numbers and strings can always be written.
    let truth_text =
        serde_json::to_string_pretty(&truth).map_or_else(|_| String::new(), |t| t + "\n");
    files.push((NOTE.into(), note(&seal(&truth_text)).into_bytes()));
    SealedSheets { files, truth_text }
}

fn note(seal: &str) -> String {
    format!(
        "# Claimed budgets

Some of these budgets are sound, some have a slip or two in them, some have figures that nothing explains. Say of each what it is:

```json
[{{\"file\": \"budget-01.csv\", \"verdict\": \"slips\", \"candidates\": [[\"s-not-mean@dm\"], [\"k-twice\"]], \"u_c\": 0.0123, \"U\": 0.025}}]
```

`verdict` is `sound`, `slips` or `unexplained`; `candidates` are sets of slips, best first, `@` and the symbol of the row where one sits in a row;
`u_c` and `U` are the right ones. `gumption explain slips` lists their names.

这些不确定度评定中，有的正确，有的含一处或两处差错，有的数值无法解释。请按以上格式作答；`gumption explain slips` 列出差错的名称。

The truth is sealed in truth.json, which has the SHA-256
{seal}
"
    )
}

/// Reads the truth of a folder of sealed budgets, and makes sure that neither it nor the budgets were changed since.
///
/// # Errors
/// When a file is missing, or a seal does not hold.
pub fn sealed_sheets_truth(folder: &Path) -> Result<SheetsTruth, Refused> {
    let read = |path: std::path::PathBuf| {
        let bytes = Files::Disk.read(&path);
        bytes.map_err(|error| Refused::Unreadable(path, of_system(&error)))
    };
    let (truth_path, handed_out) = (folder.join("truth.json"), folder.join("case"));
    let truth_text = read(truth_path.clone())?;
    let note = read(handed_out.join(NOTE))?;
    if !String::from_utf8_lossy(&note).contains(&seal(&truth_text)) {
        return Err(Refused::BrokenSeal);
    }
    let truth: SheetsTruth = serde_json::from_slice(&truth_text)
        .map_err(|error| Refused::Unreadable(truth_path, error.to_string().into()))?;
    for sheet in &truth.sheets {
        if seal(read(handed_out.join(&sheet.file))?) != sheet.sha256 {
            return Err(Refused::Changed(sheet.file.clone()));
        }
    }
    Ok(truth)
}
