// Horbelt, Balmelli, Vetterli: Joint mesh and texture compression using marginal analysis (2001).
import { existsSync, readFileSync, writeFileSync } from 'node:fs';
import { fixed, table } from './workshop.mjs';

/** Runs the experiment, once: all pairs of each land with the ladders of the paper, and its pictures. */
let experiment;
function pairs(shop) {
  if (experiment) return experiment;
  const points = shop.file('pairs.csv');
  const report = shop.run('bench/terrain_bench', ['--points', points, '--views', shop.models]);
  const [head, ...lines] = readFileSync(points, 'utf8').trim().split('\n');
  const names = head.split(',');
  const rows = lines.map((line) => Object.fromEntries(line.split(',').map((cell, i) => [names[i], Number.isNaN(Number(cell)) ? cell : Number(cell)])));
  const lands = new Map();
  for (const row of rows.filter((r) => r.ladders === 'quadtree')) lands.set(row.land, [...(lands.get(row.land) ?? []), row]);
  return (experiment = { report, lands });
}
const stem = (land) => land.toLowerCase().replace(/ /g, '-');

/** A chart of 560 x 400 pixels with axes; `x` and `y` are {from, to, ticks, name, log}. */
class Chart {
  constructor(x, y) {
    this.parts = [];
    const place = ({ from, to, log }, low, high) => (v) => {
      const f = log ? Math.log : (n) => n;
      return low + ((f(v) - f(from)) / (f(to) - f(from))) * (high - low);
    };
    this.x = place(x, 60, 545);
    this.y = place(y, 355, 12);
    for (const t of x.ticks) this.parts.push(`<path d="M${this.x(t).toFixed(1)} 355v5" stroke="#333"/><text x="${this.x(t).toFixed(1)}" y="374" text-anchor="middle">${x.label(t)}</text>`);
    for (const t of y.ticks) this.parts.push(`<path d="M60 ${this.y(t).toFixed(1)}h-5" stroke="#333"/><text x="51" y="${(this.y(t) + 4).toFixed(1)}" text-anchor="end">${y.label(t)}</text>`);
    this.parts.push(`<path d="M60 12V355H545" fill="none" stroke="#333"/><text x="302" y="395" text-anchor="middle">${x.name}</text>`,
      `<text x="14" y="184" text-anchor="middle" transform="rotate(-90 14 184)">${y.name}</text>`);
  }
  line(points, style) {
    this.parts.push(`<path d="M${points.map(([x, y]) => `${this.x(x).toFixed(1)} ${this.y(y).toFixed(1)}`).join('L')}" fill="none" ${style}/>`);
  }
  write(file) {
    writeFileSync(file, `<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 560 400" width="560" height="400" font-family="sans-serif" font-size="12" fill="#333">
<rect width="560" height="400" fill="#fff"/>
${this.parts.join('\n')}
</svg>
`);
  }
}

const byBytes = (rows) => [...rows].sort((a, b) => a.bytes - b.bytes);
const kilobytes = (t) => `${t / 1000} kB`;
const decades = (from, to) => [1, 2, 5].flatMap((m) => [2, 3, 4, 5, 6].map((e) => m * 10 ** e)).filter((t) => t >= from && t <= to).sort((a, b) => a - b);
const range = (values) => [values.reduce((a, b) => Math.min(a, b)), values.reduce((a, b) => Math.max(a, b))];
const hullStyle = 'stroke="#d00" stroke-width="2.5"', foundStyle = 'stroke="#06c" stroke-width="1.5"';

/** Figure 4: a thin line for each texture, and the hull of all pairs. */
function figure4(shop) {
  return [...pairs(shop).lands].map(([land, rows]) => {
    const [low, high] = range(rows.map((r) => r.bytes)), [worst, best] = range(rows.map((r) => r.psnr));
    const ticks = []; for (let t = Math.ceil(worst / 5) * 5; t <= best; t += 5) ticks.push(t);
    const chart = new Chart({ from: low, to: high, log: true, ticks: decades(low, high), label: kilobytes, name: 'bytes of mesh and texture' },
      { from: worst, to: best, ticks, label: (t) => t, name: 'PSNR of the view, dB' });
    for (let t = 0; t <= rows.at(-1).texture; ++t)
      chart.line(byBytes(rows.filter((r) => r.texture === t)).map((r) => [r.bytes, r.psnr]), 'stroke="#67a" stroke-width="0.5"');
    chart.line(byBytes(rows.filter((r) => r.hull)).map((r) => [r.bytes, r.psnr]), hullStyle);
    chart.write(`${shop.images}/horbelt-4-${stem(land)}.svg`);
    return `${land}: ${rows.length} pairs; red is the hull of all.\n\n${shop.shown(`horbelt-4-${stem(land)}`, 'svg')}`;
  }).join('\n\n');
}

/** Figure 5: bands of equal PSNR over both costs, the best path and the one that was found. */
function figure5(shop) {
  return [...pairs(shop).lands].map(([land, rows]) => {
    const meshes = range(rows.map((r) => r.mesh_bytes)), textures = range(rows.map((r) => r.texture_bytes));
    const chart = new Chart({ from: meshes[0], to: meshes[1], log: true, ticks: decades(...meshes), label: kilobytes, name: 'bytes of the mesh' },
      { from: textures[0], to: textures[1], log: true, ticks: decades(...textures), label: kilobytes, name: 'bytes of the texture' });
    const at = (mesh, texture) => rows.find((r) => r.mesh === mesh && r.texture === texture);
    const lastMesh = rows.reduce((a, r) => Math.max(a, r.mesh), 0), lastTexture = rows.reduce((a, r) => Math.max(a, r.texture), 0);
    const [worst, best] = range(rows.map((r) => r.psnr));
    // A cell reaches from its pair to the next smaller one; cells of one band are one box.
    const band = (r) => Math.floor(r.psnr), boxes = [];
    for (let t = 0; t < lastTexture; ++t) {
      const [top, bottom] = [t, t + 1].map((n) => chart.y(at(0, n).texture_bytes));
      for (let m = 0; m < lastMesh;) {
        const first = m, here = band(at(m, t));
        while (m < lastMesh && band(at(m, t)) === here) ++m;
        const [left, right] = [m, first].map((n) => chart.x(at(n, 0).mesh_bytes));
        const share = (here - Math.floor(worst)) / Math.max(1, best - worst), light = 30 + 60 * share - (here % 2 ? 4 : 0);
        boxes.push(`<rect x="${left.toFixed(1)}" y="${top.toFixed(1)}" width="${(right - left).toFixed(1)}" height="${(bottom - top).toFixed(1)}" fill="hsl(${(260 - 200 * share).toFixed(0)} 60% ${light.toFixed(0)}%)"/>`);
      }
    }
    chart.parts.unshift(...boxes);
    const path = (key) => byBytes(rows.filter((r) => r[key])).map((r) => [r.mesh_bytes, r.texture_bytes]);
    chart.line(path('hull'), hullStyle);
    chart.line(path('prune_ahead'), foundStyle);
    chart.write(`${shop.images}/horbelt-5-${stem(land)}.svg`);
    return `${land}: a band for each dB, from ${fixed(worst, 0)} (dark) to ${fixed(best, 0)}; red is the hull of all pairs, blue the way that pruning found.\n\n${shop.shown(`horbelt-5-${stem(land)}`, 'svg')}`;
  }).join('\n\n');
}

/** The bench's own table of what each way drew and how far behind it stays. */
function path(shop) {
  const blocks = pairs(shop).report.split('### ').slice(1);
  return blocks.map((block) => {
    const [land] = block.split('\n');
    const lines = block.split('**quadtree, wavelets**')[1].split('\n');
    const from = lines.findIndex((l) => l.startsWith('| way'));
    const to = lines.findIndex((l, i) => i > from && l === '');
    return `${land}:\n\n${lines.slice(from, to).join('\n')}`;
  }).join('\n\n');
}

/** Figure 6: three pairs of the same bytes. */
function figure6(shop) {
  const rows = [];
  for (const [land] of pairs(shop).lands) {
    const shown = ['fine-texture', 'best', 'fine-mesh'].map((kind) => {
      const file = shop.file(`${land} ${kind}.json`);
      if (!existsSync(file)) throw new Error(`terrain_bench wrote no ${file}`);
      const pair = JSON.parse(readFileSync(file, 'utf8')), picture = `horbelt-6-${stem(land)}-${kind}`;
      writeFileSync(`${shop.images}/${picture}.jpg`, readFileSync(shop.file(`${land} ${kind}.jpg`)));
      return `${shop.shown(picture, 'jpg')}<br>mesh ${kilobytes(Math.round(pair.mesh_bytes / 100) * 100)}, texture ${kilobytes(Math.round(pair.texture_bytes / 100) * 100)}: ${fixed(pair.psnr)} dB`;
    });
    rows.push([land, ...shown]);
  }
  return table(['', 'most for the texture', 'the best', 'most for the mesh'], rows);
}

/** Without real land the page would lose that of Puget Sound. */
const onBothLands = (part) => (shop) => (shop.data ? part(shop) : undefined);

export default {
  'horbelt-figure-4': onBothLands(figure4), 'horbelt-figure-5': onBothLands(figure5), 'horbelt-path': onBothLands(path),
  'horbelt-figure-6': onBothLands(figure6),
};
