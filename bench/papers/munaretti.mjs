// Munaretti: Perceptual guidance in mesh processing and rendering using mesh saliency (2007).
import { existsSync, readFileSync, writeFileSync } from 'node:fs';
import { count, fixed, numbers, table } from './workshop.mjs';

/** Figure 3.4: two spheres, one of which swells; over geodesics the other does not notice. */
function figure34(shop) {
  const spheres = shop.sample('spheres');
  const swollen = ['--animation', '0', '--time', '1.5'], look = ['--elevation', '10', '--fov', '20', '--width', '300', '--height', '200'];
  const field = (distance, moment) => {
    const file = shop.file(`spheres-${distance}-${moment.length}.csv`);
    shop.fovea('saliency', spheres, '-o', file, '--force', '--preset', 'lee', '--distance', distance, '--map', 'curvature-contrast-5', ...moment);
    return file;
  };
  const values = (file) => numbers(file).filter((v) => !Number.isNaN(v));
  const rows = [], counts = [];
  for (const distance of ['euclidean', 'geodesic']) {
    const files = [[], swollen].map((moment) => field(distance, moment));
    const [rest, moved] = files.map(values), half = rest.length / 2;
    const changes = rest.map((v, i) => Math.abs(v - moved[i]));
    // The second mesh swells, the first stays.
    const neighbour = changes.slice(0, half);
    counts.push([distance, count(half), count(neighbour.filter((c) => c > 1e-4).length), neighbour.reduce((a, b) => Math.max(a, b)).toExponential(1)]);
    rows.push([distance, ...files.map((file, i) => {
      // The swollen one has up to ten times as much: cut it, so that the other can be seen.
      writeFileSync(file, ['value', ...values(file).map((v) => Math.min(v, 0.2))].join('\n'));
      return shop.draw(spheres, `munaretti-3-4-${distance}-${i}`, ...look, ...(i ? swollen : []), '--pass', 'field', '--field', file);
    })]);
  }
  return `${table(['distance', 'at rest', 'one swollen'], rows)}

${table(['distance', 'vertices of the other:', 'that changed by more than 0.0001:', 'the most:'], counts)}`;
}

/** Figures 4.2 and 4.3: an arm by saliency of one pose and of several. */
function figure43(shop) {
  const arm = shop.sample('arm'), bent = ['--animation', '0', '--time', '1'];
  const ways = [
    ['quadrics', []],
    ['one pose', ['--saliency', 'munaretti', '--saliency-weighting', 'munaretti']],
    ['several poses', ['--saliency', 'munaretti', '--saliency-weighting', 'munaretti', '--key-poses', '8']],
  ];
  const results = ways.map(([, options], i) => shop.simplified(arm, `arm-${i}.glb`, '--ratio', '0.02', '--metric', 'quadric', ...options));
  const look = ['--elevation', '15', '--view-size', '260', ...bent];
  const pictures = (pass) => results.map((model, i) => shop.draw(model, `munaretti-4-3-${pass}-${i}`, ...look, '--pass', pass));
  const judged = [[], bent].map((pose) => shop.compared(arm, results, ...pose));
  const scores = (pose) => judged[pose].map((s) => `${fixed(s.lit.psnr)} / ${fixed(s.lit.flip, 4)}`);
  return table(['', ...ways.map(([name]) => name)], [
    ['bent', ...pictures('lit')], ['its triangles', ...pictures('triangle')],
    ['lit at rest, dB / FLIP', ...scores(0)], ['lit when bent, dB / FLIP', ...scores(1)],
  ]);
}

/** Figure 5.2: saliency of the whole against saliency within clusters, and what either leaves. */
function figure52(shop) {
  const [bunny] = shop.real('scans/bunny.ply');
  if (!bunny) return undefined;
  const file = bunny[1], original = shop.file('bunny-saliency.csv'), local = shop.file('bunny-local.csv');
  shop.fovea('saliency', file, '-o', original, '--force', '--preset', 'munaretti');
  shop.fovea('segment', file, '-o', local, '--as', 'local', '--force', '--clusters', '10', '--preset', 'munaretti');
  const columns = [['of the whole', original], ['within ten clusters', local]].map(([name, field], i) => {
    const values = numbers(field).filter((v) => !Number.isNaN(v)), alpha = [...values].sort((a, b) => a - b)[Math.floor(0.3 * values.length)];
    const weights = shop.file(`bunny-weights-${i}.csv`);
    writeFileSync(weights, ['weight', ...values.map((v) => (v >= alpha ? 100 * v : Math.max(v, 1e-3)))].join('\n'));
    const small = shop.simplified(file, `bunny-5-2-${i}.glb`, '--ratio', '0.04', '--metric', 'quadric', '--importance', weights);
    return [name, shop.draw(file, `munaretti-5-2-saliency-${i}`, '--pass', 'field', '--field', field),
      shop.draw(small, `munaretti-5-2-triangles-${i}`, '--pass', 'triangle'), shop.draw(small, `munaretti-5-2-lit-${i}`)];
  });
  return table(['saliency', 'its map', 'amplified, to 4 % of the triangles', 'as a surface'], columns);
}

const methods = ['salient', 'propagative', 'kmeans'];

/** Figures 7.7 to 7.11: three ways to clusters. */
function figure77(shop) {
  const scans = [['armadillo', 45, []], ['dragon', 45, []], ['bunny', 10, []], ['nefertiti', 30, []]];
  const found = scans.flatMap(([name, clusters, look]) => shop.real(`scans/${name}.ply`).map(([, file]) => [name, file, clusters, look]));
  if (found.length < scans.length) return undefined;
  return table(['', ...methods], found.map(([name, file, clusters, look]) => [`${name}, ${clusters} clusters`, ...methods.map((method) => {
    const colors = shop.file(`${name}-${method}.glb`);
    shop.fovea('segment', file, '-o', colors, '--force', '--clusters', `${clusters}`, '--method', method);
    return shop.draw(colors, `munaretti-7-7-${name}-${method}`, ...look);
  })]));
}

/** A mesh with each of its triangles cut in four, as .obj. */
function quartered(shop, file, name) {
  const out = shop.file(`${name}.obj`);
  if (existsSync(out)) return out;
  const obj = shop.file(`${name}-before.obj`);
  shop.fovea('simplify', file, '-o', obj, '--force', '--ratio', '1');
  const points = [], faces = [], middles = new Map();
  for (const line of readFileSync(obj, 'utf8').split('\n')) {
    const words = line.split(/\s+/);
    if (words[0] === 'v') points.push(words.slice(1, 4).map(Number));
    if (words[0] === 'f') faces.push(words.slice(1, 4).map((w) => parseInt(w, 10) - 1));
  }
  const middle = (a, b) => {
    const key = a < b ? a * 2 ** 26 + b : b * 2 ** 26 + a;
    if (!middles.has(key)) middles.set(key, points.push(points[a].map((x, i) => (x + points[b][i]) / 2)) - 1);
    return middles.get(key);
  };
  const cut = faces.flatMap(([a, b, c]) => {
    const [ab, bc, ca] = [middle(a, b), middle(b, c), middle(c, a)];
    return [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]];
  });
  writeFileSync(out, `${points.map((p) => `v ${p.map(Math.fround).join(' ')}`).join('\n')}\n${cut.map((f) => `f ${f.map((i) => i + 1).join(' ')}`).join('\n')}\n`);
  return out;
}

// Table 7.2 of the thesis, on an Athlon 64 3500+: seconds of saliency, and of its three ways to clusters.
const thesis72 = {
  bunny: [69451, 10, 5.187, 30.359, 64.844, 0.172],
  armadillo: [345944, 45, 91.047, 417.265, 623.688, 1.609],
  dragon: [480076, 45, 187.906, 865.437, 602.187, 3.563],
  'Laçador': [1307794, 45, 1747.53, 6945.98, 7141.34, 8.063],
};

/** Table 7.2: what saliency and clusters take. */
function table72(shop) {
  const scans = Object.fromEntries(shop.real('scans/bunny.ply', 'scans/armadillo.ply', 'scans/dragon.ply'));
  if (Object.keys(scans).length < 3) return undefined;
  const four = quartered(shop, scans.armadillo, 'armadillo-4');
  const models = [
    ['bunny', scans.bunny, 10, 'bunny'],
    ['armadillo, cut in four', four, 45, 'armadillo'],
    ['dragon', shop.simplified(scans.dragon, 'dragon-480k.ply', '--triangles', '480076', '--metric', 'quadric'), 45, 'dragon'],
    ['armadillo, cut in sixteen', quartered(shop, four, 'armadillo-16'), 45, 'Laçador'],
  ];
  const rows = models.map(([name, file, clusters, like]) => {
    const seconds = (report, phase) => report.phases.filter((p) => p.name.startsWith(phase)).reduce((sum, p) => sum + p.seconds, 0);
    const saliency = (distance) => seconds(shop.report('saliency', file, '-o', shop.file('saliency.npy'), '--force', '--preset', 'munaretti', '--distance', distance), 'saliency');
    const segments = methods.map((method) => shop.report('segment', file, '-o', shop.file('clusters.npy'), '--force', '--clusters', `${clusters}`, '--method', method));
    const [triangles, , ...theirs] = thesis72[like];
    // Exact geodesics around each vertex: four times the triangles take sixteen times as long.
    const exact = shop.triangles(file) < 400000 ? saliency('geodesic') : null;
    const ours = [exact, saliency('diffusion'), ...segments.map((s) => seconds(s, 'cluster'))];
    return [name, count(shop.triangles(file)), clusters, ...ours.map((s) => fixed(s, 2)), like === name.split(',')[0] ? '' : like, count(triangles), ...theirs.map((s) => fixed(s, 1))];
  });
  return table(['model', 'triangles:', 'clusters:', 'saliency, exact:', 'by diffusion:', 'salient:', 'propagative:', 'k-means:', 'thesis', 'triangles:', 'saliency:', 'salient:', 'propagative:', 'k-means:'], rows);
}

// Table 7.3 of the thesis, on a GeForce 8800 GTX: frames per second.
const thesis73 = { bunny: [817, 475, 2147, 1507, 1126], armadillo: [184, 93, 783, 341, 262], dragon: [127, 55, 398, 336, 261] };

/** Table 7.3: frames per second, a level every ten frames. */
function table73(shop) {
  const scans = shop.real('scans/bunny.ply', 'scans/armadillo.ply', 'scans/dragon.ply');
  if (scans.length < 3) return undefined;
  let device;
  const rows = scans.map(([name, file]) => {
    const flight = shop.report('fly', file, '-o', shop.file('flight.csv'), '--force', '--select', 'clusters', '--clusters', '45',
      '--judge-every', '0', '--spread', '10');
    device = flight.device ?? 'no device';
    const rate = (ms) => (ms ? fixed(1000 / ms, 0) : '–');
    const [five] = flight.ratios;
    const times = (all, ms) => (all && ms ? `${fixed(all / ms, 1)}` : '–');
    return [name, rate(five.full_ms), rate(five.cpu_ms), ...flight.ratios.map((r) => rate(r.gpu_ms)), times(five.full_ms, five.gpu_ms), times(five.cpu_ms, five.gpu_ms),
      ...thesis73[name], fixed(thesis73[name][2] / thesis73[name][0], 1), fixed(thesis73[name][2] / thesis73[name][1], 1)];
  });
  const head = ['all:', 'CPU, 5 %:', 'GPU, 5 %:', '35 %:', '60 %:', 'GPU : all:', 'GPU : CPU:'];
  return `Here on ${device}, then the thesis (its scans are larger: 69,451, 345,944 and 480,076 triangles, ours ${scans.map(([, file]) => count(shop.triangles(file))).join(', ')}):

${table(['model', ...head, ...head], rows)}`;
}

export default {
  'munaretti-figure-3-4': figure34, 'munaretti-figure-4-3': figure43, 'munaretti-figure-5-2': figure52, 'munaretti-figure-7-7': figure77,
  'munaretti-table-7-2': table72, 'munaretti-table-7-3': table73,
};
