// Pictures at equal triangles against other simplifiers, as Markdown for docs/quality.md: quality.mjs FOVEA GLTFPACK
// FOLDER MODEL... takes each model to 10, 5 and 2 % with Fovea, gltfpack in two settings and Blender, if it is installed, and
// compares all with the original. In each cell Fovea's value stands before the best of the others that have no more
// triangles (within 3 %). Some ten seconds for each row.
import { existsSync, mkdirSync, rmSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { modelName, reporter, run, usage } from './commands.mjs';

const [fovea, gltfpack, folder, ...models] = process.argv.slice(2);
if (models.length === 0) usage('quality.mjs FOVEA GLTFPACK FOLDER MODEL...');
mkdirSync(folder, { recursive: true });
const report = reporter(fovea);

const hasBlender = (() => {
  try {
    run('blender', '--version');
    return true;
  } catch {
    return false;
  }
})();
const packed = (...more) => (model, out, ratio) =>
  run(gltfpack, '-i', model, '-o', out, '-si', `${ratio}`, '-se', '1', '-noq', '-kn', '-km', ...more);
const peers = {
  'gltfpack -sv': packed('-sv'),
  'gltfpack -sv -sp': packed('-sv', '-sp'),
  ...(hasBlender && {
    Blender: (model, out, ratio) => run('blender', '--background', '--python',
      join(dirname(fileURLToPath(import.meta.url)), 'peer_blender.py'), '--', model, out, `${ratio}`),
  }),
};

const measures = [['base_color', 'flip_foreground', -1], ['base_color', 'ms_ssim_foreground', 1], ['lit', 'flip_foreground', -1], ['lit', 'ms_ssim_foreground', 1]];
let cells = 0, won = 0, wonGltfpack = 0;
console.log(`Against ${Object.keys(peers).join(', ')}.\n`);
console.log('| model | to | triangles | seconds | base colour: FLIP | MS-SSIM | lit: FLIP | MS-SSIM | best of the others |');
console.log('|---|--:|--:|--:|---|---|---|---|---|');
for (const model of models) {
  for (const ratio of [0.1, 0.05, 0.02]) {
    const ours = join(folder, 'fovea.glb');
    const { seconds, after } = report('simplify', model, '-o', ours, '--force', '--allow-miss', '--ratio', `${ratio}`);
    const results = [];
    for (const [name, simplify] of Object.entries(peers)) {
      const out = join(folder, `${name.replace(/ /g, '')}.glb`);
      rmSync(out, { force: true });
      simplify(model, out, ratio);
      if (!existsSync(out)) continue;
      const { triangles } = report('info', out).totals;
      if (triangles > 0 && triangles <= 1.03 * after.triangles) results.push({ name, out });
    }
    const [mine, ...theirs] = report('compare', model, ours, ...results.map((r) => r.out), '--distance-samples', '0').results;
    const best = new Set();
    const row = measures.map(([pass, key, sign]) => {
      const values = theirs.map((t, i) => ({ name: results[i].name, value: t[pass][key] }));
      const top = (some) => some.reduce((a, b) => (a === undefined || sign * b.value > sign * a.value ? b : a), undefined);
      const other = top(values), packs = top(values.filter((v) => v.name.startsWith('gltfpack')));
      const own = mine[pass][key], wins = !other || sign * own >= sign * other.value;
      ++cells;
      won += wins;
      wonGltfpack += !packs || sign * own >= sign * packs.value;
      if (other) best.add(other.name);
      const show = (x, is) => (is ? `**${x.toFixed(4)}**` : x.toFixed(4));
      return `${show(own, wins)} / ${other ? show(other.value, !wins) : '–'}`;
    });
    console.log(`| ${modelName(model)} | ${100 * ratio} % | ${after.triangles} | ${seconds.toFixed(2)} | ${row.join(' | ')} | ${[...best].join(', ') || 'none left'} |`);
  }
}
console.log(`\nFovea is at least as good as the best of all others in ${won} of ${cells} cells, and as the best of gltfpack in ${wonGltfpack}.`);
