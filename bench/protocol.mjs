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

/** What the table of texture_bench says of each way: [PSNR base, MS-SSIM base, PSNR lit, MS-SSIM lit]. */
function ownScores(table) {
  const rows = table.split('\n').map((line) => line.split('|').map((cell) => cell.trim())).filter((cells) => cells.length === 10 && Number(cells[5]));
  return ways.map((way) => rows.find((cells) => cells[4] === way).slice(5, 9).map(Number));
}
const ours = [];  // of each model

console.log('| model | way | PSNR base | MS-SSIM base | PSNR lit | MS-SSIM lit |\n|---|---|--:|--:|--:|--:|');
const all = models.map((model) => {
  const name = modelName(model);
  const original = model === 'vase' ? join(folder, 'vase.glb') : model;
  if (model === 'vase') run(fovea, 'sample', 'vase', '-o', original, '--force');
  const table = execFileSync(bench, ['--table', '1', '--models', name, '--keep', folder], {
    env: { ...process.env, ...(model === 'vase' ? {} : { FOVEA_DATA: dirname(dirname(model)) }) },
    encoding: 'utf8', stdio: ['ignore', 'pipe', 'ignore'],
  });
  writeFileSync(join(folder, `${name}.md`), table);
  ours.push(ownScores(table));
  const tests = evaluated(evaluator, original, ways.map((way) => join(folder, `${name}-${way}.glb`)));
  tests.forEach((t, w) => {
    const scores = passes.map((pass) => `${t[pass].psnr_fg.toFixed(2)} | ${t[pass].msssim.toFixed(4)}`);
    console.log(`| ${w === 0 ? name : ''} | ${ways[w]} | ${scores.join(' | ')} |`);
  });
  return tests;
});

const mean = (values) => values.reduce((a, b) => a + b, 0) / values.length;
const theirs = all.map((tests) => tests.map((t) => passes.flatMap((pass) => [t[pass].psnr_fg, t[pass].msssim])));
console.log(`\nMean gain over ${ways[0]} (${models.length} models), by Fovea's judge (whole pictures) and by the other (pixels that either covers):\n`);
console.log('| way | by Fovea: PSNR base | MS-SSIM base | PSNR lit | MS-SSIM lit | by the other: PSNR base | MS-SSIM base | PSNR lit | MS-SSIM lit |');
console.log(`|---|${'--:|'.repeat(8)}`);
const signed = (x, digits) => `${x < 0 ? '−' : '+'}${Math.abs(x).toFixed(digits)}`;
ways.slice(1).forEach((way, i) => {
  const gains = [ours, theirs].flatMap((judge) => [0, 1, 2, 3].map((m) => signed(mean(judge.map((of) => of[i + 1][m] - of[0][m])), m % 2 ? 4 : 2)));
  console.log(`| ${way} | ${gains.join(' | ')} |`);
});
// Cells, of each model, judge and measure, in which a way is behind one of the published ones.
const published = [0, 1, 2];
ways.slice(3).forEach((way, i) => {
  const behind = [ours, theirs].flatMap((judge) => judge.flatMap((of, m) => [0, 1, 2, 3].filter((k) => published.some((w) => of[w][k] > of[i + 3][k])).map((k) =>
    `${modelName(models[m])} ${k % 2 ? 'MS-SSIM' : 'PSNR'} ${k < 2 ? 'base' : 'lit'} by ${judge === ours ? 'Fovea' : 'the other'}`)));
  console.log(`\n${way} is behind in ${behind.length} of ${models.length * 8} cells${behind.length ? `: ${behind.join(', ')}` : ''}.`);
});
