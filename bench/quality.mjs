// Pictures at equal triangles against other simplifiers, as Markdown for docs/quality.md: quality.mjs [--evaluator FILE]
// [--shares 0.1,0.05,0.02] FOVEA GLTFPACK FOLDER MODEL... takes each model to shares of its triangles with Fovea, gltfpack in two
// settings and Blender, if it is installed, and compares all with the original, by Fovea's judge or an evaluator (commands.mjs). In
// each cell Fovea's value stands before the best of the others that have no more triangles (within 3 %). Then the means over all
// models at each share, also against quadrics alone. Some ten seconds for each row, with an evaluator a minute.
import { existsSync, mkdirSync, rmSync } from 'node:fs';
import { join } from 'node:path';
import { evaluated, modelName, reporter, run, takeOption, usage } from './commands.mjs';
import { simplifiers } from './simplifiers.mjs';

const words = process.argv.slice(2);
const evaluator = takeOption(words, '--evaluator'), shares = (takeOption(words, '--shares') ?? '0.1,0.05,0.02').split(',').map(Number);
const [fovea, gltfpack, folder, ...models] = words;
if (models.length === 0) usage('quality.mjs [--evaluator FILE] [--shares 0.1,0.05,0.02] FOVEA GLTFPACK FOLDER MODEL...');
mkdirSync(folder, { recursive: true });
const report = reporter(fovea);

const { hasBlender, peers } = simplifiers(gltfpack);
const all = {
  ...peers,
  quadrics: (model, out, share) => run(fovea, 'simplify', model, '-o', out, '--force', '--allow-miss', '--ratio', `${share}`, '--fast'),
};

/** Of each file [FLIP, MS-SSIM, PSNR of base colour, the same lit], over the model's own pixels. */
function scores(model, files) {
  if (!evaluator) {
    return report('compare', model, ...files, '--distance-samples', '0').results.map(({ base_color: base, lit }) =>
      [base, lit].flatMap((s) => [s.flip_foreground, s.ms_ssim_foreground, s.psnr_foreground ?? Infinity]));
  }
  return evaluated(evaluator, model, files).map(({ unlit, lit }) =>
    [unlit, lit].flatMap((s) => [s.flip_fg, s.msssim, s.psnr_fg === 'inf' ? Infinity : s.psnr_fg]));
}
const kTold = [[0, -1], [1, 1], [3, -1], [4, 1]];  // of the scores, and which way is better

let cells = 0, won = 0, wonGltfpack = 0;
const pairs = {};  // of each peer, of each share: [Fovea's scores, its scores]; of gltfpack the better by each score
console.log(`Against ${Object.keys(peers).join(', ')}${evaluator ? ', by another judge' : ''}.\n`);
console.log('| model | to | triangles | base colour: FLIP | MS-SSIM | lit: FLIP | MS-SSIM | best of the others |');
console.log('|---|--:|--:|---|---|---|---|---|');
for (const model of models) {
  for (const share of shares) {
    const ours = join(folder, 'fovea.glb');
    const { after } = report('simplify', model, '-o', ours, '--force', '--allow-miss', '--ratio', `${share}`);
    const results = [];
    for (const [name, simplify] of Object.entries(all)) {
      const out = join(folder, `${name.replace(/ /g, '')}.glb`);
      rmSync(out, { force: true });
      simplify(model, out, share);
      if (!existsSync(out)) continue;
      const { triangles } = report('info', out).totals;
      if (triangles > 0 && triangles <= 1.03 * after.triangles) results.push({ name, out });
    }
    const [mine, ...theirs] = scores(model, [ours, ...results.map((r) => r.out)]);
    theirs.forEach((values, i) => ((pairs[results[i].name] ??= {})[share] ??= []).push([mine, values]));
    const packed = theirs.filter((_, i) => results[i].name.startsWith('gltfpack'));
    if (packed.length > 0) {
      const better = [-1, 1, 1, -1, 1, 1].map((sign, m) => sign * Math.max(...packed.map((values) => sign * values[m])));
      ((pairs['the better gltfpack'] ??= {})[share] ??= []).push([mine, better]);
    }
    const best = new Set();
    const row = kTold.map(([at, sign]) => {
      const values = theirs.map((t, i) => ({ name: results[i].name, value: t[at] })).filter(({ name }) => name !== 'quadrics');
      const top = (some) => some.reduce((a, b) => (a === undefined || sign * b.value > sign * a.value ? b : a), undefined);
      const other = top(values), packs = top(values.filter((v) => v.name.startsWith('gltfpack')));
      const own = mine[at], wins = !other || sign * own >= sign * other.value;
      ++cells;
      won += wins;
      wonGltfpack += !packs || sign * own >= sign * packs.value;
      if (other) best.add(other.name);
      const show = (x, is) => (is ? `**${x.toFixed(4)}**` : x.toFixed(4));
      return `${show(own, wins)} / ${other ? show(other.value, !wins) : '–'}`;
    });
    console.log(`| ${modelName(model)} | ${100 * share} % | ${after.triangles} | ${row.join(' | ')} | ${[...best].join(', ') || 'none left'} |`);
  }
}
console.log(`\nFovea is at least as good as the best of all others in ${won} of ${cells} cells, and as the best of gltfpack in ${wonGltfpack}.\n`);

const mean = (values) => values.reduce((a, b) => a + b, 0) / values.length;
console.log('| to | against | models | FLIP base, ratio | FLIP lit, ratio | PSNR base, dB | PSNR lit, dB | better FLIP, of pictures |');
console.log('|--:|---|--:|--:|--:|--:|--:|--:|');
for (const share of shares) {
  for (const peer of ['quadrics', 'the better gltfpack', ...(hasBlender ? ['Blender'] : [])]) {
    const both = pairs[peer]?.[share];
    if (!both) continue;
    const ratio = (m) => Math.exp(mean(both.map(([a, b]) => Math.log(a[m] / b[m])))).toFixed(3);
    const gain = (m) => mean(both.map(([a, b]) => a[m] - b[m]).filter(Number.isFinite));
    const signed = (x) => `${x < 0 ? '' : '+'}${x.toFixed(2)}`;
    const better = [0, 3].reduce((sum, m) => sum + both.filter(([a, b]) => a[m] < b[m]).length, 0);
    console.log(`| ${100 * share} % | ${peer} | ${both.length} | ${ratio(0)} | ${ratio(3)} | ${signed(gain(2))} | ${signed(gain(5))} | ${better} of ${2 * both.length} |`);
  }
}
