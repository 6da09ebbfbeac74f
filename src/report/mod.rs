//! Renderers of an evaluation: text, Markdown, JSON, and the sentence for the certificate.
