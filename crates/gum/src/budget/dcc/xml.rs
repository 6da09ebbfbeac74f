//! Elements of a certificate by their local names, and faults at their places in it.

use std::ops::Range;

use gumption_fault::{Fault, Said, say};
use roxmltree::Node;

use crate::budget::faults::DIGITAL_CERTIFICATE;

/// What is wrong with the file, at its places.
pub(super) type Faults = Vec<Fault>;

/// The children of this name.
pub(super) fn children<'a, 'i>(
    node: Node<'a, 'i>,
    name: &'static str,
) -> impl Iterator<Item = Node<'a, 'i>> {
    node.children()
        .filter(move |child| child.is_element() && child.tag_name().name() == name)
}

/// The first child of this name.
pub(super) fn child<'a, 'i>(node: Node<'a, 'i>, name: &'static str) -> Option<Node<'a, 'i>> {
    children(node, name).next()
}

/// The element at the end of a path.
pub(super) fn at<'a, 'i>(node: Node<'a, 'i>, path: &[&'static str]) -> Option<Node<'a, 'i>> {
    path.iter().try_fold(node, |node, name| child(node, name))
}

/// The text of an element, without white space at its ends.
pub(super) fn text<'a>(node: Node<'a, '_>) -> &'a str {
    node.text().unwrap_or_default().trim()
}

/// A fault at an element.
pub(super) fn fault(node: Node<'_, '_>, message: Said) -> Fault {
    Fault::new(DIGITAL_CERTIFICATE, place(node), message)
}

/// Where the text of an element stands; the element itself where it has none.
pub(super) fn place(node: Node<'_, '_>) -> Range<usize> {
    let inside = node.first_child().filter(Node::is_text);
    inside.map_or_else(|| node.range(), |text| text.range())
}

/// The numbers of a list, or the one number of an element. `NaN` says that a number is not stated.
pub(super) fn numbers(node: Node<'_, '_>, faults: &mut Faults) -> Vec<Option<f64>> {
    let words = text(node).split_whitespace();
    let read = words.map(|word| match word {
        "NaN" => None,
        word => match word.parse::<f64>() {
            Ok(number) if number.is_finite() => Some(number),
            _ => {
                let name = node.tag_name().name();
                let message = say!("`{word}` is not a number, in {name}");
                let fault = fault(node, message);
                faults.push(fault.label(say!("expected decimal digits with a point")));
                None
            }
        },
    });
    read.collect()
}
