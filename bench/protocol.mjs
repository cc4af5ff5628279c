// What another renderer says of the protocol of Yang et al. 2016, as Markdown: protocol.mjs FOVEA TEXTURE_BENCH EVALUATOR FOLDER
// MODEL... has `texture_bench --table 1` make each model few triangles and few texels in seven ways and keeps them in FOLDER,
// with what Fovea's own judge says; EVALUATOR, called as in commands.mjs, holds them against the original. Of a MODEL called vase
// the sample. Minutes for each model.
import { execFileSync } from 'node:child_process';
import { mkdirSync, writeFileSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { evaluated, modelName, run, usage } from './commands.mjs';

const [fovea, bench, evaluator, folder, ...models] = process.argv.slice(2);
if (models.length === 0) usage('protocol.mjs FOVEA TEXTURE_BENCH EVALUATOR FOLDER MODEL...');
mkdirSync(folder, { recursive: true });

const ways = ['qem+resize', 'lee+relax', 'yang', 'ours+resize', 'ours', 'ours+rebake', 'ours+normals'];
const passes = ['unlit', 'lit'];

console.log('| model | way | PSNR base | MS-SSIM base | PSNR lit | MS-SSIM lit |\n|---|---|--:|--:|--:|--:|');
const all = models.map((model) => {
  const name = modelName(model);
  const original = model === 'vase' ? join(folder, 'vase.glb') : model;
  if (model === 'vase') run(fovea, 'sample', 'vase', '-o', original, '--force');
  const table = execFileSync(bench, ['--table', '1', '--models', name, '--keep', folder], {
    env: { ...process.env, ...(model === 'vase' ? {} : { FOVEA_DATA: dirname(dirname(model)) }) },
    stdio: ['ignore', 'pipe', 'ignore'],
  });
  writeFileSync(join(folder, `${name}.md`), table);
  const tests = evaluated(evaluator, original, ways.map((way) => join(folder, `${name}-${way}.glb`)));
  tests.forEach((t, w) => {
    const scores = passes.map((pass) => `${t[pass].psnr_fg.toFixed(2)} | ${t[pass].msssim.toFixed(4)}`);
    console.log(`| ${w === 0 ? name : ''} | ${ways[w]} | ${scores.join(' | ')} |`);
  });
  return tests;
});

const mean = (values) => values.reduce((a, b) => a + b, 0) / values.length;
console.log(`\nMean gain over ${ways[0]} (${models.length} models), and of how many no other way has a better PSNR:\n`);
console.log('| way | PSNR base | MS-SSIM base | PSNR lit | MS-SSIM lit | first base | first lit |\n|---|--:|--:|--:|--:|--:|--:|');
ways.forEach((way, w) => {
  const gain = (pass, measure) => mean(all.map((tests) => tests[w][pass][measure] - tests[0][pass][measure]));
  const firsts = (pass) => all.filter((tests) => tests.every((t) => tests[w][pass].psnr_fg >= t[pass].psnr_fg)).length;
  console.log(`| ${way} | ${passes.map((p) => `${gain(p, 'psnr_fg').toFixed(2)} | ${gain(p, 'msssim').toFixed(4)}`).join(' | ')} | ` +
    `${passes.map(firsts).join(' | ')} |`);
});
