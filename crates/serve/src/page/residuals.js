"use strict";
// Residuals of a calibration, or readings within its dwells: selected by brushing or in the list, left out of the file with a reason.

const residuals = { rows: [], chosen: new Set() }; // rows: [line, response, standardised residual]
const SVG = "http://www.w3.org/2000/svg";

function drawn(name, attributes, parent) {
  const element = document.createElementNS(SVG, name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  if (parent) parent.append(element);
  return element;
}

/// Shows the residuals, or readings of dwells, that come with a calibration; hides them where there are none by line.
function brush(rows, ofDwells) {
  residuals.rows = rows || [];
  residuals.chosen.clear();
  $("residuals").hidden = !residuals.rows.length;
  if (!residuals.rows.length) return;
  $("residuals").querySelector("summary").textContent = word(ofDwells ? "readings" : "residuals");
  $("of-rows").textContent = word(ofDwells ? "readingRows" : "rows");
  $("brush").setAttribute("aria-label", word(ofDwells ? "brushReadings" : "brush"));
  $("rows").replaceChildren(...residuals.rows.map(([line, response, size], at) => {
    const option = new Option(`${word("line", line)}, ${response}: ${size.toFixed(1).replace("-", "−")}`, at);
    return option;
  }));
  $("rows").size = Math.min(8, residuals.rows.length);
  plotResiduals();
  tellChosen();
}

const WIDE = 600, HIGH = 170, EDGE = 34;

function plotResiduals() {
  const svg = $("brush"), rows = residuals.rows;
  svg.replaceChildren();
  const lines = rows.map(row => row[0]), low = Math.min(...lines), high = Math.max(...lines);
  const most = Math.max(3, ...rows.map(row => Math.abs(row[2])));
  const x = line => EDGE + (WIDE - EDGE - 8) * (line - low) / (high - low || 1);
  const y = size => HIGH / 2 - (HIGH / 2 - 12) * size / most;
  for (const [size, kind] of [[-2, "edge"], [0, "zero"], [2, "edge"]]) {
    drawn("line", { class: kind, x1: EDGE, x2: WIDE, y1: y(size), y2: y(size) }, svg);
    drawn("text", { x: EDGE - 6, y: y(size) + 4, "text-anchor": "end" }, svg).textContent = String(size).replace("-", "−");
  }
  residuals.dots = rows.map(([line, , size]) => drawn("circle", { cx: x(line), cy: y(size), r: 3.5 }, svg));
  residuals.band = drawn("rect", { class: "band", x: 0, y: 0, width: 0, height: 0 }, svg);
}

/// Where a pointer is, in units of the picture.
function placeOf(event) {
  const point = new DOMPoint(event.clientX, event.clientY).matrixTransform($("brush").getScreenCTM().inverse());
  return [point.x, point.y];
}

function choosing(event) {
  const start = placeOf(event), svg = $("brush"), before = event.shiftKey ? new Set(residuals.chosen) : new Set();
  svg.setPointerCapture(event.pointerId);
  const move = now => {
    const [x, y] = placeOf(now), left = Math.min(x, start[0]) - 4, right = Math.max(x, start[0]) + 4, top = Math.min(y, start[1]) - 4, bottom = Math.max(y, start[1]) + 4;
    for (const [key, value] of Object.entries({ x: left, y: top, width: right - left, height: bottom - top })) residuals.band.setAttribute(key, value);
    residuals.chosen = new Set(before);
    residuals.dots.forEach((dot, at) => {
      const cx = Number(dot.getAttribute("cx")), cy = Number(dot.getAttribute("cy"));
      if (cx >= left && cx <= right && cy >= top && cy <= bottom) residuals.chosen.add(at);
    });
    tellChosen();
  };
  const end = () => {
    residuals.band.setAttribute("width", 0);
    svg.removeEventListener("pointermove", move);
  };
  move(event);
  svg.addEventListener("pointermove", move);
  svg.addEventListener("pointerup", end, { once: true });
}

/// The same rows in the picture and in the list.
function tellChosen() {
  residuals.dots.forEach((dot, at) => dot.classList.toggle("chosen", residuals.chosen.has(at)));
  [...$("rows").options].forEach((option, at) => { option.selected = residuals.chosen.has(at); });
  $("leave-out").disabled = !residuals.chosen.size;
  $("chosen").textContent = residuals.chosen.size ? word("chosen", chosenLines().length) : "";
}

function chosenLines() {
  const lines = [...residuals.chosen].map(at => residuals.rows[at][0]);
  return [...new Set(lines)].sort((a, b) => a - b);
}

/// Lines as the file writes them: 12, "20-25".
function ranges(lines) {
  const all = [];
  for (const line of lines) {
    const last = all[all.length - 1];
    if (last && last[1] === line - 1) last[1] = line; else all.push([line, line]);
  }
  return all.map(([first, last]) => first === last ? `${first}` : `"${first}-${last}"`).join(", ");
}

/// Writes the rows and the reason at the end of the text, where they stay with the experiment.
function leaveOut() {
  // In quotes of TOML, which are those of JSON but for control characters that nobody types.
  const reason = JSON.stringify($("reason").value.trim());
  const entry = `[[left_out]]\nlines = [${ranges(chosenLines())}]\nreason = ${reason}\n`;
  text.focus();
  text.setSelectionRange(text.value.length, text.value.length);
  complete.taking = true;
  document.execCommand("insertText", false, (/\n$/.test(text.value) ? "\n" : "\n\n") + entry);
  complete.taking = false;
  $("reason").value = "";
}

$("brush").addEventListener("pointerdown", choosing);
$("rows").addEventListener("change", () => {
  residuals.chosen = new Set([...$("rows").selectedOptions].map(option => Number(option.value)));
  tellChosen();
});
$("residuals-form").addEventListener("submit", event => { event.preventDefault(); if (residuals.chosen.size) leaveOut(); });
