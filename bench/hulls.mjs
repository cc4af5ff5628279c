// Pruning against all pairs, as Markdown: hulls.mjs [--fineness N] FOVEA FOLDER MODEL... fits each model with one ladder of triangles
// and one of images, once by pruning and once by drawing all pairs, from the usual 24 views of 256 pixels, and says how far the way
// is behind the lower hull of all pairs at equal bytes, wherever one of them has a point, straight lines between points. A minute for
// each; finer ladders have N rungs for each usual one, and N² times the pairs. The curves stay in FOLDER.
import { mkdirSync, readFileSync } from 'node:fs';
import { join } from 'node:path';
import { modelName, reporter, takeOption, usage } from './commands.mjs';

const words = process.argv.slice(2), fineness = takeOption(words, '--fineness') ?? '1';
const [fovea, folder, ...models] = words;
if (models.length === 0) usage('hulls.mjs [--fineness N] FOVEA FOLDER MODEL...');
mkdirSync(folder, { recursive: true });
const report = reporter(fovea);
const out = join(folder, 'fitted.glb');

function way(model, search) {
  const curve = join(folder, `${modelName(model)}-${fineness}-${search}.json`);
  // A budget of a few bytes walks to the end.
  const { result, seconds } = report('fit', model, '-o', out, '--force', '--bytes', '1', '--allow-miss', '--views',
    'rhombicuboctahedron', '--view-size', '256', '--search', search, '--fineness', fineness, '--curve', curve);
  return { ...JSON.parse(readFileSync(curve)), drawn: result.pictures_of, seconds };
}

/** The loss of a hull, which falls in bytes, at so many bytes: along the straight line between its points. */
function lossAt(hull, bytes) {
  for (let i = 1; i < hull.length; ++i) {
    const [more, fewer] = [hull[i - 1], hull[i]];
    if (bytes < fewer.bytes) continue;
    const part = Math.min(1, (bytes - fewer.bytes) / (more.bytes - fewer.bytes));
    return fewer.loss + part * (more.loss - fewer.loss);
  }
  return hull.at(-1).loss;
}

console.log('| model | pairs | drawn by pruning | of all | points | behind the hull, dB: most | mean | s: pruning | all pairs |');
console.log('|---|--:|--:|--:|--:|--:|--:|--:|--:|');
for (const model of models) {
  const pruned = way(model, 'prune'), all = way(model, 'exhaustive');
  const bytes = [...pruned.path, ...all.path].filter((p) => p.loss > 0 && p.bytes >= pruned.path.at(-1).bytes).map((p) => p.bytes);
  const gaps = bytes.map((b) => {
    const best = lossAt(all.path, b);
    return best > 0 ? Math.max(0, 10 * Math.log10(lossAt(pruned.path, b) / best)) : 0;
  });
  console.log(`| ${modelName(model)} | ${all.all.length} | ${pruned.drawn} | ${(100 * pruned.drawn / all.all.length).toFixed(0)} % | ` +
    `${pruned.path.length} | ${Math.max(...gaps).toFixed(2)} | ${(gaps.reduce((a, b) => a + b, 0) / gaps.length).toFixed(2)} | ${pruned.seconds.toFixed(0)} | ${all.seconds.toFixed(0)} |`);
}
