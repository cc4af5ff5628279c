// Yang, Li, Wang, Xu: Visual saliency guided textured model simplification (2016).
import { existsSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { bold, count, fixed, kFromTheSide, signed, table } from './workshop.mjs';
import { readGlb } from '../glb.mjs';

// Table 2 of the paper: PSNR and MS-SSIM of its three ways, and the colours of the texture.
const paper = [
  ['vase', 5.4, 101371, [29.7443, 32.2861, 34.1341], [0.8661, 0.8870, 0.9325]],
  ['horse', 6.4, 7894, [38.6988, 40.9702, 41.1091], [0.9010, 0.9221, 0.9342]],
  ['girl', 7.3, 99473, [39.0627, 41.5688, 42.9627], [0.9295, 0.9584, 0.9793]],
  ['wolf', 7.9, 16167, [38.1002, 39.7663, 40.6375], [0.9142, 0.9761, 0.9979]],
];
const ways = ['qem+resize', 'lee+relax', 'yang', 'ours+rebake', 'ours+normals'];
const tabled = ['vase', 'AntiqueCameraBody', 'Avocado', 'BoomBox', 'Duck', 'MaterialsVariantsShoe', 'WaterBottle'];

/** Runs the protocol and keeps all models; rows of texture_bench as {model, colors, triangles, way, base, lit}. */
function protocol(shop) {
  const folder = shop.file('table-2'), file = `${folder}.md`;
  rmSync(folder, { recursive: true, force: true });
  writeFileSync(file, shop.run('bench/texture_bench', ['--table', '1', '--models', tabled.join(), '--keep', folder]));
  const rows = [];
  for (const line of readFileSync(file, 'utf8').split('\n')) {
    const cells = line.split('|').map((c) => c.trim());
    if (cells.length !== 10 || !Number(cells[5])) continue;
    const last = rows.at(-1), [, model, colors, triangles, way, ...s] = cells;
    rows.push({
      model: model || last.model, colors: model ? Number(colors) : last.colors, triangles: Number(triangles), way,
      base: { psnr: Number(s[0]), msssim: Number(s[1]) }, lit: { psnr: Number(s[2]), msssim: Number(s[3]) },
    });
  }
  return rows;
}

function table2(shop) {
  if (!shop.data) return undefined;
  const rows = protocol(shop);
  const models = [...new Set(rows.map((r) => r.model))];
  const line = (name, colors, psnr, msssim) => {
    const best = (values) => values.map((v, i) => [v, i]).reduce((a, b) => (b[0] > a[0] ? b : a))[1];
    const show = (values, digits) => values.map((v, i) => bold(fixed(v, digits), i === best(values)));
    const [p, m] = [show(psnr, 2), show(msssim, 4)];
    return [name, count(colors), ...ways.map((_, i) => (p[i] === undefined ? '' : `${p[i]} / ${m[i]}`))];
  };
  const sums = ways.map(() => ({ base: [0, 0], lit: [0, 0] }));
  const ours = ['base', 'lit'].map((pass) => models.map((model) => {
    const of = (way) => rows.find((r) => r.model === model && r.way === way);
    ways.forEach((way, i) => {
      sums[i][pass][0] += of(way)[pass].psnr - of(ways[0])[pass].psnr;
      sums[i][pass][1] += of(way)[pass].msssim - of(ways[0])[pass].msssim;
    });
    return line(model, of(ways[0]).colors, ways.map((w) => of(w)[pass].psnr), ways.map((w) => of(w)[pass].msssim));
  }));
  const head = ['model', 'CD:', 'quadrics, resized:', 'Lee and relaxation:', 'Yang et al.:', 'Fovea:', 'Fovea, new normal maps:'];
  const mean = (pass) => ['mean gain', '', ...sums.map((s) => `${signed(s[pass][0] / models.length)} / ${signed(s[pass][1] / models.length, 4)}`)];
  const gain = (of) => [1, 2].map((i) => paper.reduce((sum, row) => sum + of(row)[i] - of(row)[0], 0) / paper.length);
  const [psnr, msssim] = [gain((r) => r[3]), gain((r) => r[4])];
  return `The paper (5.4 to 7.9 % of the triangles, 0.4 % of the texels), PSNR in dB / MS-SSIM:

${table(head.slice(0, 5), [...paper.map(([name, , colors, p, m]) => line(name, colors, p, m).slice(0, 5)),
    ['mean gain', '', '', ...[0, 1].map((i) => `${signed(psnr[i])} / ${signed(msssim[i], 4)}`)]])}

Here (6 % of the triangles, 1/16 of the sides, which is 0.4 % of the texels; 24 views of 512²), base colour:

${table(head, [...ours[0], mean('base')])}

The same with light:

${table(head, [...ours[1], mean('lit')])}`;
}

/** Figure 12: the models of table 2 beside each other. Needs that table's models. */
function figure12(shop) {
  const pictures = [['vase', shop.sample('vase')], ...shop.real('textured/AntiqueCameraBody.glb', 'textured/WaterBottle.glb', 'textured/BoomBox.glb')];
  const kept = (name, way) => shop.file(`table-2/${name}-${way}.glb`);
  if (pictures.length < 4) return undefined;
  if (!existsSync(kept('vase', ways[0]))) throw new Error('yang-figure-12 shows the models of yang-table-2: run that first');
  return table(['', 'original', 'quadrics, resized', 'Lee and relaxation', 'Yang et al.', 'Fovea'], pictures.map(([name, file]) => [name,
    ...[file, ...ways.slice(0, 4).map((way) => kept(name, way))].map((model, i) =>
      shop.draw(model, `yang-12-${name}-${i}`, '--view-size', '170', '--elevation', '15'))]));
}

/** Figure 4: what stands out of shape alone. */
function figure4(shop) {
  const scans = shop.real('scans/armadillo.ply', 'scans/nefertiti.ply');
  if (scans.length < 2) return undefined;
  return table(['', 'scan', 'mean curvature', 'Lee et al.', 'Yang et al., geometry', 'Fovea, default'], scans.map(([name, file]) => {
    const map = (picture, absolute, ...options) => {
      const field = shop.file(`${name}-${picture}.csv`);
      shop.fovea('saliency', file, '-o', field, '--force', ...options);
      // Curvature has a sign; what stands out is its size, up to what all but a hundredth have.
      const [head, ...values] = readFileSync(field, 'utf8').trim().split('\n');
      const sizes = values.map((v) => (absolute ? Math.abs(v) : Number(v)));
      const most = [...sizes].sort((a, b) => a - b)[Math.floor(0.99 * sizes.length)];
      writeFileSync(field, [head, ...sizes.map((v) => Math.min(v, most))].join('\n'));
      return shop.draw(file, `yang-4-${name}-${picture}`, '--pass', 'field', '--field', field);
    };
    return [name, shop.draw(file, `yang-4-${name}`),
      map('curvature', true, '--preset', 'lee', '--map', 'curvature'), map('lee', false, '--preset', 'lee'),
      map('yang', false, '--preset', 'yang', '--map', 'geometry'), map('fovea', false)];
  }));
}

/** Figure 8: the maps of the unified saliency. */
function figure8(shop) {
  const models = [['vase', shop.sample('vase')], ...shop.real('textured/spot/spot.obj', 'textured/AntiqueCameraBody.glb', 'textured/WaterBottle.glb')];
  if (models.length < 4) return undefined;
  return table(['', 'model', 'mesh', 'geometry', 'colour', 'entropy', 'all'], models.map(([name, file]) => {
    const look = ['--view-size', '150', ...(name === 'spot' ? kFromTheSide : [])];
    const map = (what) => {
      const field = shop.file(`${name}-${what}.csv`);
      shop.fovea('saliency', file, '-o', field, '--force', '--preset', 'yang', '--map', what);
      return shop.draw(file, `yang-8-${name}-${what}`, ...look, '--pass', 'field', '--field', field);
    };
    return [name, shop.draw(file, `yang-8-${name}`, ...look, '--pass', 'base-color'),
      shop.draw(file, `yang-8-${name}-mesh`, ...look, '--pass', 'normal'),
      ...['geometry', 'texture-color', 'texture-entropy', 'saliency'].map(map)];
  }));
}

/** The image files of a .glb, in their order. */
function images(file) {
  const { json, bytes } = readGlb(file);
  return json.images.map(({ bufferView }) => {
    const { byteOffset = 0, byteLength } = json.bufferViews[bufferView];
    return bytes.subarray(byteOffset, byteOffset + byteLength);
  });
}

/** Figure 10: relaxation alone against relaxation and regularisation. */
function figure10(shop) {
  const models = [['vase', shop.sample('vase')], ...shop.real('textured/BoomBox.glb')];
  if (models.length < 2) return undefined;
  const rows = [], scores = [];
  for (const [name, file] of models) {
    const out = Object.fromEntries(['none', 'frequency', 'saliency', 'balanced'].map((warp) => [warp, shop.file(`${name}-${warp}.glb`)]));
    for (const [warp, to] of Object.entries(out)) {
      shop.fovea('texture', file, '-o', to, '--force', '--texture-scale', '0.125', '--warp', warp, '--texture-format', 'webp', '--texture-psnr', '100',
        ...(warp === 'none' ? [] : ['--maps', shop.file(`${name}-${warp}.png`)]));
      writeFileSync(`${shop.images}/yang-10-${name}-${warp}-texture.webp`, images(to)[0]);
    }
    const pictures = Object.entries(out).map(([warp, to]) =>
      `${shop.shown(`yang-10-${name}-${warp}-texture`)} ${shop.draw(to, `yang-10-${name}-${warp}`, '--view-size', '170')}`);
    rows.push([name, ...pictures]);
    scores.push([name, ...shop.compared(file, Object.values(out), '--distance-samples', '0').map((s) => `${fixed(s.base.psnr)} / ${fixed(s.lit.psnr)}`)]);
  }
  const head = ['', 'resized', 'relaxed by frequency (Balmelli et al.)', 'relaxed and regularised by saliency (Yang et al.)', 'Fovea'];
  return `The base colour at an eighth of its sides as it is stored, and on the model, all its triangles kept:

${table(head, rows)}

PSNR in dB, base colour / lit, over 24 views:

${table(head.map((h) => (h === '' ? h : `${h}:`)), scores)}`;
}

export default {
  'yang-figure-4': figure4, 'yang-figure-8': figure8, 'yang-figure-10': figure10, 'yang-table-2': table2, 'yang-figure-12': figure12,
};
