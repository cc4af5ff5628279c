// What a budget gives by where the model is looked from, as Markdown: looks.mjs FOVEA FOLDER MODEL... fits each model without
// cameras into some budgets, seen at several sizes, and then the sample terrain, with a camera low over it and with one that flies,
// and the models that have cameras, with --views cameras and without, compared by the pictures of these cameras. Some minutes for each.
import { join } from 'node:path';
import { modelName, reporter, run, usage } from './commands.mjs';
import { readGlb, writeGlb } from './glb.mjs';

const [fovea, folder, ...models] = process.argv.slice(2);
if (models.length === 0) usage('looks.mjs FOVEA FOLDER MODEL...');
const report = reporter(fovea);
const out = join(folder, 'look.glb'), plain = join(folder, 'plain.glb');

/** Writes a .glb with a camera at `places`, [eye, target] of each, along which it moves if there are several. */
function withCamera(from, to, places) {
  const { json: model, bytes: body } = readGlb(from);
  const sub = (a, b) => a.map((x, i) => x - b[i]);
  const unit = (a) => a.map((x) => x / Math.hypot(...a));
  const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
  /** The rotation whose z axis looks back from the target. */
  const rotation = ([eye, target]) => {
    const z = unit(sub(eye, target)), x = unit(cross([0, 1, 0], z)), y = cross(z, x);
    const w = Math.sqrt(Math.max(1e-12, 1 + x[0] + y[1] + z[2])) / 2;
    return [(y[2] - z[1]) / (4 * w), (z[0] - x[2]) / (4 * w), (x[1] - y[0]) / (4 * w), w];
  };
  model.cameras = [{ type: 'perspective', perspective: { yfov: Math.PI / 6, znear: 0.01 } }];
  model.nodes.push({ camera: 0, translation: places[0][0], rotation: rotation(places[0]) });
  const node = model.nodes.length - 1;
  model.scenes[model.scene ?? 0].nodes.push(node);
  let data = body;
  if (places.length > 1) {
    const add = (type, rows) => {
      const bytes = Buffer.from(Float32Array.from(rows.flat()).buffer);
      model.bufferViews.push({ buffer: 0, byteOffset: data.length, byteLength: bytes.length });
      data = Buffer.concat([data, bytes]);
      const values = rows.flat();
      model.accessors.push({ bufferView: model.bufferViews.length - 1, componentType: 5126, type, count: rows.length,
        ...(type === 'SCALAR' && { min: [Math.min(...values)], max: [Math.max(...values)] }) });
      return model.accessors.length - 1;
    };
    const input = add('SCALAR', places.map((_, i) => [i]));
    const channels = [['translation', 'VEC3', places.map(([eye]) => eye)], ['rotation', 'VEC4', places.map(rotation)]];
    model.animations = [{
      samplers: channels.map(([, type, rows]) => ({ input, output: add(type, rows) })),
      channels: channels.map(([path], sampler) => ({ sampler, target: { node, path } })),
    }];
    model.buffers[0].byteLength = data.length;
  }
  writeGlb(to, model, data);
}

/** The sample terrain with a camera low over it, as terrain_bench looks at it, and the same with a flight over it. */
function terrains() {
  const terrain = join(folder, 'terrain.glb');
  run(fovea, 'sample', 'terrain', '-o', terrain, '--force');
  const { low: min, high: max } = report('info', terrain).bounds;
  const side = Math.max(max[0] - min[0], max[2] - min[2]), top = (max[1] - min[1]) / side;
  const at = (x, y, z) => [(min[0] + max[0]) / 2 + x * side, min[1] + y * side, (min[2] + max[2]) / 2 + z * side];
  const still = [at(0.05, top + 0.2, 0.36), at(0, top / 3, 0.05)];
  const flight = [0, 1, 2, 3].map((i) => [at(0.05 + 0.1 * i, top + 0.2, 0.36 - 0.08 * i), at(0.1 * i, top / 3, 0.05 - 0.08 * i)]);
  const files = [join(folder, 'terrain, one camera low over it.glb'), join(folder, 'terrain, a camera that flies.glb')];
  withCamera(terrain, files[0], [still]);
  withCamera(terrain, files[1], flight);
  return files;
}

const db = (s) => (s.psnr_foreground ?? Infinity).toFixed(1), flip = (s) => s.flip_foreground.toFixed(3);
const both = (of, { base_color: base, lit }) => `${of(base)} / ${of(lit)}`;

console.log('| model | bytes | seen at | triangles | image bytes | PSNR there, dB |');
console.log('|---|--:|--:|--:|--:|--:|');
const hasCameras = (model) => report('info', model).cameras.length > 0;
for (const model of models.filter((m) => !hasCameras(m))) {
  for (const bytes of ['60KB', '200KB']) {
    for (const size of [96, 512, 2048]) {
      const { result } = report('fit', model, '-o', out, '--force', '--allow-miss', '--bytes', bytes, '--view-size', `${size}`);
      console.log(`| ${modelName(model)} | ${bytes} | ${size} | ${result.triangles.toLocaleString('en')} | ${result.image_bytes.toLocaleString('en')} | ${result.psnr.toFixed(1)} |`);
    }
  }
}

console.log('\n| model, cameras | bytes | from all sides, dB | `--views cameras` | from all sides, FLIP | `--views cameras` |');
console.log('|---|--:|--:|--:|--:|--:|');
for (const model of [...terrains(), ...models.filter(hasCameras)]) {
  for (const bytes of ['300KB', '60KB']) {
    const to = ['--force', '--allow-miss', '--bytes', bytes, '--compression', 'meshopt'];
    run(fovea, 'fit', model, '-o', plain, ...to);
    run(fovea, 'fit', model, '-o', out, ...to, '--views', 'cameras');
    const [without, within] = report('compare', model, plain, out, '--views', 'cameras', '--distance-samples', '0').results;
    console.log(`| ${modelName(model)} | ${bytes} | ${both(db, without)} | ${both(db, within)} | ${both(flip, without)} | ${both(flip, within)} |`);
  }
}
