// One budget against fixed splits, as Markdown: fits.mjs FOVEA FOLDER MODEL... simplifies each model to a ratio and
// scales its textures, then fits the model into as many bytes and compares both with the original. Minutes for each.
import { execFileSync } from 'node:child_process';
import { copyFileSync, mkdirSync, statSync } from 'node:fs';
import { basename, join } from 'node:path';

const [fovea, folder, ...models] = process.argv.slice(2);
if (!fovea || !folder || models.length === 0) {
  console.error('usage: fits.mjs FOVEA FOLDER MODEL...');
  process.exit(2);
}
mkdirSync(folder, { recursive: true });
const run = (...words) => execFileSync(fovea, words, { maxBuffer: 1 << 26, stdio: ['ignore', 'pipe', 'ignore'] });
const json = (...words) => JSON.parse(run(...words, '--json'));
const few = join(folder, 'few.glb'), split = join(folder, 'split.glb'), fitted = join(folder, 'fitted.glb');
const score = (model, file) => json('compare', model, file, '--distance-samples', '0').results[0];
const show = (s) => `${s.base_color.psnr_foreground.toFixed(2)} / ${s.lit.psnr_foreground.toFixed(2)} | ${s.lit.ms_ssim_foreground.toFixed(4)} | ${s.lit.flip_foreground.toFixed(4)}`;

console.log('| model | triangles | sides of textures | bytes | split: PSNR base / lit | MS-SSIM | FLIP | fit: triangles | image bytes | PSNR base / lit | MS-SSIM | FLIP | s |');
console.log('|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|');
let cells = 0, better = { psnr: 0, ms_ssim: 0, flip: 0 };
for (const model of models) {
  for (const ratio of ['0.5', '0.25', '0.1', '0.05']) {
    for (const scale of [1, 2, 4, 8]) {
      run('simplify', model, '-o', few, '--force', '--ratio', ratio, '--allow-miss', '--quantize');
      if (scale === 1) copyFileSync(few, split);
      else run('texture', few, '-o', split, '--force', '--texture-scale', String(1 / scale), '--quantize');
      const bytes = statSync(split).size;
      const fit = json('fit', model, '-o', fitted, '--force', '--bytes', String(bytes), '--allow-miss');
      const a = score(model, split), b = score(model, fitted);
      ++cells;
      const psnr = (s) => s.base_color.psnr_foreground + s.lit.psnr_foreground;
      better.psnr += psnr(b) > psnr(a);
      better.ms_ssim += b.lit.ms_ssim_foreground > a.lit.ms_ssim_foreground;
      better.flip += b.lit.flip_foreground < a.lit.flip_foreground;
      console.log(`| ${basename(model).replace(/\.[^.]*$/, '')} | ${ratio} | 1/${scale} | ${bytes} | ${show(a)} | ${fit.result.triangles} ` +
        `| ${fit.result.image_bytes} | ${show(b)} | ${fit.seconds.toFixed(0)} |`);
    }
  }
}
console.log(`\n${cells} cells; fit is better by PSNR (base and lit together) in ${better.psnr}, by MS-SSIM (lit) in ${better.ms_ssim}, by FLIP (lit) in ${better.flip}.`);
