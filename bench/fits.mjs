// One budget against fixed splits, as Markdown: fits.mjs FOVEA FOLDER [--gltfpack FILE] [--evaluator FILE] MODEL...
// takes each model to 50, 25, 10 and 5 % of its triangles and its textures to 1, 1/2, 1/4 and 1/8 of their sides, with
// Fovea or with gltfpack (images then become WebP), fits the original into as many bytes, and compares both with the
// original. An evaluator is called as EVALUATOR REFERENCE TEST TEST --json FILE. Minutes for each model.
import { execFileSync } from 'node:child_process';
import { copyFileSync, mkdirSync, readFileSync, statSync } from 'node:fs';
import { basename, join } from 'node:path';

const words = process.argv.slice(2), options = {};
for (const name of ['--gltfpack', '--evaluator']) {
  const at = words.indexOf(name);
  if (at >= 0) options[name] = words.splice(at, 2)[1];
}
const [fovea, folder, ...models] = words;
if (!fovea || !folder || models.length === 0) {
  console.error('usage: fits.mjs FOVEA FOLDER [--gltfpack FILE] [--evaluator FILE] MODEL...');
  process.exit(2);
}
mkdirSync(folder, { recursive: true });
const quiet = { maxBuffer: 1 << 26, stdio: ['ignore', 'pipe', 'ignore'] };
const json = (...args) => JSON.parse(execFileSync(fovea, [...args, '--json'], quiet));
const few = join(folder, 'few.glb'), split = join(folder, 'split.glb'), fitted = join(folder, 'fitted.glb');
const gltfpack = options['--gltfpack'];

function makeSplit(model, ratio, scale) {
  if (gltfpack) {
    // From npm it cannot write images, so Fovea encodes them, as it does for itself, without moving texels.
    execFileSync(gltfpack, ['-i', model, '-o', few, '-si', ratio, '-sv', '-kn', '-km'], quiet);
    execFileSync(fovea, ['texture', few, '-o', split, '--force', '--texture-scale', String(1 / scale), '--texture-format',
      'webp', '--warp', 'none', '--quantize'], quiet);
    return;
  }
  execFileSync(fovea, ['simplify', model, '-o', few, '--force', '--ratio', ratio, '--allow-miss', '--quantize'], quiet);
  if (scale === 1) copyFileSync(few, split);
  else execFileSync(fovea, ['texture', few, '-o', split, '--force', '--texture-scale', String(1 / scale), '--quantize'], quiet);
}

/** [split, fitted], each {base, lit: {psnr, msssim, flip}} by Fovea's judge. */
function judged(model) {
  return json('compare', model, split, fitted, '--distance-samples', '0').results.map((r) => Object.fromEntries(
    [['base', r.base_color], ['lit', r.lit]].map(([name, s]) => [name,
      { psnr: s.psnr_foreground ?? Infinity, msssim: s.ms_ssim_foreground, flip: s.flip_foreground }])));
}

/** The same by another program. */
function evaluated(model) {
  const file = join(folder, 'evaluated.json');
  execFileSync(options['--evaluator'], [model, split, fitted, '--json', file, '--quiet'], quiet);
  const one = (s) => ({ psnr: s.psnr_fg === 'inf' ? Infinity : s.psnr_fg, msssim: s.msssim, flip: s.flip_fg });
  return JSON.parse(readFileSync(file)).tests.map((t) => ({ base: one(t.unlit), lit: one(t.lit) }));
}

const show = (s) => `${s.base.psnr.toFixed(2)} / ${s.lit.psnr.toFixed(2)} | ${s.lit.msssim.toFixed(4)} | ${s.lit.flip.toFixed(4)}`;
const better = {
  'PSNR, base colour and lit together': (a, b) => b.base.psnr + b.lit.psnr > a.base.psnr + a.lit.psnr,
  'MS-SSIM, lit': (a, b) => b.lit.msssim > a.lit.msssim,
  'FLIP, lit': (a, b) => b.lit.flip < a.lit.flip,
};
const wins = {}, rows = [];
let cells = 0;
const count = (name, model, won) => {
  for (const key of [name, `${name} ${model}`]) wins[key] = (wins[key] ?? 0) + won;
};

console.log('| model | triangles | sides | bytes | split: triangles | PSNR base / lit | MS-SSIM | FLIP | fit: triangles | image bytes | PSNR base / lit | MS-SSIM | FLIP | s |');
console.log('|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|');
for (const path of models) {
  const model = basename(path).replace(/\.[^.]*$/, '');
  let gain = 0, worst = Infinity, best = -Infinity, seconds = [];
  for (const ratio of ['0.5', '0.25', '0.1', '0.05']) {
    for (const scale of [1, 2, 4, 8]) {
      makeSplit(path, ratio, scale);
      const bytes = statSync(split).size;
      const fit = json('fit', path, '-o', fitted, '--force', '--bytes', String(bytes), '--allow-miss',
        ...(gltfpack ? ['--texture-format', 'webp'] : []));
      if (statSync(fitted).size > bytes) console.error(`${model}: no file of ${bytes} bytes`);
      const [a, b] = judged(path);
      ++cells;
      for (const [name, is] of Object.entries(better)) count(name, model, is(a, b));
      if (options['--evaluator']) {
        const [c, d] = evaluated(path);
        for (const [name, is] of Object.entries(better)) count(`evaluator: ${name}`, model, is(c, d));
      }
      const dB = (b.base.psnr + b.lit.psnr - a.base.psnr - a.lit.psnr) / 2;
      gain += Number.isFinite(dB) ? dB / 16 : 0;
      worst = Math.min(worst, dB);
      best = Math.max(best, dB);
      seconds.push(fit.seconds);
      console.log(`| ${model} | ${ratio} | 1/${scale} | ${bytes} | ${json('info', split).totals?.triangles ?? ''} | ${show(a)} | ${fit.result.triangles} ` +
        `| ${fit.result.image_bytes} | ${show(b)} | ${fit.seconds.toFixed(0)} |`);
    }
  }
  rows.push([model, gain, worst, best, Math.min(...seconds), Math.max(...seconds)]);
}
const names = Object.keys(wins).filter((key) => !rows.some(([model]) => key.endsWith(` ${model}`)));
console.log(`\n| model | ${names.join(' | ')} | mean gain, dB | worst | best | s each |\n|---|${'--:|'.repeat(names.length + 4)}`);
for (const [model, gain, worst, best, least, most] of rows) {
  console.log(`| ${model} | ${names.map((name) => wins[`${name} ${model}`]).join(' | ')} | ${gain.toFixed(2)} | ${worst.toFixed(2)} | ${best.toFixed(2)} | ${least.toFixed(0)} to ${most.toFixed(0)} |`);
}
console.log(`| of ${cells} | ${names.map((name) => wins[name]).join(' | ')} | | | | |`);
