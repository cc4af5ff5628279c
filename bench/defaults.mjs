// What a simplification costs and gives by its options, as Markdown: defaults.mjs [--only TEXT] FOVEA FOLDER MODEL... simplifies
// each model to 10 and 3 % in several variants, from the quickest to the slowest, and compares with the original. The means say
// where --fast, the defaults and --best lie. With --only the default and those whose names have the text. Minutes for each model.
import { mkdirSync } from 'node:fs';
import { join } from 'node:path';
import { modelName, reporter, takeOption, usage } from './commands.mjs';

const words = process.argv.slice(2), only = takeOption(words, '--only');
const [fovea, folder, ...models] = words;
if (models.length === 0) usage('defaults.mjs [--only TEXT] FOVEA FOLDER MODEL...');
mkdirSync(folder, { recursive: true });
const kDefault = '**the default**';
const variants = Object.fromEntries(Object.entries({
  '`--fast`: quadrics alone': ['--fast'],
  [kDefault]: [],
  '`--even-exposure`': ['--even-exposure'],
  'pictures from 1.5 times the target': ['--metric', 'image', '--metric-from', '1.5'],
  'from 4 times': ['--metric', 'image', '--metric-from', '4'],
  'from 16 times': ['--metric', 'image', '--metric-from', '16'],
  'pictures of 512²': ['--metric', 'image', '--view-size', '512'],
  'from 4 times, 512²': ['--metric', 'image', '--metric-from', '4', '--view-size', '512'],
  '`--saliency auto`': ['--saliency', 'auto'],
  '`--best`': ['--best'],
}).filter(([name]) => !only || name === kDefault || name.includes(only)));
const report = reporter(fovea);
const out = join(folder, 'out.glb');
const rows = Object.fromEntries(Object.keys(variants).map((name) => [name, []]));
let cells = 0;
for (const model of models) {
  for (const ratio of ['0.1', '0.03']) {
    ++cells;
    for (const [name, options] of Object.entries(variants)) {
      const { seconds } = report('simplify', model, '-o', out, '--force', '--ratio', ratio, '--allow-miss', ...options);
      const { base_color: base, lit } = report('compare', model, out, '--distance-samples', '0').results[0];
      rows[name].push({ seconds, 'flip base': base.flip_foreground, 'flip lit': lit.flip_foreground, 'psnr base': base.psnr_foreground, 'psnr lit': lit.psnr_foreground });
      console.error(`${modelName(model)} ${ratio} ${name}: ${seconds.toFixed(1)} s, FLIP ${lit.flip_foreground.toFixed(4)}, ${lit.psnr_foreground.toFixed(2)} dB`);
    }
  }
}

const mean = (values) => values.reduce((a, b) => a + b, 0) / values.length;
const normal = rows[kDefault];
console.log(`${models.length} models at 10 and 3 % of their triangles: ${models.map(modelName).join(', ')}.\n`);
console.log('| variant | s | FLIP base | ratio | FLIP lit | ratio | PSNR base, dB | lit | better than the default by FLIP, lit | the same |');
console.log('|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|');
for (const [name, own] of Object.entries(rows)) {
  const of = (what) => mean(own.map((r) => r[what]));
  // The geometric mean of the ratio to the default.
  const ratio = (what) => Math.exp(mean(own.map((r, i) => Math.log(r[what] / normal[i][what])))).toFixed(3);
  const count = (is) => own.filter((r, i) => is(r['flip lit'], normal[i]['flip lit'])).length;
  const against = own === normal ? ' | ' : `${count((a, b) => a < b)} of ${cells} | ${count((a, b) => a === b)}`;
  console.log(`| ${name} | ${of('seconds').toFixed(1)} | ${of('flip base').toFixed(4)} | ${ratio('flip base')} | ${of('flip lit').toFixed(4)} | ${ratio('flip lit')} ` +
    `| ${of('psnr base').toFixed(2)} | ${of('psnr lit').toFixed(2)} | ${against} |`);
}
