//! Fonts of the system: one for letters of the Latin and Greek alphabets and signs, one for Chinese, and what glyphs they
//! have. They are embedded, so that a document looks the same everywhere.

use std::cell::RefCell;
use std::collections::{BTreeMap, HashMap};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use krilla::text::Font;
use skrifa::instance::{LocationRef, Size};
use skrifa::string::StringId;
use skrifa::{FontRef, MetadataProvider};

use gumption_format::files::Files;

/// Where a text stands out.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Style {
    Regular,
    Bold,
    Mono,
}

/// Files of one family: regular, bold, of equal widths.
type Family = [&'static str; 3];

/// Families with Latin, Greek and the signs of mathematics, those that hold most signs first.
const LATIN: &[Family] = &[
    [
        "DejaVuSans.ttf",
        "DejaVuSans-Bold.ttf",
        "DejaVuSansMono.ttf",
    ],
    [
        "NotoSans-Regular.ttf",
        "NotoSans-Bold.ttf",
        "NotoSansMono-Regular.ttf",
    ],
    [
        "LiberationSans-Regular.ttf",
        "LiberationSans-Bold.ttf",
        "LiberationMono-Regular.ttf",
    ],
    ["segoeui.ttf", "segoeuib.ttf", "consola.ttf"],
    ["arial.ttf", "arialbd.ttf", "cour.ttf"],
    ["Arial.ttf", "Arial Bold.ttf", "Courier New.ttf"],
];

/// Families with Chinese.
const CHINESE: &[Family] = &[
    [
        "NotoSansCJK-Regular.ttc",
        "NotoSansCJK-Bold.ttc",
        "NotoSansCJK-Regular.ttc",
    ],
    [
        "NotoSansCJKsc-Regular.otf",
        "NotoSansCJKsc-Bold.otf",
        "NotoSansCJKsc-Regular.otf",
    ],
    [
        "SourceHanSansSC-Regular.otf",
        "SourceHanSansSC-Bold.otf",
        "SourceHanSansSC-Regular.otf",
    ],
    [
        "NotoSerifCJK-Regular.ttc",
        "NotoSerifCJK-Bold.ttc",
        "NotoSerifCJK-Regular.ttc",
    ],
    ["wqy-microhei.ttc", "wqy-microhei.ttc", "wqy-microhei.ttc"],
    ["wqy-zenhei.ttc", "wqy-zenhei.ttc", "wqy-zenhei.ttc"],
    ["msyh.ttc", "msyhbd.ttc", "msyh.ttc"],
    ["simhei.ttf", "simhei.ttf", "simhei.ttf"],
    ["simsun.ttc", "simsun.ttc", "simsun.ttc"],
    ["PingFang.ttc", "PingFang.ttc", "PingFang.ttc"],
    [
        "STHeiti Light.ttc",
        "STHeiti Medium.ttc",
        "STHeiti Light.ttc",
    ],
    [
        "Hiragino Sans GB.ttc",
        "Hiragino Sans GB.ttc",
        "Hiragino Sans GB.ttc",
    ],
];

/// Names a folder of fonts that is looked at before those of the system.
const FOLDER: &str = "GUMPTION_FONTS";

/// The faces of a document.
pub(super) struct Fonts {
    pub faces: Vec<Face>,
    /// For each style the faces in the order in which they are asked for a glyph.
    chains: [Vec<usize>; 3],
}

/// A face with its data.
pub(super) struct Face {
    pub font: Font,
    data: Arc<Vec<u8>>,
    index: u32,
    /// Glyphs and their advance as a part of the size.
    known: RefCell<HashMap<char, Option<(u32, f32)>>>,
}

/// A glyph of a face.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Found {
    pub face: usize,
    pub glyph: u32,
    /// Its advance as a part of the size.
    pub advance: f32,
}

impl Fonts {
    /// The fonts of the system; `None` where there is none of the known families.
    pub(super) fn of_the_system() -> Option<Self> {
        let files = files();
        let mut fonts = Fonts {
            faces: Vec::new(),
            chains: Default::default(),
        };
        for families in [LATIN, CHINESE] {
            let family = families.iter().find(|family| files.contains_key(family[0]));
            let Some(family) = family else {
                continue;
            };
            for (style, name) in family.iter().enumerate() {
                let path = files.get(*name).or_else(|| files.get(family[0]));
                if let Some(face) = path.and_then(|path| fonts.face(path)) {
                    fonts.chains[style].push(face);
                }
            }
        }
        // Signs that one style lacks another may have.
        let regular = fonts.chains[0].clone();
        for chain in &mut fonts.chains[1..] {
            chain.extend(&regular);
        }
        (!regular.is_empty()).then_some(fonts)
    }

    /// The face of a file, which is read once.
    fn face(&mut self, path: &Path) -> Option<usize> {
        let data = Arc::new(Files::Disk.read(path).ok()?);
        let index = simplified(&data);
        let font = Font::new(Arc::clone(&data).into(), index)?;
        self.faces.push(Face {
            font,
            data,
            index,
            known: RefCell::default(),
        });
        Some(self.faces.len() - 1)
    }

    /// The glyph of a character in the first face that has it.
    pub(super) fn glyph(&self, style: Style, character: char) -> Option<Found> {
        let chain = &self.chains[style as usize];
        chain.iter().find_map(|face| {
            let (glyph, advance) = self.faces[*face].glyph(character)?;
            Some(Found {
                face: *face,
                glyph,
                advance,
            })
        })
    }
}

impl Face {
    fn glyph(&self, character: char) -> Option<(u32, f32)> {
        let mut known = self.known.borrow_mut();
        *known.entry(character).or_insert_with(|| {
            let font = FontRef::from_index(&self.data, self.index).ok()?;
            let glyph = font.charmap().map(character)?;
            let metrics = font.glyph_metrics(Size::unscaled(), LocationRef::default());
            let advance = metrics.advance_width(glyph)?;
            let size = f32::from(
                font.metrics(Size::unscaled(), LocationRef::default())
                    .units_per_em,
            );
            (glyph.to_u32() != 0).then(|| (glyph.to_u32(), advance / size))
        })
    }
}

/// The face of a collection that has the forms of simplified Chinese.
fn simplified(data: &[u8]) -> u32 {
    /// More faces has no collection.
    const MOST: u32 = 64;
    let is = |index: &u32| {
        let Ok(font) = FontRef::from_index(data, *index) else {
            return false;
        };
        let mut names = font.localized_strings(StringId::FAMILY_NAME);
        names.any(|name| {
            let name = name.to_string();
            name.ends_with(" SC") || name.contains("GB")
        })
    };
    let exists = |index: &u32| FontRef::from_index(data, *index).is_ok();
    (0..MOST).take_while(exists).find(is).unwrap_or(0)
}

/// Font files by their names, each at the first place where it is found.
fn files() -> BTreeMap<String, PathBuf> {
    let home = std::env::var_os("HOME").map(PathBuf::from);
    let of_home = |below: &str| home.as_ref().map(|home| home.join(below));
    let windows = std::env::var_os("WINDIR").map(|root| PathBuf::from(root).join("Fonts"));
    let folders = [
        std::env::var_os(FOLDER).map(PathBuf::from),
        Some("/usr/share/fonts".into()),
        Some("/usr/local/share/fonts".into()),
        of_home(".local/share/fonts"),
        of_home(".fonts"),
        of_home("Library/Fonts"),
        Some("/Library/Fonts".into()),
        Some("/System/Library/Fonts".into()),
        windows,
    ];
    let mut files = BTreeMap::new();
    for folder in folders.into_iter().flatten() {
        walk(&folder, 0, &mut files);
    }
    files
}

fn walk(folder: &Path, depth: usize, files: &mut BTreeMap<String, PathBuf>) {
    /// Folders of fonts are not nested deeper.
    const DEEPEST: usize = 5;
    let Ok(entries) = std::fs::read_dir(folder) else {
        return;
    };
    let mut paths: Vec<PathBuf> = entries.flatten().map(|entry| entry.path()).collect();
    paths.sort();
    for path in paths {
        if path.is_dir() {
            if depth < DEEPEST {
                walk(&path, depth + 1, files);
            }
        } else if let Some(name) = path.file_name().and_then(|name| name.to_str()) {
            files.entry(name.to_owned()).or_insert(path);
        }
    }
}
