"use strict";
// Exercises: what is handed out, and the form for an answer. The truth is with the server until an answer has come.

const practice = {
  kind: null, // budget or recording
  open: null, // what the server says of the exercise that is open
  from: null, // the file that was open before a case took its place
  wanted: "task", // what is asked for: task, answers, or { grade: … }
};
const MOST_CLAIMS = 2; // slips, or effects, that an exercise conceals at most and a form asks for

function exerciseWish() {
  const seed = $("seed").valueAsNumber, number = $("nth").valueAsNumber || 1;
  return { kind: practice.kind, seed: Number.isSafeInteger(seed) && seed >= 0 ? seed : null, number, wanted: practice.wanted };
}

function fillExercises(chosen) {
  const kinds = ["budget", "recording"].map(kind => [kind, word(kind + "Exercise")]);
  fill($("exercise-kind"), [["", word("chooseLesson")], ...kinds], chosen);
}

/// Opens an exercise of the chosen kind; of none, what was there before.
async function exercise() {
  const kind = $("exercise-kind").value;
  if (!kind) { await endExercise(); return; }
  const isCase = practice.kind === "recording";
  if (kind === "recording" && !isCase && !(await mayLeave())) { fillExercises(practice.kind || ""); return; }
  if (isCase && kind !== "recording") { await endExercise(); $("exercise-kind").value = kind; }
  practice.kind = kind;
  practice.wanted = "task";
  $("practice").hidden = false;
  await run("exercise");
}

/// Whether the text is the case of an exercise.
const isCaseOpen = () => practice.kind === "recording" && practice.open !== null;

/// Ends an exercise, and shows the text that was there before.
async function endExercise() {
  const wasCase = isCaseOpen();
  leaveExercise();
  if (wasCase || state.path === null) await reopened(); else await run("see");
}

/// Forgets everything that belongs to an exercise.
function leaveExercise() {
  $("practice").hidden = true;
  document.body.classList.remove("sheet");
  $("exercise-kind").value = "";
  if (isCaseOpen()) {
    for (const [name] of practice.open.files) state.added.delete(name);
    state.path = practice.from;
  }
  Object.assign(practice, { kind: null, open: null, from: null, wanted: "task" });
}

/// What was answered by the server to a question about an exercise.
async function exerciseReceived(found) {
  const beside = found.beside;
  if (!beside) { say(found.message || ""); return; } // the teacher's sheet, or a refusal: shown by itself
  if (beside.graded) { say(word("graded")); $("next").hidden = practice.open.number >= practice.open.most; return; }
  practice.open = beside;
  $("seed").value = beside.seed;
  Object.assign($("nth"), { max: beside.most, value: beside.number });
  $("next").hidden = true;
  $("assignment").textContent = practice.kind === "recording" ? beside.task : "";
  document.body.classList.toggle("sheet", practice.kind === "budget");
  $("hand-out").replaceChildren(...beside.files.map(([name, bytes]) => handOut(name, bytes)));
  claims();
  say(word("opened", beside.seed, beside.number));
  if (practice.kind === "recording") await openCase();
}

/// A file to take away.
function handOut(name, bytes) {
  const link = document.createElement("a");
  link.textContent = link.download = name;
  link.href = URL.createObjectURL(new Blob([new Uint8Array(bytes)]));
  return link;
}

/// The case of a recording as a file that is edited; its recordings beside it.
async function openCase() {
  const files = practice.open.files.map(([name, bytes]) => [name, new Uint8Array(bytes)]);
  for (const [name, bytes] of files) state.added.set(name, bytes);
  if (!/^exercise-\d+-\d+\.toml$/.test(state.path || "")) practice.from = state.path;
  const content = new TextDecoder().decode(files[0][1]);
  Object.assign(state, { path: `exercise-${practice.open.seed}-${practice.open.number}.toml`, disk: null, saved: null, beside: null });
  state.changes.clear();
  put(content);
  $("residuals").open = true;
  await run("see");
}

// ---- the form --------------------------------------------------------------------------------------------------

function choice(label, options) {
  const select = document.createElement("select");
  select.setAttribute("aria-label", label);
  fill(select, options, "");
  return select;
}

function field(label, type, more = {}) {
  const input = document.createElement("input");
  Object.assign(input, { type, ...more });
  const around = document.createElement("label");
  around.append(label + " ", input);
  return [around, input];
}

/// The fields of the answer, empty.
function claims() {
  const { kinds, symbols, columns } = practice.open, ofBudget = practice.kind === "budget";
  const verdicts = ofBudget ? ["sound", "slips", "unexplained"] : ["agrees", "departs"];
  $("verdicts").replaceChildren(...verdicts.map(verdict => {
    const [label, radio] = field("", "radio", { name: "verdict", value: verdict, required: true });
    label.append(" " + word("verdict_" + verdict));
    radio.addEventListener("change", () => { $("claims").hidden = !["slips", "departs"].includes(verdict); });
    return label;
  }));
  $("claims").hidden = true;
  $("claims").replaceChildren(...Array.from({ length: MOST_CLAIMS }, (_, at) => {
    const row = document.createElement("p"), which = word("claim", at + 1);
    row.append(which + " ");
    if (ofBudget) slipFields(row, which, kinds, symbols); else effectFields(row, which, kinds, columns);
    return row;
  }));
  $("figures").hidden = !ofBudget;
  $("u_c").value = $("U").value = "";
}

function slipFields(row, which, kinds, symbols) {
  const options = kinds.map(([id, words]) => [id, words]);
  const kind = choice(`${which}: ${word("kindOfSlip")}`, [["", word("none_")], ...options]);
  const symbol = choice(`${which}: ${word("inRow")}`, [["", word("inRow") + " …"], ...symbols.map(name => [name, name])]);
  const suit = () => { symbol.disabled = !(kinds.find(([id]) => id === kind.value) || [])[2]; };
  kind.addEventListener("change", suit);
  suit();
  kind.className = "kind"; symbol.className = "row";
  row.append(kind, " ", symbol);
}

function effectFields(row, which, kinds, columns) {
  const names = [["", word("none_")], ["?", word("nameless")], ...kinds.map(([id, words]) => [id, words])];
  const along = [["", word("along") + " …"], ...columns.map(name => [name, name])];
  const or = kinds.map(([id, words]) => [id, words]);
  const fields = [
    ["kind", choice(`${which}: ${word("effect")}`, names)], ["along", choice(`${which}: ${word("along")}`, along)],
    ["kind-2", choice(`${which}: ${word("orEffect")}`, [["", word("orEffect") + " …"], ...or])],
    ["along-2", choice(`${which}: ${word("orEffect")}, ${word("along")}`, along)],
  ];
  for (const [name, select] of fields) { select.className = name; row.append(select, " "); }
  const [label, size] = field(word("sizeInResiduals"), "number", { step: "any", min: 0 });
  size.className = "size";
  row.append(label);
}

/// The answer in the form that `gumption grade` reads.
function answer() {
  const verdict = $("verdicts").querySelector("input:checked").value;
  const rows = [...$("claims").children], of = (row, name) => row.querySelector("." + name).value;
  if (practice.kind === "budget") {
    const slips = rows.filter(row => of(row, "kind")).map(row => {
      const symbol = row.querySelector(".row");
      return of(row, "kind") + (symbol.disabled || !symbol.value ? "" : "@" + symbol.value);
    });
    const figure = id => Number.isFinite($(id).valueAsNumber) ? $(id).valueAsNumber : null;
    const candidates = verdict === "slips" ? [slips] : [];
    return { file: practice.open.files[0][0], verdict, candidates, u_c: figure("u_c"), U: figure("U") };
  }
  const effects = rows.filter(row => of(row, "kind")).map(row => {
    const pairs = [["kind", "along"], ["kind-2", "along-2"]].filter(([kind]) => of(row, kind) && of(row, kind) !== "?");
    const named = pairs.map(([kind, along]) => ({ id: of(row, kind), along: of(row, along) }));
    const size = row.querySelector(".size").valueAsNumber;
    const state = of(row, "kind") === "?" ? "unexplained" : named.length > 1 ? "one-of" : "identified";
    return { state, named, in_residuals: Number.isFinite(size) ? size : null };
  });
  return { verdict, effects: verdict === "departs" ? effects : [] };
}

$("exercise-kind").addEventListener("change", exercise);
$("open-exercise").addEventListener("click", () => { if (practice.kind) { practice.wanted = "task"; run("exercise"); } });
$("next").addEventListener("click", () => {
  $("nth").value = practice.open.number + 1;
  practice.wanted = "task";
  run("exercise");
});
$("leave-exercise").addEventListener("click", endExercise);
$("answers").addEventListener("click", async () => {
  if (await question(word("askAnswers"), { yes: word("showAnswers") }) !== "yes") return;
  practice.wanted = "answers";
  await run("exercise");
});
$("practice").addEventListener("submit", event => {
  event.preventDefault();
  practice.wanted = { grade: answer() };
  run("exercise");
});
