// One budget against fixed splits, as Markdown: fits.mjs FOVEA FOLDER [--gltfpack FILE | --gltf-transform FILE]
// [--evaluator FILE] MODEL... takes each model to 50, 25, 10 and 5 % of its triangles and its textures to 1, 1/2, 1/4 and
// 1/8 of their sides, with Fovea or with a peer (images then become WebP), fits the original into as many bytes, and
// compares both with the original. An evaluator is called as EVALUATOR REFERENCE TEST... --json FILE, once for a model.
// Some minutes for each model.
import { copyFileSync, mkdirSync, statSync } from 'node:fs';
import { join } from 'node:path';
import { evaluated, modelName, reporter, run, takeOption, usage } from './commands.mjs';

const words = process.argv.slice(2);
const [gltfpack, transform, evaluator] = ['--gltfpack', '--gltf-transform', '--evaluator'].map((name) => takeOption(words, name));
const [fovea, folder, ...models] = words;
if (models.length === 0) usage('fits.mjs FOVEA FOLDER [--gltfpack FILE | --gltf-transform FILE] [--evaluator FILE] MODEL...');
mkdirSync(folder, { recursive: true });
const report = reporter(fovea);
const few = join(folder, 'few.glb'), spare = join(folder, 'spare.glb');
const has_webp = gltfpack || transform;

function makeSplit(model, ratio, scale, split) {
  if (gltfpack) {
    // From npm it cannot write images, so Fovea encodes them, as it does for itself, without moving texels.
    run(gltfpack, '-i', model, '-o', few, '-si', ratio, '-sv', '-kn', '-km');
    run(fovea, 'texture', few, '-o', split, '--force', '--texture-scale', `${1 / scale}`, '--texture-format', 'webp', '--warp', 'none',
      '--quantize');
    return;
  }
  if (transform) {
    const images = report('info', model).images ?? [];
    const largest = Math.max(1, ...images.map((i) => Math.max(i.width ?? 1, i.height ?? 1)));
    run(transform, 'weld', model, few);
    run(transform, 'simplify', few, spare, '--ratio', ratio, '--error', '1');
    run(transform, 'resize', spare, few, '--width', `${largest / scale}`, '--height', `${largest / scale}`);
    run(transform, 'webp', few, spare);
    run(transform, 'quantize', spare, split);
    return;
  }
  run(fovea, 'simplify', model, '-o', few, '--force', '--ratio', ratio, '--allow-miss', '--quantize');
  if (scale === 1) copyFileSync(few, split);
  else run(fovea, 'texture', few, '-o', split, '--force', '--texture-scale', `${1 / scale}`, '--quantize');
}

/** Of each file {base, lit: {psnr, msssim, flip}} against the model, by Fovea's judge. */
function judged(model, ...files) {
  return report('compare', model, ...files, '--distance-samples', '0').results.map((r) => Object.fromEntries(
    [['base', r.base_color], ['lit', r.lit]].map(([name, s]) => [name,
      { psnr: s.psnr_foreground ?? Infinity, msssim: s.ms_ssim_foreground, flip: s.flip_foreground }])));
}

/** The same by the evaluator. */
function judgedBy(evaluator, model, ...files) {
  const one = (s) => ({ psnr: s.psnr_fg === 'inf' ? Infinity : s.psnr_fg, msssim: s.msssim, flip: s.flip_fg });
  return evaluated(evaluator, model, files).map((t) => ({ base: one(t.unlit), lit: one(t.lit) }));
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

console.log('| model | triangles | sides | bytes | split: triangles | PSNR base / lit | MS-SSIM | FLIP | fit: triangles | image bytes | PSNR base / lit | MS-SSIM | FLIP |');
console.log('|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|');
const sums = [];
for (const path of models) {
  const model = modelName(path);
  const files = [], pairs = { judge: [], evaluator: [] };
  const splits = ['0.5', '0.25', '0.1', '0.05'].flatMap((ratio) => [1, 2, 4, 8].map((scale) => {
    const split = join(folder, `split-${ratio}-${scale}.glb`);
    makeSplit(path, ratio, scale, split);
    return { ratio, scale, split, bytes: statSync(split).size };
  }));
  // All budgets at once.
  const budgets = [...new Set(splits.map((s) => s.bytes))].sort((a, b) => b - a);
  const fit = report('fit', path, '-o', join(folder, 'fitted.glb'), '--force', '--bytes', budgets.join(), '--allow-miss',
    ...(has_webp ? ['--texture-format', 'webp'] : []));
  for (const { split, bytes } of splits) {
    const fitted = budgets.length > 1 ? join(folder, `fitted-${bytes}.glb`) : join(folder, 'fitted.glb');
    files.push(split, fitted);
    if (statSync(fitted).size > bytes) console.error(`${model}: no file of ${bytes} bytes`);
  }
  const scores = judged(path, ...files);
  for (let i = 0; i < scores.length; i += 2) pairs.judge.push([scores[i], scores[i + 1]]);
  for (const [i, { ratio, scale, split, bytes }] of splits.entries()) {
    const result = fit.results?.find((r) => r.budget === bytes) ?? fit.result;
    const [a, b] = pairs.judge[i];
    console.log(`| ${model} | ${ratio} | 1/${scale} | ${bytes} | ${report('info', split).totals?.triangles ?? ''} | ${show(a)} | ${result.triangles} ` +
      `| ${result.image_bytes} | ${show(b)} |`);
  }
  if (evaluator) {
    const all = judgedBy(evaluator, path, ...files);
    for (let i = 0; i < all.length; i += 2) pairs.evaluator.push([all[i], all[i + 1]]);
  }
  const by = evaluator ? ['judge', 'evaluator'] : ['judge'];
  const ahead = by.flatMap((who) => Object.values(better).map((is) => pairs[who].filter(([a, b]) => is(a, b)).length));
  const gains = by.map((who) => pairs[who].map(([a, b]) => gain(a, b)).filter(Number.isFinite));
  sums.push({ model, cells: pairs.judge.length, ahead, gains, seconds: fit.seconds });
}

const names = (evaluator ? ['', 'evaluator: '] : ['']).flatMap((who) => Object.keys(better).map((name) => who + name));
console.log(`\n| model | cells | ${names.join(' | ')} | mean gain, dB${evaluator ? ', evaluator' : ''} | worst | best | s, all fits |\n|---|${'--:|'.repeat(names.length + 5)}`);
for (const { model, cells, ahead, gains, seconds } of sums) {
  const each = (of) => gains.map((g) => of(g).toFixed(2)).join(' / ');
  console.log(`| ${model} | ${cells} | ${ahead.join(' | ')} | ${each(mean)} | ${each((g) => Math.min(...g))} | ${each((g) => Math.max(...g))} ` +
    `| ${seconds.toFixed(0)} |`);
}
console.log(`| all | ${total(sums.map((s) => s.cells))} | ${names.map((_, i) => total(sums.map((s) => s.ahead[i]))).join(' | ')} | | | | |`);
