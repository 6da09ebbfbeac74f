//! A working on paper.
//!
//! | chapter | holds |
//! |---|---|
//! | `cell` | pages of cells |
//! | `layout` | the layouts in which laboratories keep their sheets |
//! | `writer` | who writes a page, and in which manner |
//! | `lines` | lines above and below a table |
//! | `table` | the table |
//! | `closing` | the claim |

mod cell;
mod closing;
mod layout;
mod lines;
mod table;
mod writer;

use super::laboratory::Budget;
use super::working::Working;

pub(super) use cell::{Cell, Page};
pub(super) use layout::{Form, Manner, manner};

use cell::{text, turned};
use layout::Part;
use writer::Writer;

/// The pages of a working.
pub(super) fn pages(budget: &Budget, working: &Working, manner: Manner) -> Vec<Page> {
    let figures = working.figures();
    let writer = Writer {
        budget,
        working,
        figures: &figures,
        manner,
    };
    let mut pages = Vec::new();
    let mut page = writer.opening();
    for part in manner.form.parts(budget.is_sum()) {
        match part {
            Part::Table(columns) => writer.table(&mut page, columns),
            Part::Turned(columns) => {
                let mut upright = Page::default();
                writer.table(&mut upright, columns);
                page.rows.push(Vec::new());
                page.rows.extend(turned(&upright.rows));
            }
            Part::Result => writer.result_row(&mut page),
            Part::Footer(columns) => writer.inside_footer(&mut page, columns),
            Part::Claims => writer.claims(&mut page),
            Part::Notes => writer.notes(&mut page),
            Part::Page => {
                page.name = writer.pick("Inputs", "输入量").into();
                pages.push(page);
                page = evaluation(&writer);
            }
        }
    }
    if pages.is_empty() && manner.variant % 6 == 2 {
        writer.approval(&mut page);
    }
    pages.push(page);
    pages
}

/// The second page of a budget in two tables.
fn evaluation(writer: &Writer<'_>) -> Page {
    let title = writer.pick("Evaluation of the uncertainty", "不确定度合成");
    Page {
        name: writer.pick("Evaluation", "评定").into(),
        rows: vec![vec![text(title)], Vec::new()],
    }
}
