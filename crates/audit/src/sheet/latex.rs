//! Formulas in texts, `$\nu_\mathrm{eff}$`, as they are read.

/// What stands for a command of LaTeX; longer names in front of those they begin with.
const COMMANDS: [(&str, &str); 36] = [
    ("\\times", "×"),
    ("\\cdot", "·"),
    ("\\pm", "±"),
    ("\\approx", "≈"),
    ("\\infty", "∞"),
    ("\\sqrt", "√"),
    ("\\partial", "∂"),
    ("\\alpha", "α"),
    ("\\beta", "β"),
    ("\\gamma", "γ"),
    ("\\delta", "δ"),
    ("\\Delta", "Δ"),
    ("\\eta", "η"),
    ("\\theta", "θ"),
    ("\\vartheta", "ϑ"),
    ("\\kappa", "κ"),
    ("\\lambda", "λ"),
    ("\\mu", "µ"),
    ("\\nu", "ν"),
    ("\\rho", "ρ"),
    ("\\sigma", "σ"),
    ("\\tau", "τ"),
    ("\\varphi", "φ"),
    ("\\phi", "φ"),
    ("\\omega", "ω"),
    ("\\Omega", "Ω"),
    ("^\\circ", "°"),
    ("\\circ", "°"),
    ("\\left", ""),
    ("\\right", ""),
    ("\\mathrm", ""),
    ("\\text", ""),
    ("\\quad", " "),
    ("\\,", " "),
    ("\\;", " "),
    ("\\%", "%"),
];

/// A text with its formulas between signs of dollars as plain text.
pub(super) fn plain(text: &str) -> String {
    let mut out = String::new();
    // Every second part stands between two signs.
    for (place, part) in text.split('$').enumerate() {
        match place % 2 {
            1 => out += &formula(part),
            _ => out += part,
        }
    }
    out
}

fn formula(text: &str) -> String {
    let plain = COMMANDS
        .iter()
        .fold(text.to_owned(), |text, (command, sign)| {
            text.replace(command, sign)
        });
    // `√{3}` is a root, and `ν_{eff}` an index.
    let plain = plain.replace("√{", "√\u{1}");
    let mut out = String::new();
    let mut closes: Vec<Option<char>> = Vec::new();
    let mut before = ' ';
    for c in plain.chars() {
        match c {
            '{' => closes.push((before == '^').then_some('}')),
            '\u{1}' => {
                out.push('(');
                closes.push(Some(')'));
            }
            '}' => out.extend(closes.pop().flatten().filter(|close| *close == ')')),
            _ => out.push(c),
        }
        before = c;
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formulas_are_plain_texts() {
        for (text, own) in [
            ("$\\nu_i$", "ν_i"),
            ("$\\nu_\\mathrm{eff}$ = 9", "ν_eff = 9"),
            ("$\\nu_{\\text{eff}}$", "ν_eff"),
            ("$\\sqrt{3}$", "√(3)"),
            ("$u_c$ / mg", "u_c / mg"),
            (
                "$U=k u_c=2\\times 0.206=0.41$ mV",
                "U=k u_c=2× 0.206=0.41 mV",
            ),
            ("$10^{-6}$", "10^-6"),
            ("C:\\nu costs 5", "C:\\nu costs 5"),
        ] {
            assert_eq!(plain(text), own, "{text}");
        }
    }
}
