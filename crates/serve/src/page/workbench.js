"use strict";
// The workbench: the text on the left, what the program says of it on the right. Nothing is computed here.

const $ = id => document.getElementById(id);
const page = crypto.randomUUID ? crypto.randomUUID() : String(Math.random());
const state = {
  path: null, // of the file, from the top of the folder
  disk: null, // its text as it was read; null of a file that is new
  crlf: false, // whether its lines end in CR LF, which a text field does not keep
  added: new Map(), // files that were dropped: name → bytes
  changes: new Map(), // input → { value, factor }; path of an entry → { path, typed }
  saved: null, // what the page shows beside the result of the saved text
  beside: null, // … of the last result
  shown: "see", // what the document is: see, require, diagnose, audit
  audited: null, // name of the sheet that is audited
  formats: [],
  lessons: [],
  procedures: [],
  certificates: [],
  certificate: "", // the file with the data of the certificate that is chosen
  costs: new Map(), // of halving the uncertainty of an input, by name
  seed: 1, // of the samples of a lesson
  playing: null, // the play of the slider of a lesson, while it goes on
};

// ---- languages -------------------------------------------------------------------------------------------------

let language = navigator.language.toLowerCase().startsWith("zh") ? "zh" : "en";
const word = (name, ...values) => {
  const said = WORDS[language][name];
  return typeof said === "function" ? said(...values) : said;
};

function speak(code) {
  language = code;
  document.documentElement.lang = code === "zh" ? "zh-Hans" : "en";
  $("language").value = code;
  for (const element of document.querySelectorAll("[data-word]")) element.textContent = word(element.dataset.word);
  for (const element of document.querySelectorAll("[data-label]")) element.setAttribute("aria-label", word(element.dataset.label));
  $("document").title = word("result");
  fillFormats();
  fillCertificates();
  fillLessons($("lesson").value);
  fillExercises($("exercise-kind").value);
  formStale();
}

function say(text) { $("status").textContent = text; }

// ---- the server ------------------------------------------------------------------------------------------------

const encoder = new TextEncoder();
const bytesOf = content => typeof content === "string" ? encoder.encode(content) : content;

/// A line of JSON and the contents of files behind it.
async function ask(what, head = {}, files = [], signal = undefined) {
  const contents = files.map(([, content]) => bytesOf(content));
  const list = files.map(([path], at) => ({ path, bytes: contents[at].length }));
  const line = JSON.stringify({ page, language, ...head, files: list }) + "\n";
  const body = new Blob([line, ...contents]);
  return fetch("api/" + what, { method: "POST", body, signal });
}

async function told(response) {
  const said = await response.json().catch(() => ({}));
  return said.message || (response.status === 413 ? word("tooLarge") : `${response.status}`);
}

// ---- the text --------------------------------------------------------------------------------------------------

const text = $("text");
const written = () => state.crlf ? text.value.replaceAll("\n", "\r\n") : text.value;
const isSaved = () => state.path === null || (state.disk !== null && written() === state.disk);

function put(content) {
  state.crlf = /\r\n/.test(content);
  text.value = content.replaceAll("\r\n", "\n");
  mark([]);
  formStale();
}

/// Line numbers, and the layer below the text that underlines faults and says them at the end of their line.
function mark(faults) {
  const lines = text.value.split("\n").length;
  $("numbers").textContent = Array.from({ length: lines }, (_, at) => at + 1).join("\n") + "\n\n";
  const layer = $("marks"), content = text.value;
  layer.replaceChildren();
  let at = 0;
  const notes = new Map();
  for (const fault of faults) {
    const start = Math.min(fault.from, content.length);
    const end = content.indexOf("\n", start) < 0 ? content.length : content.indexOf("\n", start);
    notes.set(end, [...(notes.get(end) || []), fault]);
  }
  const plain = to => {
    for (const [end, those] of [...notes].sort((a, b) => a[0] - b[0])) {
      if (end < at || end > to) continue;
      layer.append(content.slice(at, end));
      at = end;
      const note = document.createElement("i");
      note.textContent = those[0].label || those[0].message;
      layer.append(note);
      notes.delete(end);
    }
    layer.append(content.slice(at, to));
    at = to;
  };
  for (const fault of [...faults].sort((a, b) => a.from - b.from)) {
    if (fault.from < at) continue;
    plain(fault.from);
    // Something is underlined where something is missing, too; never more than a line.
    const stop = content.indexOf("\n", fault.from);
    const end = Math.min(Math.max(fault.to, fault.from + 1), stop < 0 ? content.length : Math.max(stop, fault.from));
    const underlined = document.createElement("mark");
    underlined.textContent = content.slice(fault.from, end) || " ";
    layer.append(underlined);
    at = end;
  }
  plain(content.length);
  layer.append("\n\n");
  scrolled();
}

function scrolled() {
  for (const layer of [$("marks"), $("numbers")]) layer.scrollTop = text.scrollTop;
  $("marks").scrollLeft = text.scrollLeft;
}

function list(faults, others) {
  $("faults").replaceChildren(...faults.map(fault => {
    const item = document.createElement("li"), head = document.createElement("p"), go = document.createElement("button");
    go.type = "button";
    go.textContent = `${word("line", fault.line)}: ${fault.message}`;
    go.addEventListener("click", () => {
      if (fieldOfFault(fault)) return;
      if (form.on) showView(false);
      text.focus();
      text.setSelectionRange(fault.from, Math.max(fault.to, fault.from));
      text.scrollTop = (fault.line - 4) * parseFloat(getComputedStyle(text).lineHeight);
    });
    head.append(go, ` [${fault.code}]`);
    item.append(head);
    for (const more of [fault.label, fault.help]) {
      if (!more) continue;
      const line = document.createElement("p");
      line.textContent = more === fault.help ? `→ ${more}` : more;
      item.append(line);
    }
    return item;
  }));
  $("others").hidden = !others;
  $("others").textContent = others || "";
}

// ---- the document ----------------------------------------------------------------------------------------------

/// Shows a whole page of HTML; its content is exchanged where one is shown already, so that nothing moves.
function show(html) {
  const frame = $("document"), inside = frame.contentDocument;
  const fresh = new DOMParser().parseFromString(html, "text/html");
  const old = inside && inside.querySelector("main"), now = fresh.querySelector("main");
  // What the page itself notes has no style, which a document after it needs.
  const styled = inside && (inside.querySelector("style") || !fresh.querySelector("style"));
  if (old && now && styled) {
    inside.documentElement.lang = fresh.documentElement.lang;
    inside.title = fresh.title;
    old.replaceWith(inside.adoptNode(now));
  } else {
    frame.srcdoc = html;
  }
  document.body.classList.remove("stale");
}

/// Links of a document lead to its own places; by itself the browser would look for them in the page around it.
$("document").addEventListener("load", () => {
  const inside = $("document").contentDocument;
  inside.addEventListener("click", event => {
    const link = event.target.closest("a[href^='#']");
    if (!link) return;
    event.preventDefault();
    const place = inside.getElementById(link.getAttribute("href").slice(1));
    if (place) { place.tabIndex = -1; place.focus({ preventScroll: true }); place.scrollIntoView(); }
  });
});

function note(message) {
  const paragraph = document.createElement("p");
  paragraph.textContent = message;
  show(`<!doctype html><html><head></head><body><main>${paragraph.outerHTML}</main></body></html>`);
}

// ---- what is asked for -----------------------------------------------------------------------------------------

let flight = null;
let timer = null;

const PAUSE = 40; // ms between a key and the question; the server drops what it has not answered yet

function soon() {
  clearTimeout(timer);
  timer = setTimeout(() => run("see"), PAUSE);
}

function changes() {
  return [...state.changes].map(([input, change]) => change.path || change.readings ? change : { input, ...change });
}

/// What travels with every question: the text as it is now, and what was dropped.
function files() {
  const folder = state.path && state.path.includes("/") ? state.path.replace(/[^/]*$/, "") : "";
  const added = [...state.added].map(([name, content]) => [folder + name, content]);
  return state.path === null ? added : [[state.path, written()], ...added];
}

function wish(task) {
  if (task === "exercise") return [{ task, path: "", exercise: exerciseWish() }, []];
  if (task === "lesson") {
    const lesson = { name: $("lesson").value, n: $("n").valueAsNumber, seed: state.seed };
    return [{ task, path: "", lesson }, []];
  }
  const path = task === "audit" ? state.audited : state.path;
  const head = { task, path, changes: changes() };
  if (state.certificate && !APART.includes(task)) head.certificate = state.certificate;
  if (task === "versions") head.before = state.disk;
  if (task === "require") head.target = { measurand: $("measurand").value, expanded: $("wished").valueAsNumber, costs: Object.fromEntries(state.costs) };
  const sent = task === "audit" ? [[path, state.added.get(path)]] : files();
  return [head, sent];
}

/// What is shown and is not of the text.
const APART = ["audit", "lesson", "exercise"];

async function run(task) {
  if (!APART.includes(task) && state.path === null) {
    // There is no text to go back to.
    $("elsewhere").hidden = true;
    teaching(false);
    note(word("none"));
    return;
  }
  if (flight) flight.abort();
  const own = flight = new AbortController();
  const start = performance.now();
  const watched = setTimeout(() => watch(own), 400);
  try {
    const response = await ask("work", ...wish(task), own.signal);
    if (own !== flight) return;
    if (!response.ok) { note(await told(response)); return; }
    const found = await response.json();
    if (own !== flight) return;
    state.shown = task;
    received(found, Math.round(performance.now() - start), task);
  } catch (error) {
    if (error.name !== "AbortError" && own === flight) say(word("lost"));
  } finally {
    clearTimeout(watched);
    if (own === flight) { flight = null; $("busy").hidden = true; }
  }
}

/// Progress of what takes long, until it is done.
async function watch(own) {
  while (own === flight) {
    $("busy").hidden = false;
    document.body.classList.add("stale");
    const response = await ask("progress").catch(() => null);
    const done = response && response.ok ? await response.json() : null;
    if (own !== flight) break;
    if (done && done.share > 0) $("share").value = done.share; else $("share").removeAttribute("value");
    $("done").textContent = done && done.trials ? word("trials", done.trials.toLocaleString(language)) : word("computing");
    await new Promise(resolve => setTimeout(resolve, 300));
  }
}

function received(found, ms, task) {
  if (found.stopped) { say(word("stopped")); return; }
  const faults = found.faults || [];
  if (!APART.includes(task)) { mark(faults); list(faults, found.others); formFaults(faults); }
  $("elsewhere").hidden = ["see", "lesson"].includes(task) || state.path === null || (task === "exercise" && practice.kind === "budget");
  teaching(task === "lesson");
  if (found.html) {
    show(found.html);
    if (task === "exercise") { $("what-if").hidden = $("experiment").hidden = $("residuals").hidden = true; exerciseReceived(found); return; }
    if (task === "see") moved(found.beside || {});
    if (task === "lesson") { $("what-if").hidden = $("residuals").hidden = true; $("n-shown").textContent = found.beside.count || ""; say(word("drawn", state.seed)); return; }
    const ofText = task === "audit" ? "" : isSaved() ? word("saved") : word("unsaved");
    say(`${state.changes.size ? word("changed") : ""} ${ofText} ${word("ready", ms)}`.trim());
  } else if (faults.length || found.others) {
    // The last result stays, faintly: it is of another text.
    document.body.classList.add("stale");
    say(word("faults", faults.length));
  } else {
    note(found.message || word("nothing"));
    say(found.message || "");
  }
}

// ---- what if ---------------------------------------------------------------------------------------------------

const MOST_SLIDERS = 60; // inputs that a reader finds

function moved(beside) {
  state.beside = beside;
  $("experiment").hidden = !beside.experiment;
  brush(beside.residuals, beside.dwells);
  $("what-if").hidden = !beside.inputs;
  $("compare").disabled = state.disk === null || isSaved();
  if (!beside.inputs) return;
  if (isSaved() && state.changes.size === 0) state.saved = beside;
  const rows = $("sliders"), names = [...beside.inputs, ...beside.entries].map(one => one.name).join("\n");
  // While nothing is moved the sliders begin where the text is.
  if (rows.dataset.names !== names || state.changes.size === 0) {
    rows.dataset.names = names;
    const focused = [...rows.querySelectorAll("input")].indexOf(document.activeElement);
    rows.replaceChildren(...beside.inputs.slice(0, MOST_SLIDERS).map(sliders), ...beside.entries.slice(0, MOST_SLIDERS).map(entrySlider));
    if (focused >= 0) rows.querySelectorAll("input")[focused]?.focus();
    fill($("measurand"), beside.results.map(result => [result.name, result.name]), $("measurand").value);
  }
  const measurand = beside.results.find(result => result.name === $("measurand").value);
  $("target-unit").textContent = measurand ? measurand.unit : "";
  if (measurand && !$("wished").value) $("wished").value = Number((measurand.U / 2).toPrecision(2));
  $("saved").textContent = state.saved && state.saved !== beside ? `${word("before")}: ${state.saved.statement.join(" ")}` : "";
  ghosts(beside);
}

/// A row of sliders: the estimate by some standard uncertainties, the uncertainty by a factor.
function sliders(input) {
  const row = document.createElement("tr"), name = document.createElement("th");
  name.scope = "row";
  name.textContent = input.name;
  const step = input.u > 0 ? input.u / 4 : Math.abs(input.value || 1) / 100;
  const slider = (label, min, max, start, text, change) => {
    const cell = document.createElement("td"), range = document.createElement("input"), out = document.createElement("output");
    Object.assign(range, { type: "range", min, max, step: 1, value: start });
    range.setAttribute("aria-label", `${input.name}: ${label}`);
    const tell = () => { out.textContent = text(Number(range.value)); range.setAttribute("aria-valuetext", out.textContent); };
    range.addEventListener("input", () => {
      tell();
      const all = { ...state.changes.get(input.name), ...change(Number(range.value)) };
      if (Number(range.value) === start) for (const key of Object.keys(change(0))) delete all[key];
      if (Object.keys(all).length) state.changes.set(input.name, all); else state.changes.delete(input.name);
      soon();
    });
    tell();
    cell.append(range, out);
    return cell;
  };
  const value = at => input.value + at * step;
  const digits = Math.max(0, Math.min(15, 1 - Math.floor(Math.log10(step))));
  // From nothing over a tenth to ten times, as the fourth of a decade.
  const factor = at => at === -9 ? 0 : 10 ** (at / 8);
  row.append(
    name,
    slider(word("value"), -40, 40, 0, at => `${value(at).toFixed(digits)} ${input.unit}`, at => ({ value: value(at) })),
    slider(word("factor"), -9, 8, 0, at => `× ${Number(factor(at).toPrecision(2))}`, at => ({ factor: factor(at) })),
    costOf(input.name),
  );
  return row;
}

/// What it costs to halve the uncertainty of an input; empty where it stays as it is.
function costOf(input) {
  const cell = document.createElement("td"), field = document.createElement("input");
  Object.assign(field, { type: "number", min: 0, step: "any", value: state.costs.has(input) ? state.costs.get(input) ?? "" : 1 });
  field.setAttribute("aria-label", `${input}: ${word("cost")}`);
  field.addEventListener("input", () => {
    const cost = field.valueAsNumber;
    state.costs.set(input, cost > 0 ? cost : null);
  });
  cell.append(field);
  return cell;
}

/// A slider of a correlation coefficient, of degrees of freedom, or of how many readings there are.
function entrySlider(entry) {
  const row = document.createElement("tr"), name = document.createElement("th"), cell = document.createElement("td");
  name.scope = "row";
  name.textContent = entry.name;
  const range = document.createElement("input"), out = document.createElement("output"), key = JSON.stringify(entry.path);
  const [min, max, step] = { r: [-1, 1, 0.05], dof: [1, Math.max(100, entry.value), 1], readings: [2, Math.max(100, entry.value), 1] }[entry.key];
  Object.assign(range, { type: "range", min, max, step, value: entry.value });
  range.setAttribute("aria-label", entry.name);
  const typed = () => entry.key === "r" ? Number(range.value).toFixed(2) : range.value;
  range.addEventListener("input", () => {
    out.textContent = typed();
    state.changes.set(key, entry.key === "readings" ? { readings: entry.path, n: Number(range.value) } : { path: entry.path, typed: typed() });
    soon();
  });
  out.textContent = String(entry.value);
  cell.append(range, out);
  row.append(name, cell);
  return row;
}

function reset() {
  state.changes.clear();
  $("sliders").dataset.names = "";
  soon();
}

/// The intervals y ± U now and as saved, in the same place.
function ghosts(now) {
  const saved = state.saved, parts = [];
  const first = now.results[0], old = saved && saved.results.find(result => first && result.name === first.name);
  if (first && old && saved !== now && [first.y, first.U, old.y, old.U].every(Number.isFinite)) {
    const low = Math.min(first.y - first.U, old.y - old.U), high = Math.max(first.y + first.U, old.y + old.U);
    const place = x => 70 + 520 * (x - low) / (high - low || 1);
    const bar = (one, y, kind) => `<g class="${kind}"><line x1="${place(one.y - one.U)}" x2="${place(one.y + one.U)}" y1="${y}" y2="${y}" stroke-width="4"/><circle cx="${place(one.y)}" cy="${y}" r="5" stroke="none"/></g><text x="0" y="${y + 4}">${word(kind === "now" ? "now" : "before")}</text>`;
    parts.push(`<svg viewBox="0 0 600 48" role="img" aria-label="y ± U">${bar(old, 14, "saved")}${bar(first, 34, "now")}</svg>`);
  }
  $("ghosts").innerHTML = parts.join("");
}

// ---- files -----------------------------------------------------------------------------------------------------

function fill(select, options, chosen) {
  select.replaceChildren(...options.map(([value, label]) => new Option(label, value)));
  if (options.some(([value]) => value === chosen)) select.value = chosen;
}

function fillFormats() {
  fill($("format"), [["", word("choose")], ...state.formats.map(([name, ending]) => [name, `.${ending}`])], "");
}

function fillCertificates() {
  if (!state.certificates.includes(state.certificate)) state.certificate = "";
  const files = state.certificates.map(name => [name, name]);
  fill($("certificate"), [["", word("noCertificate")], ...files, [NEW, word("newCertificate")]], state.certificate);
}

const NEW = "new"; // no file has this name: it has no ending

/// The data of the certificate that the report is to be; new ones are written and opened, to be filled in.
async function certify() {
  if ($("certificate").value !== NEW) { state.certificate = $("certificate").value; await run("see"); return; }
  fillCertificates();
  if (!(await mayLeave())) return;
  const answer = await question(word("certificateName"), { yes: word("create"), name: "laboratory.toml" });
  if (answer === "") return;
  const template = await (await ask("template")).json();
  await created($("name").value.trim(), template.certificate);
}

function fillLessons(chosen) {
  const at = language === "zh" ? 1 : 0;
  fill($("lesson"), [["", word("chooseLesson")], ...state.lessons.map(([name, titles]) => [name, titles[at]])], chosen);
}

/// A lesson has the whole page: its pictures are to be read from afar.
function teaching(isLesson) {
  $("class").hidden = !isLesson;
  document.body.classList.toggle("lesson", isLesson);
  if (!isLesson) { pause(); $("lesson").value = ""; }
}

/// Draws the samples of a lesson; of none, what was there before.
function teach() {
  if (practice.kind === "budget") leaveExercise();
  const chosen = state.lessons.find(([name]) => name === $("lesson").value);
  $("size").hidden = !(chosen && chosen[2]);
  return run($("lesson").value ? "lesson" : "see");
}

const PLAYED = 400; // ms that a picture stands at least before the next one

/// Moves the slider on by itself, from the beginning where it stands at the end, until it is there or is stopped.
async function play() {
  if (state.playing) { pause(); return; }
  const own = state.playing = {}, n = $("n");
  $("play").textContent = word("pause");
  if (n.value === n.max) n.value = n.min;
  while (state.playing === own) {
    await Promise.all([teach(), new Promise(resolve => setTimeout(resolve, PLAYED))]);
    if (state.playing !== own) return;
    if (n.value === n.max) pause(); else n.stepUp();
  }
}

function pause() {
  state.playing = null;
  $("play").textContent = word("play");
}

async function refresh() {
  const response = await ask("files");
  const found = await response.json();
  state.formats = found.formats;
  state.lessons = found.lessons;
  state.procedures = found.procedures;
  state.certificates = found.certificates;
  fillFormats();
  fillCertificates();
  fillLessons($("lesson").value);
  fill($("file"), found.files.map(name => [name, name]), state.path);
  document.title = `${found.folder} – gumption`;
  return found.files;
}

async function open(path, mayRestore = true) {
  const response = await ask("open", { path });
  if (!response.ok) { say(await told(response)); $("file").value = state.path; return; }
  const { text: disk, draft } = await response.json();
  Object.assign(state, { path, disk, saved: null, beside: null, shown: "see" });
  state.changes.clear();
  state.costs.clear();
  $("sliders").dataset.names = "";
  $("wished").value = "";
  $("file").value = path;
  location.hash = encodeURIComponent(path);
  put(disk);
  // The saved text first: it is the ghost of what is changed.
  await run("see");
  if (mayRestore && draft !== null) {
    put(draft);
    await run("see");
    say(word("restored"));
  }
}

async function save() {
  if (state.path === null || isSaved()) return;
  const content = written(), base = state.disk;
  const sent = base === null ? [["text", content]] : [["text", content], ["base", base]];
  const response = await ask("save", { path: state.path, new: base === null }, sent).catch(() => null);
  if (!response) { say(word("lost")); return; }
  if (response.ok) {
    state.disk = content;
    if (state.changes.size === 0) state.saved = state.beside;
    say(word("saved"));
    await refresh();
    return;
  }
  if (response.status !== 409) { say(await told(response)); return; }
  const { message, there } = await response.json();
  const answer = await question(message, { yes: word("replace"), other: there === null ? null : word("theirs") });
  if (answer === "yes") { state.disk = there; await save(); }
  if (answer === "other") { await ask("forget", { path: state.path }); await open(state.path, false); }
}

/// Asks in a dialog; the value of the button that was pressed.
function question(words, { yes, other = null, name = null, options = null }) {
  const dialog = $("ask");
  $("question").textContent = words;
  $("yes").textContent = yes;
  $("other").hidden = other === null;
  $("other").textContent = other || "";
  $("name-label").hidden = name === null;
  $("name").value = name || "";
  $("option-label").hidden = options === null;
  fill($("option"), options || [], "");
  dialog.returnValue = "";
  dialog.showModal();
  if (name !== null) $("name").select();
  return new Promise(resolve => dialog.addEventListener("close", () => resolve(dialog.returnValue), { once: true }));
}

async function create() {
  const answer = await question(word("newName"), { yes: word("create"), other: word("emptyForm"), name: "budget.toml" });
  if (answer === "") return;
  const isEmpty = answer === "other";
  const text = isEmpty ? "" : (await (await ask("template")).json()).budget;
  const isThere = await created($("name").value.trim(), text);
  if (isThere && isEmpty) { form.focus = keyOf(["title"]); showView(true); }
}

/// Writes a new file and opens it; says why where it cannot.
async function created(name, text) {
  const path = name.endsWith(".toml") ? name : name + ".toml";
  const response = await ask("save", { path, new: true }, [["text", text]]);
  if (!response.ok) { say(await told(response)); return false; }
  await refresh();
  await open(path);
  return true;
}

/// Whether the text may be left for another one.
async function mayLeave() {
  if (isSaved()) return true;
  const answer = await question(word("overwrite"), { yes: word("leave"), other: word("discard") });
  if (answer === "other") await ask("forget", { path: state.path });
  return answer !== "";
}

async function choose() {
  const path = $("file").value;
  if (!(await mayLeave())) { $("file").value = state.path; return; }
  leaveExercise();
  await open(path);
}

/// Opens the chosen file again, or the first one.
async function reopened() {
  const names = await refresh();
  const there = names.includes(state.path) ? state.path : names[0];
  if (there) await open(there); else { state.path = null; put(""); note(word("none")); }
}

async function download() {
  const format = $("format").value;
  const ending = (state.formats.find(([name]) => name === format) || [])[1];
  $("format").value = "";
  if (!format) return;
  const [head, sent] = wish(state.shown);
  // As a page of its own: the one that is shown goes on.
  const response = await ask("work", { ...head, page: page + "/" + format, format }, sent);
  if (!response.ok) { say(await told(response)); return; }
  const link = document.createElement("a"), stem = (head.path || "result").replace(/^.*\//, "").replace(/\.[^.]*$/, "");
  link.href = URL.createObjectURL(await response.blob());
  link.download = `${stem}.${ending}`;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}

/// Sheets are audited; tables that an open experiment or budget may name are at hand for it; budgets are opened.
async function drop(dropped) {
  for (const file of dropped) {
    const content = new Uint8Array(await file.arrayBuffer());
    state.added.set(file.name, content);
    const named = state.path !== null && text.value.includes(file.name);
    if (named) { say(word("held", file.name)); await run("see"); continue; }
    const kind = TABLES.test(file.name) ? await question(word("whatIsIt", file.name), { yes: word("aRecording"), other: word("aSheet") }) : "other";
    if (kind === "yes") { await propose(file.name, content); continue; }
    if (kind !== "other") continue;
    state.audited = file.name;
    await run("audit");
  }
}

const TABLES = /\.(csv|tsv|txt|dat)$/i; // what may be a recording as well as a sheet

/// An experiment of a recording that was dropped, as a file of its own: by a procedure, or a line to start from.
async function propose(name, content) {
  if (!(await mayLeave())) return;
  const procedures = [["", word("ownEquations")], ...state.procedures.map(one => [one, one])];
  const answer = await question(word("newExperiment"), { yes: word("propose"), name: name.replace(/\.[^.]*$/, "") + ".toml", options: procedures });
  if (answer === "") return;
  const response = await ask("propose", { procedure: $("option").value || null }, [[name, content]]);
  if (!response.ok) { note(await told(response)); return; }
  if (await created($("name").value.trim(), (await response.json()).text)) say(word("held", name));
}

// ---- hands -----------------------------------------------------------------------------------------------------

text.addEventListener("input", () => { mark([]); formStale(true); soon(); });
text.addEventListener("scroll", scrolled);
$("file").addEventListener("change", choose);
$("format").addEventListener("change", download);
$("certificate").addEventListener("change", certify);
$("language").addEventListener("change", () => {
  pause();
  speak($("language").value);
  $("sliders").dataset.names = "";
  if (practice.open) practice.wanted = "task";
  run(practice.open ? "exercise" : state.shown);
});
$("lesson").addEventListener("change", () => { pause(); $("n").value = $("n").defaultValue; teach(); });
$("n").addEventListener("input", () => { pause(); teach(); });
$("play").addEventListener("click", play);
$("again").addEventListener("click", () => { state.seed += 1; teach(); });
$("leave").addEventListener("click", () => run("see"));
$("new").addEventListener("click", create);
$("save").addEventListener("click", save);
$("reset").addEventListener("click", reset);
$("stop").addEventListener("click", () => ask("stop"));
$("calibrate").addEventListener("click", () => run("see"));
$("plan").addEventListener("click", () => run("plan"));
$("diagnose").addEventListener("click", () => run("diagnose"));
$("compare").addEventListener("click", () => run("versions"));
$("back").addEventListener("click", () => run("see"));
$("measurand").addEventListener("change", () => { $("wished").value = ""; if (state.beside) moved(state.beside); });
$("target").addEventListener("submit", event => { event.preventDefault(); run("require"); });
$("pick").addEventListener("change", async () => { await drop($("pick").files); $("pick").value = ""; });
document.addEventListener("keydown", event => {
  if ((event.ctrlKey || event.metaKey) && event.key === "s") { event.preventDefault(); save(); }
});
for (const kind of ["dragover", "dragleave", "drop"]) document.addEventListener(kind, event => {
  event.preventDefault();
  document.body.classList.toggle("over", kind === "dragover");
  if (kind === "drop") drop(event.dataTransfer.files);
});
addEventListener("beforeunload", event => { if (!isSaved()) event.preventDefault(); });
