"use strict";
// Completion at the caret: keys, words of keys, units, functions and names, from the schemas of the program.

const complete = { words: null, language: null, offers: [], at: 0, from: 0, chosen: false };
const MOST_OFFERS = 40; // a list that is still read; another letter shortens it

async function vocabulary() {
  if (complete.language !== language) {
    complete.language = language;
    const response = await ask("vocabulary").catch(() => null);
    complete.words = response && response.ok ? await response.json() : null;
  }
  return complete.words;
}

/// Where the caret is in a TOML text: the table or the key with its path, and what was begun there.
function place(content) {
  const stack = [];
  let head = [], key = "", path = [], isValue = false, at = 0;
  const parts = name => name.trim().replace(/["']/g, "").split(".").map(part => part.trim()).filter(Boolean);
  const base = () => stack.length ? stack[stack.length - 1].path : head;
  while (at < content.length) {
    const c = content[at];
    if (c === "#") {
      const end = content.indexOf("\n", at);
      if (end < 0) return null; // in a comment nothing is completed
      at = end;
      continue;
    }
    if (isValue && (c === '"' || c === "'")) {
      const quote = content.startsWith(c.repeat(3), at) ? c.repeat(3) : c;
      let end = at + quote.length;
      while (end < content.length && !content.startsWith(quote, end)) end += c === '"' && content[end] === "\\" ? 2 : 1;
      if (end >= content.length) return { kind: "text", path, begun: content.slice(at + quote.length) };
      at = end + quote.length;
      continue;
    }
    if (!isValue && !stack.length && c === "[" && !key.trim()) {
      const end = content.slice(at).search(/[\]\n]/);
      if (end < 0) return { kind: "head", begun: content.slice(at).replace(/^\[+/, ""), path: [] };
      head = parts(content.slice(at, at + end).replace(/^\[+/, ""));
      at += end;
      while (content[at] === "]") at += 1;
      key = "";
      continue;
    }
    if (!isValue && c === "=") { path = [...base(), ...parts(key)]; isValue = true; key = ""; }
    else if (isValue && (c === "{" || c === "[")) { stack.push({ brace: c === "{", path }); isValue = c === "["; key = ""; }
    else if (stack.length && (c === "}" || c === "]")) { path = stack.pop().path; isValue = true; }
    else if (stack.length && c === ",") { const top = stack[stack.length - 1]; isValue = !top.brace; path = top.path; key = ""; }
    else if (c === "\n") { if (!stack.length) isValue = false; key = isValue ? key : ""; }
    else if (!isValue) key += c;
    at += 1;
  }
  return isValue ? { kind: "value", path, begun: "" } : { kind: "key", path: base(), begun: key.trimStart() };
}

/// The place of a path in a schema.
function described(schema, path) {
  return path.reduce((there, name) => there && ((there.keys || {})[name] || there.any), schema);
}

/// Names that a formula may use: those that the text gives to quantities.
function names(content) {
  const found = new Set();
  for (const [, name] of content.matchAll(/^\s*\[+(?:input|constant|parameter|fit|columns|measurand)\.([^\].]+)/gm)) found.add(name.trim());
  let inside = false;
  for (const line of content.split("\n")) {
    const head = line.match(/^\s*\[+([^\]]*)\]/);
    if (head) inside = ["input", "constant", "columns"].includes(head[1].trim());
    const key = line.match(/^\s*([\p{L}_][\p{L}\p{N}_]*)\s*=/u);
    if (inside && key) found.add(key[1]);
  }
  return [...found];
}

const FORMULAS = ["model", "equations", "formula", "term"], UNITS = ["unit", "like"];

/// What may stand at the caret: text to write, what it says, and how much of it is there already.
function offers(words, content, caret) {
  const there = place(content.slice(0, caret));
  if (!there) return [];
  const schema = /^\s*\[+\s*measurand/m.test(content) || !/^\s*(recording|equations|procedure)\b/m.test(content) ? words.budget : words.experiment;
  const like = (list, begun) => {
    const low = begun.toLowerCase();
    const fitting = list.filter(([name]) => name.toLowerCase().startsWith(low) && name !== begun);
    return fitting.slice(0, MOST_OFFERS).map(([name, says, text]) => ({ name, says: says || "", text: text || name, length: begun.length }));
  };
  const one = described(schema, there.path) || {}, last = there.path[there.path.length - 1];
  if (there.kind === "key") {
    return like(Object.entries(one.keys || {}).map(([name, inner]) => [name, inner.says, name + " = "]), there.begun);
  }
  if (there.kind === "head") {
    const tables = Object.entries(schema.keys).filter(([, inner]) => inner.keys || inner.any);
    return like(tables.map(([name, inner]) => [name, inner.says, name + (inner.any ? "." : "")]), there.begun);
  }
  if (there.kind === "value") {
    return like((one.words || []).filter(word => typeof word === "string").map(name => [name, "", `"${name}"`]), "");
  }
  const begun = /[\p{L}\p{N}_µ°%Ω′″]*$/u.exec(there.begun)[0];
  if (FORMULAS.includes(last)) {
    if (!begun || /^\d/.test(begun)) return [];
    const functions = words.functions.map(([name, signature, doc]) => [name, `${signature}: ${doc}`, name + "("]);
    return like([...names(content).map(name => [name, ""]), ...functions], begun);
  }
  if (one.words) return like(one.words.filter(word => typeof word === "string").map(name => [name, ""]), there.begun);
  // A unit by itself, or behind a number.
  const ofUnit = UNITS.includes(last) || /^[-+−]?[\d.]+(e[-+]?\d+)?\s+/i.test(there.begun);
  return ofUnit ? like(words.units, begun) : [];
}

function closeOffers() {
  complete.offers = [];
  $("offers").hidden = true;
  text.removeAttribute("aria-activedescendant");
}

/// Shows what may stand at the caret, below it.
async function offer(asked) {
  const words = await vocabulary();
  const caret = text.selectionStart;
  if (!words || caret !== text.selectionEnd) { closeOffers(); return; }
  const found = offers(words, text.value, caret);
  // By itself only where something was begun.
  complete.offers = asked || found.some(one => one.length > 0) ? found : [];
  complete.chosen = asked;
  complete.at = 0;
  if (!complete.offers.length) { closeOffers(); if (asked) say(word("noOffers")); return; }
  $("offers").replaceChildren(...complete.offers.map((one, at) => {
    const item = document.createElement("li"), name = document.createElement("b");
    item.id = `offer-${at}`;
    item.setAttribute("role", "option");
    name.textContent = one.name;
    item.append(name, one.says ? " " + one.says : "");
    item.addEventListener("mousedown", event => { event.preventDefault(); complete.at = at; take(); });
    return item;
  }));
  const lines = text.value.slice(0, caret).split("\n"), style = getComputedStyle(text), line = parseFloat(style.lineHeight);
  const ruler = document.createElement("canvas").getContext("2d");
  ruler.font = style.font;
  const left = ruler.measureText(lines[lines.length - 1]).width + 10 - text.scrollLeft;
  const below = lines.length * line + 8 - text.scrollTop, room = $("field").clientHeight - below;
  const list = $("offers");
  list.hidden = false;
  list.style.left = `${Math.max(0, Math.min(left, $("field").clientWidth - list.offsetWidth))}px`;
  list.style.top = `${room > list.offsetHeight ? below : Math.max(0, below - line - list.offsetHeight)}px`;
  point(0);
  say(word("offered", complete.offers.length));
}

function point(at) {
  const list = $("offers"), count = complete.offers.length;
  complete.at = (at + count) % count;
  for (const [index, item] of [...list.children].entries()) item.setAttribute("aria-selected", index === complete.at);
  text.setAttribute("aria-activedescendant", `offer-${complete.at}`);
  list.children[complete.at].scrollIntoView({ block: "nearest" });
}

/// Writes the chosen one, as if it had been typed: it can be undone.
function take() {
  const { text: written, length } = complete.offers[complete.at], caret = text.selectionStart;
  closeOffers();
  text.focus();
  text.setSelectionRange(caret - length, caret);
  complete.taking = true;
  document.execCommand("insertText", false, written);
  complete.taking = false;
}

text.addEventListener("input", event => {
  if (complete.taking) return;
  if (event.inputType === "insertText" && !event.isComposing) offer(false); else closeOffers();
});
text.addEventListener("blur", closeOffers);
text.addEventListener("click", closeOffers);
text.addEventListener("keydown", event => {
  if (event.ctrlKey && event.code === "Space") { event.preventDefault(); offer(true); return; }
  if (!complete.offers.length || event.isComposing) return;
  const own = () => event.preventDefault();
  if (event.key === "ArrowDown") { own(); complete.chosen = true; point(complete.at + 1); }
  else if (event.key === "ArrowUp") { own(); complete.chosen = true; point(complete.at - 1); }
  else if (event.key === "Tab" && !event.shiftKey || event.key === "Enter" && complete.chosen) { own(); take(); }
  else if (event.key === "Escape") { own(); closeOffers(); }
  else if (["ArrowLeft", "ArrowRight", "Home", "End", "Enter"].includes(event.key)) closeOffers();
});
