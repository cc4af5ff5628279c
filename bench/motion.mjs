// How far levels of detail are off while models move, as Markdown: motion.mjs FOVEA FOLDER MODEL... makes a chain of each animated
// model, without images and pictures, and measures its levels at a hundred moments of its animations, drawn at random, on 20,000
// points. Half a minute for each.
import { readdirSync, rmSync } from 'node:fs';
import { join } from 'node:path';
import { modelName, reporter, usage } from './commands.mjs';

const [fovea, folder, ...models] = process.argv.slice(2);
if (models.length === 0) usage('motion.mjs FOVEA FOLDER MODEL...');
const report = reporter(fovea);
const kMoments = 100;

/** The same numbers in [0, 1) in every run (Lehmer's generator). */
function randomNumbers(seed = 1) {
  let state = seed;
  return () => (state = (state * 48271) % 2147483647) / 2147483647;
}

const percent = (x) => `${(100 * x).toPrecision(3)} %`;
console.log('| model | level | triangles | error told, of the diagonal | farthest in motion | moments beyond what is told |');
console.log('|---|--:|--:|--:|--:|--:|');
for (const model of models) {
  const out = join(folder, `${modelName(model)}-motion`);
  rmSync(out, { recursive: true, force: true });
  const { levels } = report('lods', model, '-o', out, '--textures', 'keep', '--no-pictures');
  const files = readdirSync(out).filter((f) => /LOD[1-9]\.glb$/.test(f)).sort().map((f) => join(out, f));
  const { animations } = report('info', model), random = randomNumbers();
  const told = levels.slice(1).map((l) => l.error), seen = files.map(() => []);
  for (let i = 0; i < kMoments; ++i) {
    const animation = Math.floor(random() * animations.length), time = random() * animations[animation].duration_s;
    const { results } = report('compare', model, ...files, '--animation', `${animation}`, '--time', `${time}`, '--distance-samples', '20000',
      '--views', 'orbit', '--view-count', '1', '--view-size', '16');
    results.forEach(({ distance: d }, l) => seen[l].push(Math.max(d.forward.max, d.backward.max) / told[l].max_abs));
  }
  levels.slice(1).forEach((level, l) => console.log(
    `| ${l ? '' : modelName(model)} | ${l + 1} | ${level.triangles.toLocaleString('en')} | ${percent(told[l].max_rel)} ` +
    `| ${percent(Math.max(...seen[l]) * told[l].max_rel)} | ${seen[l].filter((x) => x > 1).length} of ${kMoments} |`));
}
