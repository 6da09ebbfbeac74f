"use strict";
// The form: the entries of the file as fields and rows, made from the keys that the program tells. An edit changes one place of the text.

const form = {
  on: false,
  entries: null, // what the text states; null where it has a fault
  shown: null, // what it stated last
  path: null, // the file of which it is
  schema: null, // keys of a budget or an experiment
  units: [],
  faults: [],
  open: new Set(), // keys without a value that are shown: asked for, or an uncertainty that is to be stated in another way
  ways: new Map(), // table → the way that was chosen for it and has no figure yet
  focus: null, // what is focused when the form is drawn again
  past: [], // texts before the edits that were made here
  queue: Promise.resolve(),
};
// Keys that are shown before they have a value, by the table in which they stand.
const USUAL = {
  "": ["title", "profile", "measurand", "input", "correlation"],
  measurand: ["description", "model", "unit"], input: ["description", "value", "unit"],
  components: ["name"], correlation: ["between", "r"], source: ["description", "unit"],
};
const MOST_USUAL = 4; // of other tables: a line of fields
const OF_UNCERTAINTY = ["distribution", "dof"]; // … and of an uncertainty

const keyOf = path => JSON.stringify(path);
const last = path => path[path.length - 1];

/// The table of a schema whose keys stand at a path: of a row, the one that holds it.
const tableOf = path => [...path].reverse().find((step, at) => typeof step === "string" && (at > 0 || path.length < 2)) || "";

function made(name, attributes = {}, ...children) {
  const element = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) {
    if (key in element && typeof value !== "string") element[key] = value; else element.setAttribute(key, value);
  }
  element.append(...children);
  return element;
}

// ---- the server ------------------------------------------------------------------------------------------------

/// Makes edits, and draws what the text then states.
function edit(edits, focus = null) {
  form.queue = form.queue.then(async () => {
    if (!form.on || state.path === null) return;
    const response = await ask("form", { edits }, [["text", written()]]).catch(() => null);
    if (!response) { say(word("lost")); return; }
    if (!response.ok) { const why = await told(response); draw(); say(why); return; }
    const words = await vocabulary(), found = await response.json();
    form.entries = found.form && found.form.entries;
    if (form.path !== state.path) Object.assign(form, { shown: null, path: state.path, past: [] });
    form.shown = form.entries || form.shown;
    if (words) { form.schema = words[found.form ? found.form.kind : "budget"]; form.units = words.units; }
    form.focus = focus || form.focus;
    if (found.text !== written()) {
      form.past.push(written());
      changed(found.text);
    }
    draw();
  });
  return form.queue;
}

/// Takes a text over as if its difference had been typed.
function changed(content) {
  state.crlf = /\r\n/.test(content);
  text.value = content.replaceAll("\r\n", "\n");
  mark([]);
  form.faults = [];
  soon();
}

/// Takes the last edit of the form back.
function undo() {
  if (!form.past.length) return;
  changed(form.past.pop());
  formStale();
}

function formFaults(faults) {
  form.faults = faults;
  if (form.on) showFaults();
}

/// Another text, or another language. What was edited in the text itself is undone there.
function formStale(isTyped = false) {
  if (isTyped) form.past = [];
  if (!form.on) return;
  form.open.clear();
  form.ways.clear();
  edit([]);
}

function showView(asForm) {
  form.on = asForm;
  document.body.classList.toggle("form", asForm);
  $("form").hidden = $("undo").hidden = !asForm;
  $("as-form").setAttribute("aria-pressed", asForm);
  $("as-text").setAttribute("aria-pressed", !asForm);
  formStale();
}

// ---- fields ----------------------------------------------------------------------------------------------------

/// What a key is, in a few words; all that it says is the title.
function brief(inner) {
  // What it is for (`Way: …`) is told by where it stands.
  const says = inner.says || "", isFor = inner.way || inner.with;
  const rest = isFor ? says.replace(/^[^:：]*[:：]\s*/, "") : says;
  return rest.split(/[;；。:：(（]|[.,，]\s|\.$/)[0].trim();
}

const isPlain = node => node.text !== undefined;
const isList = node => node.items && node.items.every(isPlain);
const shownText = node => !node ? "" : isPlain(node) ? node.text : isList(node) ? node.items.map(item => item.text).join(", ") : null;

function options(select, words, chosen) {
  fill(select, [["", "–"], ...words.map(one => [one, one])], chosen);
  if (chosen && select.value !== chosen) { select.append(new Option(chosen, chosen)); select.value = chosen; }
}

/// A key with its value; an emptied one is removed.
function fieldAt(path, inner, node, instead = [], called = last(path)) {
  const name = last(path), value = shownText(node);
  const label = made("span", { title: inner.says || "" }, made("b", {}, String(called)), " ", brief(inner));
  let control;
  if (value === null) control = made("input", { readonly: "", value: word("inText") });
  else if (inner.flag || inner.words && !inner.free) {
    control = made("select");
    options(control, inner.flag ? ["true", "false"] : inner.words.filter(one => typeof one === "string"), value);
  } else if (FORMULAS.includes(name) || value.includes("\n")) {
    control = made("textarea", { spellcheck: "false" });
    control.rows = Math.max(1, value.trim().split("\n").length);
    control.value = value.trim();
  } else {
    control = made("input", { autocomplete: "off", spellcheck: "false" });
    control.value = value;
    if (UNITS.includes(name)) control.setAttribute("list", "units");
    if (inner.words) control.setAttribute("list", listOf(name, inner.words));
  }
  control.dataset.at = keyOf(path);
  const before = control.value;
  control.addEventListener("change", () => {
    if (control.value === before) return;
    const typed = control.value;
    if (typed.trim() === "" ) { if (node) edit([{ do: "remove", path }]); return; }
    const gone = instead.map(other => ({ do: "remove", path: other }));
    form.ways.delete(keyOf(path.slice(0, -1)));
    edit([...gone, { do: "set", path, typed }]);
  });
  return made("label", { class: wide(name, value) }, label, control);
}

/// Words that a key may take beside others.
function listOf(name, words) {
  const id = `words-${name}`;
  if (!$(id)) $("form").append(made("datalist", { id }, ...words.map(one => made("option", { value: one }))));
  return id;
}

const wide = (name, value) => FORMULAS.includes(name) || ["title", "description", "note"].includes(name) || (value || "").length > 30 ? "wide" : "";

function button(label, act, more = {}) {
  const one = made("button", { type: "button", ...more }, label);
  one.addEventListener("click", act);
  return one;
}

/// A table of the schema: its fields, its rows, and those that can be added.
function tableAt(path, place, node, isGroup = false) {
  const there = new Map(node && node.keys), keys = Object.entries(place.keys || {});
  const usual = USUAL[path.length ? tableOf(path) : ""] || keys.slice(0, MOST_USUAL).map(([key]) => key), parts = [], missing = [];
  const ways = keys.filter(([, inner]) => inner.way);
  const apart = place.keys.components && (there.has("components") || form.open.has(keyOf([...path, "components"])));
  const ofComponent = new Set(Object.keys((place.keys.components || {}).keys || {}));
  const stated = ways.filter(([key]) => there.has(key)).map(([key]) => key);
  const key = keyOf(path), way = form.ways.get(key) || stated[0] || "";
  const partners = way ? [way, ...place.keys[way].way] : [];
  const instead = form.ways.has(key) ? stated.filter(one => !partners.includes(one)).map(one => [...path, one]) : [];
  const add = (name, inner) => {
    const inside = [...path, name], value = there.get(name);
    const gone = partners.includes(name) ? instead : [];
    if (inner.rows && !(value && value.text)) parts.push(listAt(inside, inner, value));
    else if (inner.any && !(value && value.text)) parts.push(rowsAt(inside, inner, value));
    else if (inner.keys && (value ? value.keys : !inner.words && !inner.free)) parts.push(groupAt(inside, inner, value, gone));
    else parts.push(fieldAt(inside, inner, value, gone));
  };
  for (const [name, inner] of keys) {
    const asked = form.open.has(keyOf([...path, name]));
    if (inner.way && !there.has(name)) continue;
    if (inner.way && form.ways.has(key)) continue;
    if (apart && name === "components") continue;
    if (there.has(name) || asked || usual.includes(name) || isGroup) add(name, inner);
    else if (ways.length && !apart && OF_UNCERTAINTY.includes(name)) add(name, inner);
    else if (name !== "components" && !(apart && ofComponent.has(name))) missing.push([name, inner]);
    if (name === "unit" && ways.length && !apart) parts.push(wayAt(path, ways, way));
  }
  if (ways.length && !apart && !place.keys.unit) parts.splice(1, 0, wayAt(path, ways, way));
  // The way that has no figure yet.
  if (!apart) for (const name of partners) if (form.ways.has(key) || !there.has(name)) add(name, place.keys[name]);
  const box = made("div", { class: "fields" }, ...parts);
  const foot = made("p", { class: "foot" });
  if (missing.length && !isGroup) foot.append(moreAt(path, missing));
  if (place.keys.components) foot.append(button(word("addComponent"), () => addComponent(path, there, ofComponent), { "data-at": keyOf([...path, "+"]) }));
  if (apart) box.append(listAt([...path, "components"], place.keys.components, there.get("components")));
  if (foot.childNodes.length) box.append(foot);
  return box;
}

/// How an uncertainty is stated.
function wayAt(path, ways, chosen) {
  const select = made("select", { "data-at": keyOf([...path, "?"]) });
  const seen = new Set(), list = [];
  // Of two keys that belong together the first stands for both.
  for (const [name, inner] of ways) {
    if (inner.way.some(partner => seen.has(partner))) continue;
    seen.add(name);
    list.push([name, `${name}: ${brief(inner)}`]);
  }
  fill(select, [["", "–"], ...list], chosen);
  select.addEventListener("change", () => {
    if (select.value) form.ways.set(keyOf(path), select.value); else form.ways.delete(keyOf(path));
    form.focus = keyOf([...path, select.value || "?"]);
    draw();
  });
  return made("label", {}, made("span", {}, word("way")), select);
}

/// Keys that have no value yet.
function moreAt(path, missing) {
  const select = made("select", { "aria-label": word("moreKeys"), "data-at": keyOf([...path, "…"]) });
  fill(select, [["", word("moreKeys")], ...missing.filter(([, inner]) => !inner.way).map(([name, inner]) => [name, `${name}: ${brief(inner)}`])], "");
  select.addEventListener("change", () => {
    if (!select.value) return;
    const path_ = [...path, select.value];
    form.open.add(keyOf(path_));
    form.focus = keyOf(path_);
    draw();
  });
  return select;
}

function addComponent(path, there, ofComponent) {
  const components = [...path, "components"], now = there.get("components");
  const own = [...there.keys()].filter(key => ofComponent.has(key));
  const edits = [];
  let at = now ? now.items.length : 0;
  // What was stated in the input itself becomes its first component.
  if (!now && own.length) {
    edits.push({ do: "add", path: [...components, 0] });
    for (const key of own) edits.push({ do: "move", path: [...path, key], to: [...components, 0, key] });
    at = 1;
  }
  edits.push({ do: "add", path: [...components, at] });
  edit(edits, keyOf([...components, at, "name"]));
}

// ---- rows ------------------------------------------------------------------------------------------------------

const heading = (path, inner) => [made("b", {}, String(last(path))), " ", brief(inner)];

/// A table within a table.
function groupAt(path, inner, node, instead) {
  const inside = tableAt(path, inner, node, true);
  // The first figure takes the place of the other way.
  if (instead.length) {
    inside.addEventListener("change", event => {
      event.stopImmediatePropagation();
      const at = JSON.parse(event.target.dataset.at);
      form.ways.delete(keyOf(path.slice(0, -1)));
      edit([...instead.map(other => ({ do: "remove", path: other })), { do: "set", path: at, typed: event.target.value }]);
    }, { capture: true });
  }
  return made("fieldset", { class: "group", "data-at": keyOf(path), title: inner.says || "" }, made("legend", {}, ...heading(path, inner)), inside);
}

/// Tables under names: a row for each.
function rowsAt(path, inner, node) {
  const rows = node && node.keys || [];
  const box = made("fieldset", { class: "rows", "data-at": keyOf(path) }, made("legend", { title: inner.says || "" }, ...heading(path, inner)));
  for (const [index, [name, row]] of rows.entries()) {
    const at = [...path, name];
    const title = made("input", { "data-at": keyOf([...at, "!"]), autocomplete: "off", spellcheck: "false" });
    title.value = name;
    title.addEventListener("change", () => {
      const wanted = title.value.trim();
      if (!wanted || wanted === name) { title.value = name; return; }
      edit([{ do: "rename", path: at, name: wanted }], keyOf([...path, wanted, "!"]));
    });
    const plain = isPlain(row) || row.items || !inner.any.keys;
    const fields = plain ? made("div", { class: "fields" }, fieldAt(at, inner.any, row, [], word("valueOf"))) : tableAt(at, inner.any, row);
    fields.prepend(made("label", { class: "name" }, made("span", {}, word("name")), title));
    const near = [rows[index - 1], rows[index + 1]].map(other => other && [...path, other[0]]);
    box.append(framed(at, name, fields, near, at, at));
  }
  const name = made("input", { "data-at": keyOf([...path, "+"]), autocomplete: "off", spellcheck: "false" });
  const adding = () => {
    const wanted = name.value.trim();
    if (!wanted) { name.focus(); return; }
    if (rows.some(([known]) => known === wanted)) { say(word("taken", wanted)); name.select(); return; }
    const at = [...path, wanted], plain = !inner.any.keys;
    edit([plain ? { do: "set", path: at, typed: "?" } : { do: "add", path: at }], plain ? keyOf(at) : keyOf(at) + ">");
  };
  name.addEventListener("keydown", event => { if (event.key === "Enter") { event.preventDefault(); adding(); } });
  box.append(made("p", { class: "foot" }, made("label", { class: "name" }, made("span", {}, word("newRow", last(path))), name), button(word("add"), adding)));
  return box;
}

/// Tables one below the other.
function listAt(path, inner, node) {
  const isOne = node && node.keys, rows = isOne ? [node] : node && node.items || [];
  const box = made("fieldset", { class: "rows", "data-at": keyOf(path) }, made("legend", { title: inner.says || "" }, ...heading(path, inner)));
  for (const [index, row] of rows.entries()) {
    const at = isOne ? path : [...path, index], label = `${last(path)} ${index + 1}`;
    const near = [index - 1, index + 1].map(other => !isOne && rows[other] && [...path, other]);
    box.append(framed(at, label, tableAt(at, inner, row), near, ...near));
  }
  if (!isOne && last(path) !== "components") {
    const at = [...path, rows.length];
    const adding = button(word("add"), () => edit([{ do: "add", path: at }], keyOf(at) + ">"), { "data-at": keyOf([...path, "+"]), "aria-label": `${word("add")}: ${last(path)}` });
    box.append(made("p", { class: "foot" }, adding));
  }
  return box;
}

/// A row with what moves and removes it; `near` are the rows above and below it, `up` and `down` the paths that it has when it was moved there.
function framed(path, label, fields, near, up, down) {
  const moves = [["↑", near[0], up], ["↓", near[1], down]].map(([sign, other, moved]) => {
    const said = word(sign === "↑" ? "moveUp" : "moveDown", label);
    const move = () => edit([{ do: "exchange", path, with: other }], keyOf([...moved, sign]));
    return button(sign, move, { disabled: !other, "aria-label": said, title: said, "data-at": keyOf([...path, sign]) });
  });
  return made("div", { class: "row", role: "group", "aria-label": label, "data-row": keyOf(path) }, fields, made("div", { class: "moves" }, ...moves), remover(path, label));
}

function remover(path, label) {
  const above = keyOf([...path.slice(0, -1), "+"]);
  return button("×", () => edit([{ do: "remove", path }], above), { class: "remove", "aria-label": word("removeRow", label), title: word("removeRow", label) });
}

// ---- drawing ---------------------------------------------------------------------------------------------------

function draw() {
  const box = $("form"), active = document.activeElement;
  $("undo").disabled = !form.past.length;
  // Whoever types on is not disturbed.
  const held = box.contains(active) ? { at: active.dataset.at, value: active.value, from: active.selectionStart, to: active.selectionEnd } : null;
  const top = box.scrollTop;
  const frame = made("fieldset", { class: "all" });
  box.replaceChildren(frame, made("datalist", { id: "units" }, ...form.units.map(([symbol, name]) => made("option", { value: symbol, label: name }))));
  if (form.shown && form.schema) frame.append(tableAt([], form.schema, form.shown));
  if (!form.entries) {
    frame.disabled = true;
    box.prepend(made("p", { class: "fault" }, word("formFault")));
  }
  showFaults();
  box.scrollTop = top;
  const wanted = form.focus || held && held.at;
  if (!wanted || !(held || form.focus) ) return;
  const target = wanted.endsWith(">") ? rowOf(wanted.slice(0, -1))
    : [...box.querySelectorAll("[data-at]")].find(one => one.dataset.at === wanted);
  const found = target && (target.matches("input, select, textarea, button") ? target : target.querySelector("input, select, textarea, button"));
  // What was moved to an end goes on to move back.
  const control = found && found.disabled ? found.parentElement.querySelector("button:enabled") : found;
  if (control) {
    control.focus();
    if (!form.focus && held.value !== control.value && control.matches("input, textarea")) control.value = held.value;
    if (!form.focus && held.from !== null && control.setSelectionRange) control.setSelectionRange(held.from, held.to);
  }
  form.focus = null;
}

/// The first field of a row, behind its name.
function rowOf(key) {
  const row = [...$("form").querySelectorAll("[data-row]")].find(one => one.dataset.row === key);
  return row && row.querySelector(":is(label:not(.name), legend) :is(input, select, textarea)");
}

/// The path of the innermost entry at a place of the text.
function pathAt(from, node, path = []) {
  const inner = node.keys ? node.keys : node.items ? [...node.items.entries()] : [];
  let best = node.place && node.place[0] <= from && from <= node.place[1] ? [path, node.place[1] - node.place[0]] : null;
  for (const [step, one] of inner) {
    const found = pathAt(from, one, [...path, step]);
    if (found && (!best || found[1] <= best[1])) best = found;
  }
  return best;
}

/// The element of the form for an entry, or for the table that holds it.
function elementOf(path) {
  for (let length = path.length; length > 0; length -= 1) {
    const key = keyOf(path.slice(0, length));
    const found = [...$("form").querySelectorAll("[data-at], [data-row]")].find(one => one.dataset.at === key || one.dataset.row === key);
    if (found) return found;
  }
  return null;
}

/// Each fault at its field, with its mend.
function showFaults() {
  for (const old of $("form").querySelectorAll(".all .fault")) old.remove();
  for (const old of $("form").querySelectorAll("[aria-invalid]")) { old.removeAttribute("aria-invalid"); old.removeAttribute("aria-describedby"); }
  if (!form.entries) return;
  for (const [at, fault] of form.faults.entries()) {
    const found = pathAt(fault.from, form.entries), element = found && elementOf(found[0]);
    if (!element) continue;
    $("faults").children[at]?.classList.add("placed");
    const words = made("p", { class: "fault", id: `field-fault-${at}` }, fault.message, fault.help ? ` → ${fault.help}` : "");
    if (element.matches("input, select, textarea")) {
      element.setAttribute("aria-invalid", "true");
      element.setAttribute("aria-describedby", words.id);
      element.closest("label").after(words);
    } else element.append(words);
  }
}

/// Leads to the field of a fault; false where the form is not shown or has none.
function fieldOfFault(fault) {
  const found = form.on && form.entries && pathAt(fault.from, form.entries), element = found && elementOf(found[0]);
  if (!element) return false;
  const control = element.matches("input, select, textarea") ? element : element.querySelector("input, select, textarea, button");
  control.focus();
  return true;
}

$("as-form").addEventListener("click", () => showView(true));
$("as-text").addEventListener("click", () => showView(false));
$("undo").addEventListener("click", undo);
$("form").addEventListener("submit", event => event.preventDefault());
