// What LOD chains are, as Markdown: lods.mjs FOVEA FOLDER MODEL... makes chains of each model with default options and
// prints their levels, then what chains cost without images and pictures, by counts and by the screen, and then what one file of all
// levels takes if they share vertices.
import { rmSync, statSync } from 'node:fs';
import { join } from 'node:path';
import { modelName, reporter, usage } from './commands.mjs';
import { readGlb } from './glb.mjs';

const [fovea, folder, ...models] = process.argv.slice(2);
if (models.length === 0) usage('lods.mjs FOVEA FOLDER MODEL...');
const report = reporter(fovea);
const bytes = (n) => (n < 1e6 ? `${(n / 1e3).toPrecision(3)} kB` : `${(n / 1e6).toPrecision(3)} MB`);
const seconds = (s) => `${s < 10 ? s.toFixed(1) : s.toFixed(0)} s`;

function lods(model, ...options) {
  const out = join(folder, modelName(model));
  rmSync(out, { recursive: true, force: true });
  return report('lods', model, '-o', out, ...options);
}

console.log('| model | level | triangles | geometry | images | file | error, of the diagonal | from distance | pixels high | FLIP, lit | time |');
console.log('|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|');
for (const model of models) {
  const chain = lods(model);
  chain.levels.forEach((l, i) => {
    const seen = l.pictures
      ? `${(100 * l.error.max_rel).toPrecision(2)} % | ${l.switch_distance.toPrecision(3)} | ${l.pictures.size} | ${l.pictures.lit.flip.toFixed(4)}`
      : ' | | | ';
    console.log(`| ${i ? '' : modelName(model)} | ${i} | ${l.triangles.toLocaleString('en')} | ${bytes(l.bytes.geometry)} | ${bytes(l.bytes.images)} ` +
      `| ${bytes(l.bytes.file)} | ${seen} | ${i ? '' : seconds(chain.seconds)} |`);
  });
}

const bare = ['--textures', 'keep', '--no-pictures'];
console.log('\n| model | without images and pictures | and by quadrics alone | by `--coverage 0.5,0.25,0.1`: triangles | time |');
console.log('|---|--:|--:|---|--:|');
for (const model of models) {
  const screen = lods(model, ...bare, '--coverage', '0.5,0.25,0.1');
  console.log(`| ${modelName(model)} | ${seconds(lods(model, ...bare).seconds)} | ${seconds(lods(model, ...bare, '--metric', 'quadric').seconds)} ` +
    `| ${screen.levels.slice(1).map((l) => l.triangles.toLocaleString('en')).join(', ')} | ${seconds(screen.seconds)} |`);
}

/** How many vertices a .glb holds: of each list of positions once. */
function vertices(file) {
  const { json } = readGlb(file);
  const lists = new Set(json.meshes.flatMap((m) => m.primitives.map((p) => p.attributes.POSITION)));
  return [...lists].reduce((sum, i) => sum + json.accessors[i].count, 0);
}

console.log('\n| model | vertices of level 0 | in the list | file with vertices of their own | shared | shared, `--quantize --compression meshopt` |');
console.log('|---|--:|--:|--:|--:|--:|');
for (const model of models) {
  const of = (name, ...options) => {
    const file = join(folder, `${modelName(model)}-${name}.glb`);
    return { file, finest: report('lods', model, '-o', file, '--force', ...bare, ...options).levels[0].split_vertices };
  };
  const own = of('own'), shared = of('shared', '--share-vertices');
  const small = of('small', '--share-vertices', '--quantize', '--compression', 'meshopt');
  console.log(`| ${modelName(model)} | ${shared.finest.toLocaleString('en')} | ${vertices(shared.file).toLocaleString('en')} ` +
    `| ${[own, shared, small].map(({ file }) => bytes(statSync(file).size)).join(' | ')} |`);
}
