// A page to look at: sheets.mjs [--shares 0.1,0.05,0.02] FOVEA GLTFPACK FOLDER MODEL... simplifies each model to shares of its
// triangles with Fovea, gltfpack in two settings and Blender, if it is installed, and puts lit pictures from three sides of all of them
// below those of the original, into FOLDER/sheets.html. Some ten seconds for each model.
import { existsSync, mkdirSync, rmSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { modelName, reporter, run, takeOption, usage } from './commands.mjs';
import { simplifiers } from './simplifiers.mjs';

const words = process.argv.slice(2), shares = (takeOption(words, '--shares') ?? '0.1,0.05,0.02').split(',');
const [fovea, gltfpack, folder, ...models] = words;
if (models.length === 0) usage('sheets.mjs [--shares 0.1,0.05,0.02] FOVEA GLTFPACK FOLDER MODEL...');
mkdirSync(folder, { recursive: true });
const report = reporter(fovea);
const ways = {
  Fovea: (model, out, share) => run(fovea, 'simplify', model, '-o', out, '--force', '--allow-miss', '--ratio', share),
  ...simplifiers(gltfpack).peers,
};

/** A row of the page: three sides of a model, and how many triangles it has. */
function row(model, title, picture) {
  const { triangles } = report('info', model).totals;
  if (triangles === 0) return `<p>${title}: nothing is left`;
  run(fovea, 'render', model, '-o', join(folder, picture), '--force', '--views', 'orbit', '--view-count', '3', '--columns', '3', '--view-size', '300',
    '--samples', '3', '--background', '#ffffff');
  return `<p>${title}: ${triangles.toLocaleString('en')} triangles<br><img src="${encodeURIComponent(picture)}" width="900" height="300" alt="">`;
}

const page = ['<!doctype html><meta charset="utf-8"><title>Simplified models</title><style>body{font:15px sans-serif}</style>'];
for (const model of models) {
  const name = modelName(model);
  page.push(`<h1>${name}</h1>`, row(model, 'original', `${name}.webp`));
  for (const share of shares) {
    page.push(`<h2>${100 * share} %</h2>`);
    for (const [way, simplify] of Object.entries(ways)) {
      const stem = `${name}-${share}-${way.replace(/ /g, '')}`, out = join(folder, `${stem}.glb`);
      rmSync(out, { force: true });
      try {
        simplify(model, out, share);
      } catch {
        // It says nothing that a page could show.
      }
      page.push(existsSync(out) ? row(out, way, `${stem}.webp`) : `<p>${way}: fails`);
    }
  }
  console.error(name);
}
writeFileSync(join(folder, 'sheets.html'), page.join('\n'));
console.log(join(folder, 'sheets.html'));
