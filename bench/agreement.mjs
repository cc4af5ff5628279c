// Whether Fovea's judge and another one rank the same, as Markdown for docs/judging.md: agreement.mjs FOVEA EVALUATOR FOLDER
// MODEL... takes each model to 50, 25, 10, 5 and 2 % of its triangles, and to 10 % in three other ways, and has all held
// against the original by both. EVALUATOR is called as in commands.mjs. Minutes for each model.
import { mkdirSync } from 'node:fs';
import { join } from 'node:path';
import { evaluated, modelName, reporter, usage } from './commands.mjs';

const [fovea, evaluator, folder, ...models] = process.argv.slice(2);
if (models.length === 0) usage('agreement.mjs FOVEA EVALUATOR FOLDER MODEL...');
mkdirSync(folder, { recursive: true });
const report = reporter(fovea);
const ways = [
  ...['0.5', '0.25', '0.1', '0.05', '0.02'].map((ratio) => ['--ratio', ratio]),
  ...[['--uv-weight', '0'], ['--normal-weight', '0'], ['--placement', 'half-edge']].map((way) => ['--ratio', '0.1', ...way]),
];

/** [name, value by Fovea, by the other], of a result of each. */
const measures = [
  ['FLIP, base colour', (r) => r.base_color.flip_foreground, (t) => t.unlit.flip_fg],
  ['FLIP, lit', (r) => r.lit.flip_foreground, (t) => t.lit.flip_fg],
  ['MS-SSIM, base colour', (r) => r.base_color.ms_ssim, (t) => t.unlit.msssim],
  ['MS-SSIM, lit', (r) => r.lit.ms_ssim, (t) => t.lit.msssim],
];

const mean = (values) => values.reduce((a, b) => a + b, 0) / values.length;

/** Places from the least value up; equal values share the mean of theirs. */
function ranks(values) {
  const sorted = [...values].sort((a, b) => a - b);
  return values.map((v) => (sorted.indexOf(v) + sorted.lastIndexOf(v)) / 2);
}

/** Rank correlation (Spearman) of pairs. */
function correlation(pairs) {
  const [a, b] = [0, 1].map((side) => ranks(pairs.map((pair) => pair[side])));
  const centre = (pairs.length - 1) / 2;
  const product = (x, y) => x.reduce((sum, value, i) => sum + (value - centre) * (y[i] - centre), 0);
  return product(a, b) / Math.sqrt(product(a, a) * product(b, b));
}

const pairs = measures.map(() => new Map());  // of each measure, of each model
for (const model of models) {
  const tests = ways.map((way, i) => {
    const out = join(folder, `agreement-${i}.glb`);
    report('simplify', model, '-o', out, '--force', '--allow-miss', ...way);
    return out;
  });
  const { results } = report('compare', model, ...tests, '--distance-samples', '0');
  const others = evaluated(evaluator, model, tests);
  measures.forEach(([, ours, theirs], m) => pairs[m].set(modelName(model), results.map((r, i) => [ours(r), theirs(others[i])])));
  console.error(`${modelName(model)}: ${pairs.map((p) => correlation(p.get(modelName(model))).toFixed(3)).join(', ')}`);
}

const count = ways.length * models.length;
console.log(`| | all ${count} | mean over models | models below 0.95 | mean difference | of |`);
console.log('|---|--:|--:|---|--:|--:|');
measures.forEach(([name], m) => {
  const all = [...pairs[m].values()].flat();
  const each = [...pairs[m]].map(([model, some]) => [model, correlation(some)]);
  const below = each.filter(([, rho]) => rho < 0.95).map(([model, rho]) => `${model} ${rho.toFixed(3)}`);
  console.log(`| ${name} | ${correlation(all).toFixed(4)} | ${mean(each.map(([, rho]) => rho)).toFixed(3)} | ${below.join(', ') || 'none'} ` +
    `| ${mean(all.map(([a, b]) => a - b)).toFixed(4)} | ${mean(all.map(([, b]) => b)).toFixed(4)} |`);
});
