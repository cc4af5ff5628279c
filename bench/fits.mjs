// One budget against fixed splits, as Markdown: fits.mjs FOVEA FOLDER [--gltfpack FILE | --gltf-transform FILE]
// [--evaluator FILE] MODEL... takes each model to 50, 25, 10 and 5 % of its triangles and its textures to 1, 1/2, 1/4 and
// 1/8 of their sides, with Fovea or with a peer (images then become WebP), fits the original into as many bytes, and
// compares both with the original. An evaluator is called as EVALUATOR REFERENCE TEST... --json FILE, once for a model.
// Minutes for each model, with an evaluator a quarter of an hour.
import { execFileSync } from 'node:child_process';
import { copyFileSync, mkdirSync, readFileSync, statSync } from 'node:fs';
import { basename, join } from 'node:path';

const words = process.argv.slice(2), options = {};
for (const name of ['--gltfpack', '--gltf-transform', '--evaluator']) {
  const at = words.indexOf(name);
  if (at >= 0) options[name] = words.splice(at, 2)[1];
}
const [fovea, folder, ...models] = words;
if (!fovea || !folder || models.length === 0) {
  console.error('usage: fits.mjs FOVEA FOLDER [--gltfpack FILE | --gltf-transform FILE] [--evaluator FILE] MODEL...');
  process.exit(2);
}
mkdirSync(folder, { recursive: true });
const quiet = { maxBuffer: 1 << 26, stdio: ['ignore', 'pipe', 'ignore'] };
const json = (...args) => JSON.parse(execFileSync(fovea, [...args, '--json'], quiet));
const few = join(folder, 'few.glb'), spare = join(folder, 'spare.glb');
const gltfpack = options['--gltfpack'], transform = options['--gltf-transform'], evaluator = options['--evaluator'];
const has_webp = gltfpack || transform;

function makeSplit(model, ratio, scale, split) {
  if (gltfpack) {
    // From npm it cannot write images, so Fovea encodes them, as it does for itself, without moving texels.
    execFileSync(gltfpack, ['-i', model, '-o', few, '-si', ratio, '-sv', '-kn', '-km'], quiet);
    execFileSync(fovea, ['texture', few, '-o', split, '--force', '--texture-scale', String(1 / scale), '--texture-format',
      'webp', '--warp', 'none', '--quantize'], quiet);
    return;
  }
  if (transform) {
    const images = json('info', model).images ?? [];
    const largest = Math.max(1, ...images.map((i) => Math.max(i.width ?? 1, i.height ?? 1)));
    const run = (verb, from, to, ...rest) => execFileSync(transform, [verb, from, to, ...rest], quiet);
    run('weld', model, few);
    run('simplify', few, spare, '--ratio', ratio, '--error', '1');
    run('resize', spare, few, '--width', String(largest / scale), '--height', String(largest / scale));
    run('webp', few, spare);
    run('quantize', spare, split);
    return;
  }
  execFileSync(fovea, ['simplify', model, '-o', few, '--force', '--ratio', ratio, '--allow-miss', '--quantize'], quiet);
  if (scale === 1) copyFileSync(few, split);
  else execFileSync(fovea, ['texture', few, '-o', split, '--force', '--texture-scale', String(1 / scale), '--quantize'], quiet);
}

/** Of each file {base, lit: {psnr, msssim, flip}} against the model, by Fovea's judge. */
function judged(model, ...files) {
  return json('compare', model, ...files, '--distance-samples', '0').results.map((r) => Object.fromEntries(
    [['base', r.base_color], ['lit', r.lit]].map(([name, s]) => [name,
      { psnr: s.psnr_foreground ?? Infinity, msssim: s.ms_ssim_foreground, flip: s.flip_foreground }])));
}

/** The same by another program. */
function evaluated(model, ...files) {
  const out = join(folder, 'evaluated.json');
  execFileSync(evaluator, [model, ...files, '--json', out, '--quiet'], quiet);
  const one = (s) => ({ psnr: s.psnr_fg === 'inf' ? Infinity : s.psnr_fg, msssim: s.msssim, flip: s.flip_fg });
  return JSON.parse(readFileSync(out)).tests.map((t) => ({ base: one(t.unlit), lit: one(t.lit) }));
}

const show = (s) => `${s.base.psnr.toFixed(2)} / ${s.lit.psnr.toFixed(2)} | ${s.lit.msssim.toFixed(4)} | ${s.lit.flip.toFixed(4)}`;
const better = {
  'PSNR, base colour and lit together': (a, b) => b.base.psnr + b.lit.psnr > a.base.psnr + a.lit.psnr,
  'MS-SSIM, lit': (a, b) => b.lit.msssim > a.lit.msssim,
  'FLIP, lit': (a, b) => b.lit.flip < a.lit.flip,
};
/** How many dB nearer to the original b is than a, of base colour and lit. */
const gain = (a, b) => (b.base.psnr + b.lit.psnr - a.base.psnr - a.lit.psnr) / 2;
const total = (numbers) => numbers.reduce((a, b) => a + b, 0);
const mean = (numbers) => total(numbers) / numbers.length;

console.log('| model | triangles | sides | bytes | split: triangles | PSNR base / lit | MS-SSIM | FLIP | fit: triangles | image bytes | PSNR base / lit | MS-SSIM | FLIP | s |');
console.log('|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|');
const sums = [];
for (const path of models) {
  const model = basename(path).replace(/\.[^.]*$/, '');
  const files = [], seconds = [], pairs = { judge: [], evaluator: [] };
  for (const ratio of ['0.5', '0.25', '0.1', '0.05']) {
    for (const scale of [1, 2, 4, 8]) {
      const split = join(folder, `split-${files.length}.glb`), fitted = join(folder, `fitted-${files.length}.glb`);
      makeSplit(path, ratio, scale, split);
      files.push(split, fitted);
      const bytes = statSync(split).size;
      const fit = json('fit', path, '-o', fitted, '--force', '--bytes', String(bytes), '--allow-miss',
        ...(has_webp ? ['--texture-format', 'webp'] : []));
      if (statSync(fitted).size > bytes) console.error(`${model}: no file of ${bytes} bytes`);
      const [a, b] = judged(path, split, fitted);
      pairs.judge.push([a, b]);
      seconds.push(fit.seconds);
      console.log(`| ${model} | ${ratio} | 1/${scale} | ${bytes} | ${json('info', split).totals?.triangles ?? ''} | ${show(a)} | ${fit.result.triangles} ` +
        `| ${fit.result.image_bytes} | ${show(b)} | ${fit.seconds.toFixed(0)} |`);
    }
  }
  if (evaluator) {
    const all = evaluated(path, ...files);
    for (let i = 0; i < all.length; i += 2) pairs.evaluator.push([all[i], all[i + 1]]);
  }
  const by = evaluator ? ['judge', 'evaluator'] : ['judge'];
  const ahead = by.flatMap((who) => Object.values(better).map((is) => pairs[who].filter(([a, b]) => is(a, b)).length));
  const gains = by.map((who) => pairs[who].map(([a, b]) => gain(a, b)).filter(Number.isFinite));
  sums.push({ model, cells: pairs.judge.length, ahead, gains, seconds });
}

const names = (evaluator ? ['', 'evaluator: '] : ['']).flatMap((who) => Object.keys(better).map((name) => who + name));
console.log(`\n| model | cells | ${names.join(' | ')} | mean gain, dB${evaluator ? ', evaluator' : ''} | worst | best | s each |\n|---|${'--:|'.repeat(names.length + 5)}`);
for (const { model, cells, ahead, gains, seconds } of sums) {
  const each = (of) => gains.map((g) => of(g).toFixed(2)).join(' / ');
  console.log(`| ${model} | ${cells} | ${ahead.join(' | ')} | ${each(mean)} | ${each((g) => Math.min(...g))} | ${each((g) => Math.max(...g))} ` +
    `| ${Math.min(...seconds).toFixed(0)} to ${Math.max(...seconds).toFixed(0)} |`);
}
console.log(`| all | ${total(sums.map((s) => s.cells))} | ${names.map((_, i) => total(sums.map((s) => s.ahead[i]))).join(' | ')} | | | | |`);
