//! Elements of XML as values.

use std::io;

use quick_xml::Writer;
use quick_xml::events::{BytesDecl, BytesText, Event};

/// An element.
#[derive(Debug, Clone)]
pub(crate) struct Element {
    name: &'static str,
    attributes: Vec<(&'static str, String)>,
    content: Vec<Content>,
}

#[derive(Debug, Clone)]
enum Content {
    Element(Element),
    Text(String),
}

/// An element without content.
pub(crate) fn element(name: &'static str) -> Element {
    Element {
        name,
        attributes: Vec::new(),
        content: Vec::new(),
    }
}

/// An element with text.
pub(crate) fn text(name: &'static str, text: impl Into<String>) -> Element {
    let mut made = element(name);
    made.content.push(Content::Text(known(&text.into())));
    made
}

/// Of control characters XML 1.0 knows three, and not these two.
fn known(text: &str) -> String {
    let known = |c: char| match c {
        '\t' | '\n' | '\r' => true,
        '\u{fffe}' | '\u{ffff}' => false,
        other => !other.is_control(),
    };
    let text = text.chars();
    text.map(|c| if known(c) { c } else { '\u{fffd}' })
        .collect()
}

impl Element {
    /// With an attribute.
    pub fn attribute(mut self, name: &'static str, value: impl Into<String>) -> Self {
        self.attributes.push((name, known(&value.into())));
        self
    }

    /// With an element inside.
    pub fn with(mut self, inside: Element) -> Self {
        self.content.push(Content::Element(inside));
        self
    }

    /// With elements inside.
    pub fn with_all(mut self, inside: impl IntoIterator<Item = Element>) -> Self {
        self.content
            .extend(inside.into_iter().map(Content::Element));
        self
    }

    /// The document with this element for its root.
    pub fn document(&self) -> io::Result<Vec<u8>> {
        let mut writer = Writer::new_with_indent(Vec::new(), b' ', 2);
        writer.write_event(Event::Decl(BytesDecl::new("1.0", Some("UTF-8"), None)))?;
        self.write(&mut writer)?;
        let mut bytes = writer.into_inner();
        bytes.push(b'\n');
        Ok(bytes)
    }

    fn write(&self, writer: &mut Writer<Vec<u8>>) -> io::Result<()> {
        let attributes = self.attributes.iter();
        let attributes = attributes.map(|(name, value)| (*name, value.as_str()));
        let element = writer.create_element(self.name).with_attributes(attributes);
        match self.content.as_slice() {
            [] => element.write_empty()?,
            [Content::Text(text)] => element.write_text_content(BytesText::new(text))?,
            content => element.write_inner_content(|writer| {
                content.iter().try_for_each(|one| match one {
                    Content::Element(element) => element.write(writer),
                    Content::Text(text) => writer.write_event(Event::Text(BytesText::new(text))),
                })
            })?,
        };
        Ok(())
    }
}
