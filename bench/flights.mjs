// Levels that follow a camera, as Markdown: flights.mjs [--only pictures|times] FOVEA MODEL... flies each model by every
// rule and prints how its frames look, and then what they take. Minutes for each model.
import { modelName, reporter, takeOption, usage } from './commands.mjs';

const words = process.argv.slice(2), only = takeOption(words, '--only');
const [fovea, ...models] = words;
if (models.length === 0 || ![undefined, 'pictures', 'times'].includes(only)) usage('flights.mjs [--only pictures|times] FOVEA MODEL...');
const clusters = (method, matching) => ['--select', 'clusters', '--clusters', '64', '--method', method, '--matching', matching];
const rules = [
  ['uniform', ['--select', 'uniform']],
  ['error', ['--select', 'error']],
  ['error, salient', ['--select', 'error', '--salient']],
  ['clusters: salient', clusters('salient', 'hold')],
  ['clusters: salient, raised', clusters('salient', 'raise')],
  ['clusters: propagative', clusters('propagative', 'hold')],
  ['clusters: k-means', clusters('kmeans', 'hold')],
];

const report = reporter(fovea);
const fly = (model, words) => report('fly', model, ...words);
const db = (x) => (x === null ? 'same' : x.toFixed(2));

function pictures() {
  console.log('| model | rule | ratio | triangles | cracks | PSNR mean | worst | MS-SSIM mean | worst | FLIP mean | worst |');
  console.log('|---|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|');
  for (const model of models) {
    for (const [rule, words] of rules) {
      for (const r of fly(model, ['--device', 'cpu', ...words]).ratios) {
        console.log(`| ${modelName(model)} | ${rule} | ${r.ratio} | ${r.triangles} | ${r.cracks} | ${db(r.psnr)} | ${db(r.psnr_worst)} ` +
          `| ${r.ms_ssim.toFixed(4)} | ${r.ms_ssim_worst.toFixed(4)} | ${r.flip.toFixed(4)} | ${r.flip_worst.toFixed(4)} |`);
      }
    }
  }
}

function times() {
  console.log('\n| model | device | ratio | all triangles, ms | CPU, ms | GPU, ms | all / CPU | all / GPU | CPU / GPU |');
  console.log('|---|---|--:|--:|--:|--:|--:|--:|--:|');
  for (const model of models) {
    for (const spread of ['1', '10']) {
      const flight = fly(model, ['--judge-every', '0', '--spread', spread]);
      for (const r of flight.ratios) {
        const ms = (x) => (x === null ? '-' : x.toFixed(1));
        const by = (a, b) => (a === null || b === null ? '-' : (a / b).toFixed(2));
        console.log(`| ${modelName(model)}${spread === '1' ? '' : `, a level every ${spread} frames`} | ${flight.device ?? '-'} | ${r.ratio} ` +
          `| ${ms(r.full_ms)} | ${ms(r.cpu_ms)} | ${ms(r.gpu_ms)} | ${by(r.full_ms, r.cpu_ms)} | ${by(r.full_ms, r.gpu_ms)} | ${by(r.cpu_ms, r.gpu_ms)} |`);
      }
    }
  }
}

if (only !== 'times') pictures();
if (only !== 'pictures') times();
