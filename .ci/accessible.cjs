// Accessibility of pages by axe-core in jsdom, which draws nothing: contrast is left out.
const fs = require("fs"), { JSDOM } = require("jsdom"), axe = require("axe-core");
(async () => {
  let bad = 0;
  for (const file of process.argv.slice(2)) {
    const dom = new JSDOM(fs.readFileSync(file, "utf8"), { runScripts: "outside-only", pretendToBeVisual: true });
    dom.window.eval(axe.source);
    const found = await dom.window.axe.run(dom.window.document, { rules: { "color-contrast": { enabled: false } } });
    for (const one of found.violations) { bad++; console.log(file, one.id, one.help, one.nodes.map(n => n.html.slice(0, 80)).slice(0, 3)); }
    console.log(file, "passes", found.passes.length, "violations", found.violations.length, "incomplete", found.incomplete.map(i => i.id).join(","));
  }
  process.exit(bad ? 1 : 0);
})();
