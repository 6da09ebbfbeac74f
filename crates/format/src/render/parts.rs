//! A document in its parts and sections, as pages have them: what goes on a certificate first.

use crate::document::Block;

/// What stands under one title.
#[derive(Default)]
pub struct Part<'a> {
    /// The title.
    pub title: Option<&'a str>,
    /// Blocks before the first section.
    pub head: Vec<&'a Block>,
    /// What stands under its headings.
    pub sections: Vec<Section<'a>>,
    /// Small print, which stays at the end.
    pub foot: Vec<&'a Block>,
}

/// What stands under one heading.
pub struct Section<'a> {
    /// The heading.
    pub heading: &'a str,
    /// What stands under it.
    pub blocks: Vec<&'a Block>,
}

impl Section<'_> {
    fn is_statement(&self) -> bool {
        let statement = |block: &&Block| matches!(block, Block::Statement(_));
        self.blocks.iter().any(statement)
    }
}

/// The blocks in their parts and sections, in each part those with the statement first.
pub fn parts(blocks: &[Block]) -> Vec<Part<'_>> {
    let mut parts: Vec<Part<'_>> = vec![Part::default()];
    for block in blocks {
        let begun = !parts.iter().all(|p| p.title.is_none() && p.head.is_empty());
        if let (Block::Title(_), true) = (block, begun) {
            parts.push(Part::default());
        }
        let Some(part) = parts.last_mut() else {
            continue;
        };
        match block {
            Block::Title(title) => part.title = Some(title),
            Block::Section(heading) => part.sections.push(Section {
                heading,
                blocks: Vec::new(),
            }),
            Block::Footer(_) => part.foot.push(block),
            other => match part.sections.last_mut() {
                Some(section) => section.blocks.push(other),
                None => part.head.push(other),
            },
        }
    }
    for part in &mut parts {
        part.sections.sort_by_key(|section| !section.is_statement());
    }
    parts
}
