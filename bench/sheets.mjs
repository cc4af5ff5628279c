// A page to look at: sheets.mjs [--shares 0.1,0.05,0.02] [--options 'OPTIONS;OPTIONS...'] [--view-size 300] FOVEA GLTFPACK FOLDER
// MODEL... simplifies each model to shares of its triangles with Fovea, by default and by each of the lists of options, with gltfpack
// in two settings and with Blender, if it is installed, and puts lit pictures from three sides of all of them below those of the
// original, into FOLDER/sheets.html. How far each is from the original is on the page, and printed as Markdown. Some twenty
// seconds for each model, and twice as much as each list of options takes.
import { existsSync, mkdirSync, rmSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { modelName, reporter, run, takeOption, usage } from './commands.mjs';
import { simplifiers } from './simplifiers.mjs';

const words = process.argv.slice(2), shares = (takeOption(words, '--shares') ?? '0.1,0.05,0.02').split(',');
const lists = (takeOption(words, '--options') ?? '').split(';').map((list) => list.trim()).filter(Boolean);
const pixels = Number(takeOption(words, '--view-size') ?? 300);
const [fovea, gltfpack, folder, ...models] = words;
if (models.length === 0) usage("sheets.mjs [--shares 0.1,0.05,0.02] [--options 'OPTIONS;OPTIONS...'] [--view-size 300] FOVEA GLTFPACK FOLDER MODEL...");
mkdirSync(folder, { recursive: true });
const report = reporter(fovea);
const simplify = (...options) => (model, out, share) =>
  run(fovea, 'simplify', model, '-o', out, '--force', '--allow-miss', '--ratio', share, ...options);
const ways = { Fovea: simplify(), ...simplifiers(gltfpack).peers };
for (const list of lists) ways[`Fovea ${list}`] = simplify(...list.split(/ +/));

/** A row of the page: three sides of a model, and what is told of it. */
function row(model, title, picture) {
  run(fovea, 'render', model, '-o', join(folder, picture), '--force', '--views', 'orbit', '--view-count', '3', '--columns', '3', '--view-size', `${pixels}`,
    '--samples', '3', '--background', '#ffffff');
  return `<p>${title}<br><img src="${encodeURIComponent(picture)}" width="${3 * pixels}" height="${pixels}" alt="">`;
}
const triangles = (model) => report('info', model).totals.triangles;

const page = ['<!doctype html><meta charset="utf-8"><title>Simplified models</title><style>body{font:15px sans-serif}</style>'];
console.log('| model | share | by | triangles | FLIP base | lit | PSNR base, dB | lit |\n|---|--:|---|--:|--:|--:|--:|--:|');
for (const model of models) {
  const name = modelName(model);
  page.push(`<h1>${name}</h1>`, row(model, `original: ${triangles(model).toLocaleString('en')} triangles`, `${name}.webp`));
  for (const share of shares) {
    page.push(`<h2>${100 * share} %</h2>`);
    for (const [way, make] of Object.entries(ways)) {
      const stem = `${name}-${share}-${way.replace(/ /g, '')}`, out = join(folder, `${stem}.glb`);
      rmSync(out, { force: true });
      try {
        make(model, out, share);
      } catch {
        // It says nothing that a page could show.
      }
      const left = existsSync(out) ? triangles(out) : 0;
      let told = ' | | | |';
      if (left > 0) {
        const { base_color: base, lit } = report('compare', model, out, '--distance-samples', '0').results[0];
        const db = (s) => (s.psnr_foreground ?? Infinity).toFixed(2);
        told = `${base.flip_foreground.toFixed(4)} | ${lit.flip_foreground.toFixed(4)} | ${db(base)} | ${db(lit)} |`;
        page.push(row(out, `${way}: ${left.toLocaleString('en')} triangles, FLIP ${lit.flip_foreground.toFixed(4)}`, `${stem}.webp`));
      } else {
        page.push(`<p>${way}: ${existsSync(out) ? 'no triangles' : 'fails'}`);
      }
      console.log(`| ${name} | ${100 * share} % | ${way} | ${left} | ${told}`);
    }
  }
  console.error(name);
}
writeFileSync(join(folder, 'sheets.html'), page.join('\n'));
console.log(`\n${join(folder, 'sheets.html')}`);
