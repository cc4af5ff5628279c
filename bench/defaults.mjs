// What a simplification costs and gives by its options, as Markdown: defaults.mjs FOVEA FOLDER MODEL... simplifies each
// model to 10 and 3 % in several variants, from the quickest to the slowest, and compares with the original. The means say
// where --fast, the defaults and --best lie. Minutes for each model.
import { mkdirSync } from 'node:fs';
import { join } from 'node:path';
import { modelName, reporter, usage } from './commands.mjs';

const [fovea, folder, ...models] = process.argv.slice(2);
if (models.length === 0) usage('defaults.mjs FOVEA FOLDER MODEL...');
mkdirSync(folder, { recursive: true });
const variants = {
  'quadric (--fast)': ['--fast'],
  'auto (default)': [],
  'pictures of all triangles': ['--metric', 'image', '--metric-from', '16'],
  'pictures from 4 times the target': ['--metric', 'image', '--metric-from', '4'],
  'pictures of 512 pixels': ['--metric', 'image', '--view-size', '512'],
  'pictures from 4 times, 512 pixels': ['--metric', 'image', '--metric-from', '4', '--view-size', '512'],
  'saliency auto': ['--saliency', 'auto'],
  '--best': ['--best'],
};
const report = reporter(fovea);
const out = join(folder, 'out.glb');
const sums = Object.fromEntries(Object.keys(variants).map((name) => [name, { seconds: 0, base: 0, lit: 0, psnr: 0, msssim: 0, wins: 0 }]));
let cells = 0;
for (const model of models) {
  for (const ratio of ['0.1', '0.03']) {
    ++cells;
    let normal;
    for (const [name, options] of Object.entries(variants)) {
      const { seconds } = report('simplify', model, '-o', out, '--force', '--ratio', ratio, '--allow-miss', ...options);
      const { base_color: base, lit } = report('compare', model, out, '--distance-samples', '0').results[0];
      if (options.length === 0) normal = lit.flip_foreground;
      const sum = sums[name];
      sum.seconds += seconds;
      sum.base += base.flip_foreground;
      sum.lit += lit.flip_foreground;
      sum.psnr += lit.psnr_foreground;
      sum.msssim += lit.ms_ssim_foreground;
      sum.wins += lit.flip_foreground < (normal ?? -1);
      console.error(`${modelName(model)} ${ratio} ${name}: ${seconds.toFixed(1)} s, FLIP ${lit.flip_foreground.toFixed(4)}, ${lit.psnr_foreground.toFixed(2)} dB`);
    }
  }
}
console.log('| variant | s, mean | FLIP base | FLIP lit | PSNR lit, dB | MS-SSIM lit | better than the default by FLIP |');
console.log('|---|--:|--:|--:|--:|--:|--:|');
for (const [name, s] of Object.entries(sums)) {
  console.log(`| ${name} | ${(s.seconds / cells).toFixed(1)} | ${(s.base / cells).toFixed(4)} | ${(s.lit / cells).toFixed(4)} | ${(s.psnr / cells).toFixed(2)} ` +
    `| ${(s.msssim / cells).toFixed(4)} | ${name.startsWith('auto') ? '' : `${s.wins} of ${cells}`} |`);
}
