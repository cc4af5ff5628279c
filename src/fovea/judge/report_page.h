#pragma once

// Private to judge: the page of a report without its data.

namespace fovea {

inline constexpr const char* kReportPage = R"html(<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>Fovea: comparison</title>
<style>
:root { color-scheme: light dark; --line: #8885; --mark: #2f7de1; }
body { font: 15px/1.45 system-ui, sans-serif; margin: 0 auto; max-width: 1080px; padding: 12px; }
h1 { font-size: 20px; margin: 4px 0 12px; overflow-wrap: anywhere; }
h2 { font-size: 16px; margin: 20px 0 6px; }
.scroll { overflow-x: auto; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; }
th, td { padding: 4px 8px; text-align: right; border-bottom: 1px solid var(--line); white-space: nowrap; }
th:first-child, td:first-child { text-align: left; max-width: 260px; overflow: hidden; text-overflow: ellipsis; }
tr.chosen td { background: #2f7de122; }
tbody tr { cursor: pointer; }
.bar { display: flex; flex-wrap: wrap; gap: 6px; margin: 10px 0; align-items: center; }
button { font: inherit; padding: 6px 12px; border: 1px solid var(--line); border-radius: 6px; background: none;
  color: inherit; cursor: pointer; }
button.on { background: var(--mark); border-color: var(--mark); color: #fff; }
.stage { position: relative; max-width: 720px; aspect-ratio: 1; background: #808080; user-select: none;
  touch-action: pan-y; cursor: ew-resize; overflow: hidden; border-radius: 6px; }
.stage img { position: absolute; inset: 0; width: 100%; height: 100%; }
.cut { position: absolute; top: 0; bottom: 0; width: 2px; background: #fff; box-shadow: 0 0 3px #000; }
.tag { position: absolute; bottom: 6px; padding: 1px 8px; border-radius: 9px; background: #000a; color: #fff;
  font-size: 13px; }
.left { left: 6px; } .right { right: 6px; }
.note { opacity: .75; font-size: 13px; }
svg { width: 100%; max-width: 720px; height: auto; }
svg text { font-size: 11px; fill: currentColor; }
.kinds { display: flex; height: 12px; width: 160px; border-radius: 3px; overflow: hidden; background: var(--line); }
.key i { display: inline-block; width: 10px; height: 10px; border-radius: 2px; margin: 0 4px 0 10px; }
.heat { display: inline-block; width: 120px; height: 10px; vertical-align: middle; border-radius: 3px;
  background: linear-gradient(90deg, #440154, #3b528b, #21918c, #5ec962, #fde725); }
</style>
</head>
<body>
<h1>How like <span id="reference"></span>?</h1>
<div class="scroll"><table id="scores"></table></div>
<p class="note">FLIP: 0 is identical, what an observer notices. MS-SSIM: 1 is identical. PSNR in dB. Outline: shared part of
the silhouettes. Surface: mean and largest distance, of the diagonal. Means over all views.</p>
<div class="bar" id="modes"></div>
<div class="bar"><button id="previous" aria-label="previous view">&#9664;</button><button id="next" aria-label="next view">&#9654;</button>
<span id="where"></span></div>
<div class="stage" id="stage"><img id="below" alt="the compared model"><img id="above" alt="the reference"><div class="cut" id="cut"></div>
<span class="tag left">reference</span><span class="tag right" id="tag"></span></div>
<p class="note" id="legend"></p>
<h2>FLIP over the views</h2>
<svg id="curve" viewBox="0 0 720 200" role="img" aria-label="FLIP of every view"></svg>
<h2>Bytes</h2>
<div class="scroll"><table id="bytes"></table></div>
<p class="note key" id="key"></p>
<script>
"use strict";
const D = /*DATA*/null;
const byId = (id) => document.getElementById(id);
const colors = ["#2f7de1", "#e1582f", "#2fa866", "#a04fd0", "#c09a1a", "#d0418a"];
const kinds = [["geometry", "#2f7de1"], ["images", "#e1a52f"], ["animation", "#2fa866"], ["other", "#999"]];
const modes = [["lit", "Lit"], ["base", "Base colour"], ["flip", "FLIP"], ["distance", "Distance"]];
let view = 0, test = 0, mode = "lit", cut = 0.5;

const count = (n) => n.toLocaleString("en");
const fixed = (x, digits) => (x === null ? "same" : x.toFixed(digits));
const share = (x) => (x === "" ? "-" : x === null ? "\u221e" : (100 * x).toPrecision(3) + " %");
const size = (n) => (n >= 1e6 ? (n / 1e6).toPrecision(3) + " MB" : n >= 1e3 ? (n / 1e3).toPrecision(3) + " kB" : n + " B");
const total = (m) => kinds.reduce((sum, [kind]) => sum + m.bytes[kind], 0);
function element(name, text, parent) {
  const e = document.createElement(name);
  if (text !== undefined) e.textContent = text;
  if (parent) parent.appendChild(e);
  return e;
}
function row(table, cells, heading) {
  const tr = element("tr", undefined, table);
  for (const cell of cells) {
    const td = element(heading ? "th" : "td", typeof cell === "object" ? undefined : cell, tr);
    if (typeof cell === "object") td.appendChild(cell);
  }
  tr.cells[0].title = tr.cells[0].textContent;
  return tr;
}

function fillTables() {
  byId("reference").textContent = D.reference.name;
  const head = element("thead", undefined, byId("scores"));
  row(head, ["", "triangles", "FLIP lit", "base", "MS-SSIM lit", "base", "PSNR lit", "base", "outline", "surface", "largest"], true);
  const body = element("tbody", undefined, byId("scores"));
  D.tests.forEach((t, i) => {
    const s = t.scores;
    const tr = row(body, [t.name, count(t.triangles), fixed(s.lit.flip, 4), fixed(s.base.flip, 4), fixed(s.lit.ms_ssim, 4),
      fixed(s.base.ms_ssim, 4), fixed(s.lit.psnr, 2), fixed(s.base.psnr, 2), fixed(s.iou, 4), share(s.mean), share(s.hausdorff)]);
    tr.cells[0].style.borderLeft = "4px solid " + colors[i % colors.length];
    tr.onclick = () => { test = i; show(); };
  });
  const bytes = byId("bytes"), most = Math.max(...[D.reference, ...D.tests].map(total), 1);
  row(element("thead", undefined, bytes), ["", "triangles", "vertices", "geometry", "images", "animation", "other", "all", ""], true);
  const rows = element("tbody", undefined, bytes);
  for (const m of [D.reference, ...D.tests]) {
    const bar = element("div");
    bar.className = "kinds";
    for (const [kind, color] of kinds) {
      const part = element("div", undefined, bar);
      part.style.width = 100 * m.bytes[kind] / most + "%";
      part.style.background = color;
    }
    row(rows, [m.name, count(m.triangles), count(m.vertices), ...kinds.map(([kind]) => size(m.bytes[kind])), size(total(m)), bar]);
  }
  for (const [kind, color] of kinds) {
    element("i", undefined, byId("key")).style.background = color;
    byId("key").append(kind);
  }
}

function svg(name, attributes, text) {
  const e = document.createElementNS("http://www.w3.org/2000/svg", name);
  for (const key in attributes) e.setAttribute(key, attributes[key]);
  if (text !== undefined) e.textContent = text;
  byId("curve").appendChild(e);
  return e;
}
function drawCurve() {
  byId("curve").replaceChildren();
  const n = D.views.length, left = 44, bottom = 180, top = 10;
  const most = Math.max(...D.tests.flatMap((t) => t.scores.views.map((v) => v.lit.flip)), 1e-6);
  const x = (i) => left + (n > 1 ? i / (n - 1) : 0.5) * (710 - left), y = (f) => bottom - f / most * (bottom - top);
  for (const f of [0, most / 2, most]) {
    svg("line", { x1: left, x2: 710, y1: y(f), y2: y(f), stroke: "#8885" });
    svg("text", { x: left - 6, y: y(f) + 4, "text-anchor": "end" }, f.toPrecision(2));
  }
  svg("line", { x1: x(view), x2: x(view), y1: top, y2: bottom, stroke: "#2f7de1" });
  D.tests.forEach((t, k) => {
    const color = colors[k % colors.length];
    svg("polyline", { fill: "none", stroke: color, "stroke-width": k === test ? 2.5 : 1.2,
      points: t.scores.views.map((v, i) => x(i) + "," + y(v.lit.flip)).join(" ") });
    t.scores.views.forEach((v, i) => {
      const dot = svg("circle", { cx: x(i), cy: y(v.lit.flip), r: 4, fill: color, cursor: "pointer" });
      dot.onclick = () => { view = i; test = k; show(); };
    });
  });
}

function show() {
  const v = D.views[view], t = v.tests[test], scores = D.tests[test].scores.views[view];
  byId("above").src = mode === "base" ? v.base : v.lit;
  byId("below").src = t[mode];
  const pass = mode === "base" ? scores.base : scores.lit;
  byId("where").textContent = `${v.name} (${view + 1} of ${D.views.length}): FLIP ${fixed(pass.flip, 4)}, MS-SSIM ${fixed(pass.ms_ssim, 4)}, PSNR ${fixed(pass.psnr, 2)}`;
  byId("tag").textContent = D.tests[test].name;
  byId("legend").innerHTML = mode === "flip" ? "FLIP of the lit picture: 0 <span class=heat></span> 1"
    : mode === "distance" ? `Distance to the reference: 0 <span class=heat></span> ${share(D.hottest)} of the diagonal and more` : "";
  [...byId("modes").children].forEach((b, i) => b.classList.toggle("on", modes[i][0] === mode));
  [...byId("scores").tBodies[0].rows].forEach((r, i) => r.classList.toggle("chosen", i === test));
  slide();
  drawCurve();
}
function slide() {
  byId("above").style.clipPath = `inset(0 ${100 * (1 - cut)}% 0 0)`;
  byId("cut").style.left = `calc(${100 * cut}% - 1px)`;
}
function step(by) { view = (view + by + D.views.length) % D.views.length; show(); }

for (const [id, label] of modes) element("button", label, byId("modes")).onclick = () => { mode = id; show(); };
byId("previous").onclick = () => step(-1);
byId("next").onclick = () => step(1);
byId("above").onload = () => {
  byId("stage").style.aspectRatio = byId("above").naturalWidth + " / " + byId("above").naturalHeight;
};
byId("stage").onpointermove = (e) => {
  if (e.pointerType !== "mouse" && e.buttons === 0) return;
  const box = byId("stage").getBoundingClientRect();
  cut = Math.min(Math.max((e.clientX - box.left) / box.width, 0), 1);
  slide();
};
byId("stage").onpointerdown = byId("stage").onpointermove;
document.onkeydown = (e) => { if (e.key === "ArrowLeft") step(-1); if (e.key === "ArrowRight") step(1); };
fillTables();
show();
</script>
</body>
</html>
)html";

}  // namespace fovea
