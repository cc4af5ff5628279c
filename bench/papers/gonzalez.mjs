// González, Castelló, Chover, Sbert, Feixas: Viewpoint entropy-driven simplification method for textured triangle meshes (2009).
import { bold, count, fixed, kFromTheSide, table } from './workshop.mjs';

// The levels of the paper's figures 5 (tank), 6 (head) and 7 (swimmer), models of three to four thousand triangles.
const figures = [
  ['gonzalez-figure-5', (shop) => [['vase', shop.sample('vase', 0.056)]], [0.1, 0.05], []],
  ['gonzalez-figure-6', (shop) => shop.real('textured/Suzanne.glb'), [0.7, 0.5, 0.25], []],
  ['gonzalez-figure-7', (shop) => shop.real('textured/spot/spot.obj'), [0.35, 0.1], kFromTheSide],
];
// Twenty cameras and the whole way by the metric, as in the paper; the last is Fovea's default.
const ways = [
  ['triangles', ['--metric', 'polygon-entropy', '--view-size', '256']],
  ['regions', ['--metric', 'entropy', '--view-size', '256']],
  ['fovea', []],
];

function figure(name, models, ratios, look) {
  return (shop) => {
    const [found] = models(shop);
    if (!found) return undefined;
    const [model, file] = found, rows = [], scores = [];
    for (const ratio of ratios) {
      const results = ways.map(([way, options]) => shop.simplified(file, `${name}-${ratio}-${way}.glb`, '--ratio', `${ratio}`, ...options));
      rows.push([`${100 * ratio} %`, ...results.map((r, i) => shop.draw(r, `${name}-${100 * ratio}-${ways[i][0]}`, ...look))]);
      const judged = shop.compared(file, results, '--distance-samples', '0');
      for (const [pass, label] of [['base', 'base colour'], ['lit', 'lit']]) {
        const values = judged.map((s) => s[pass]);
        const cells = (key, digits, better) => values.map((v) => bold(fixed(v[key], digits), values.every((o) => !better(o[key], v[key]))));
        const [psnr, flip] = [cells('psnr', 2, (a, b) => a > b), cells('flip', 4, (a, b) => a < b)];
        scores.push([`${100 * ratio} %, ${label}`, ...values.map((_, i) => `${psnr[i]} / ${flip[i]}`)]);
      }
    }
    const head = ['', 'entropy of triangles', 'entropy of texture regions', 'Fovea, default'];
    return `${model}, ${count(shop.triangles(file))} triangles; the whole: ${shop.draw(file, `${name}-original`, ...look)}

${table(head, rows)}

PSNR in dB / FLIP, 24 views of 512²:

${table(head.map((h) => (h ? `${h}:` : h)), scores)}`;
  };
}

export default Object.fromEntries(figures.map(([name, ...rest]) => [name, figure(name, ...rest)]));
