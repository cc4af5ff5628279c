// Simplifies models with the command line, makes levels of detail of them, fits them into bytes, shrinks their textures,
// writes saliency and clusters into them, and puts every output through the Khronos glTF validator.
//
//   node validate.mjs FOVEA OUTPUT-FOLDER sample NAME     a sample model, in every way of writing
//   node validate.mjs FOVEA OUTPUT-FOLDER corpus FOLDER   every glTF file of FOVEA_DATA/FOLDER: at 10 %, with levels,
//                                                         with small textures, as a heat map, in clusters, and
//                                                         with attributes of both
//
// Exit status: 0 all valid, 1 something is not, 77 (skipped) if FOVEA_DATA is not set.

import { execFile } from 'node:child_process';
import fs from 'node:fs';
import path from 'node:path';
import { validate } from './validator.mjs';

const SKIPPED = 77;
// Exit codes of fovea (fovea/base/error.h).
const NOT_REACHED = 8;
const UNSUPPORTED = 5;
const REFUSALS = [3, 4, UNSUPPORTED, 6];

const [fovea, outputFolder, mode, name] = process.argv.slice(2);

function run(...words) {
  return new Promise((resolve) => {
    execFile(fovea, words, { timeout: 300_000 }, (error, stdout, stderr) => {
      resolve({ code: error ? (error.code ?? error.signal) : 0, text: stderr.trim() });
    });
  });
}

// Runs one command that makes `output` of `input`; returns what is wrong with it, or nothing. A file that has
// errors may be refused, but must not end in a crash or a hang; if it is read all the same, it must not gain
// errors of other kinds.
async function faultOf(input, output, words, faultOfCount) {
  const before = await validate(input).catch((error) => ({ errors: [{ code: 'UNREADABLE', message: String(error) }], triangles: 0 }));
  const { code, text } = await run(words[0], input, '-o', output, '--force', '--quiet', ...words.slice(1));
  const namesExtension = code === UNSUPPORTED && /\b[A-Z]+_\w+/.test(text);
  // What only draws or weighs triangles refuses a model without them.
  const nothingThere = ['saliency', 'segment'].includes(words[0]) && code === UNSUPPORTED &&
    (before.triangles === 0 ? /no triangles/ : /scene shows no triangles/).test(text);
  // Of a few triangles there is nothing simpler.
  const noLevels = words[0] === 'lods' && code === UNSUPPORTED &&
    /no level is smaller|shows? no triangles|has no triangles/.test(text);
  if (namesExtension || nothingThere || noLevels || (before.errors.length && REFUSALS.includes(code))) return null;
  if (code !== 0 && code !== NOT_REACHED) return `exit code ${code}: ${text}`;
  const after = await validate(output);
  const known = new Set(before.errors.map((error) => error.code));
  const added = after.errors.filter((error) => !known.has(error.code));
  if (added.length) return added.slice(0, 5).map((e) => `${e.code} ${e.pointer ?? ''} ${e.message}`).join('\n    ');
  return code === 0 ? faultOfCount(before.triangles, after.triangles) : null;
}

function simplifyFault(input, output, ratio, ...options) {
  // One triangle more is allowed: a collapse takes two, and the count asked for may be odd.
  return faultOf(input, output, ['simplify', '--ratio', String(ratio), ...options], (before, after) =>
    after > Math.ceil(ratio * before) + 1 ? `${after} triangles of ${before} at ratio ${ratio}` : null);
}

// Which numbers are written makes no difference here: height is the quickest to have.
const HEIGHT = ['--geometry-weight', '0', '--texture-weight', '0', '--visibility-weight', '0', '--extremity-weight', '0',
  '--height-weight', '1'];

const MAPS = [['saliency', 'heat'], ['saliency', 'attribute'], ['segment', 'colors'], ['segment', 'attribute']];

function mapFault(input, output, verb, kind) {
  // Reading drops triangles that use a point twice.
  return faultOf(input, output, [verb, '--as', kind, ...HEIGHT], (before, after) =>
    after > before || (before > 0 && after === 0) ? `${after} triangles instead of ${before}` : null);
}

// Into a share of the bytes that it has.
function fitFault(input, output, share, ...options) {
  const bytes = Math.ceil(share * fs.statSync(input).size);
  return faultOf(input, output, ['fit', '--bytes', String(bytes), '--view-size', '128', ...options], () => {
    const taken = fs.statSync(output).size;
    return taken > bytes ? `${taken} bytes instead of ${bytes}` : null;
  });
}

function textureFault(input, output, ...options) {
  return faultOf(input, output, ['texture', ...options], (before, after) =>
    after > before || (before > 0 && after === 0) ? `${after} triangles instead of ${before}` : null);
}

// All levels in one file: as many triangles as the original's half and quarter beside it, at most.
function lodsFault(input, output, ...options) {
  return faultOf(input, output, ['lods', '--levels', '3', '--no-pictures', '--distance-samples', '1000', ...options],
    (before, after) => after > Math.ceil(1.75 * before) + 2 ? `${after} triangles in levels of ${before}` : null);
}

async function report(label, check) {
  const fault = await check;
  console.log(`${fault ? 'BAD ' : 'ok  '} ${label}${fault ? `\n    ${fault}` : ''}`);
  return fault ? 1 : 0;
}

async function sampleFaults() {
  const input = path.join(outputFolder, `${name}.glb`);
  const made = await run('sample', name, '-o', input, '--force', '--quiet');
  if (made.code !== 0) return report(`sample ${name}`, `exit code ${made.code}: ${made.text}`);
  let faults = await report(`sample ${name}`, validate(input).then(({ errors }) => errors.map((e) => e.message).join('\n')));
  // Where the way of writing is what counts, triangles go the quick way.
  const quick = ['--metric', 'quadric'];
  const ways = [
    ['50.glb', 0.5],
    ['10.glb', 0.1],
    ['2.glb', 0.02, '--cull-hidden'],
    ['10.gltf', 0.1, ...quick],
    ['10-quantized.glb', 0.1, ...quick, '--quantize'],
    ['10-meshopt.glb', 0.1, ...quick, '--compression', 'meshopt'],
    ['10-textures.glb', 0.1, ...quick, '--textures', '--new-normal-maps', '--max-texture', '256'],
    ['10-quantized-meshopt.glb', 0.1, ...quick, '--quantize', '--compression', 'meshopt'],
  ];
  for (const [suffix, ratio, ...options] of ways) {
    const output = path.join(outputFolder, `${name}-${suffix}`);
    faults += await report(path.basename(output), simplifyFault(input, output, ratio, ...options));
  }
  for (const [verb, kind] of MAPS) {
    for (const extension of ['glb', 'gltf']) {
      const output = path.join(outputFolder, `${name}-${verb}-${kind}.${extension}`);
      faults += await report(path.basename(output), mapFault(input, output, verb, kind));
    }
  }
  for (const [suffix, ...options] of [
    ['half.glb', '--texture-scale', '0.5'],
    ['webp.gltf', '--texture-format', 'webp', '--texture-psnr', '30'],
    ['jpeg.glb', '--texture-format', 'jpeg', '--texture-psnr', '34'],
  ]) {
    const output = path.join(outputFolder, `${name}-${suffix}`);
    faults += await report(path.basename(output), textureFault(input, output, ...options));
  }
  for (const [suffix, ...options] of [['fit.glb'], ['fit-webp.glb', '--texture-format', 'webp', '--compression', 'meshopt']]) {
    const output = path.join(outputFolder, `${name}-${suffix}`);
    faults += await report(path.basename(output), fitFault(input, output, 0.1, ...options));
  }
  for (const [suffix, ...options] of [
    ['lods.glb', ...quick],
    ['lods-shared.glb', ...quick, '--textures', 'keep', '--share-vertices'],
    ['lods-shared-quantized.glb', ...quick, '--textures', 'keep', '--share-vertices', '--quantize', '--compression', 'meshopt'],
    ['lods-quantized.glb', ...quick, '--textures', 'keep', '--quantize', '--compression', 'meshopt'],
  ]) {
    const output = path.join(outputFolder, `${name}-${suffix}`);
    faults += await report(path.basename(output), lodsFault(input, output, ...options));
  }
  return faults;
}

async function corpusFaults() {
  const folder = path.join(process.env.FOVEA_DATA, name);
  const files = fs.readdirSync(folder, { recursive: true }).filter((file) => /\.gl(b|tf)$/.test(file)).sort();
  if (!files.length) return report(folder, 'no glTF files');
  let faults = 0;
  for (const file of files) {
    const input = path.join(folder, file);
    const output = path.join(outputFolder, file.replaceAll(path.sep, '_').replace(/\.gltf$/, '.glb'));
    faults += await report(file, simplifyFault(input, output, 0.1));
    faults += await report(`${file}, textures`, textureFault(input, output, '--texture-format', 'webp', '--max-texture', '128', '--texture-psnr', '30'));
    faults += await report(`${file}, levels`, lodsFault(input, output.replace(/\.glb$/, '-lods.glb'), '--metric', 'quadric', '--textures', 'keep'));
    for (const [verb, kind] of MAPS)
      faults += await report(`${file}, ${verb} ${kind}`,
        mapFault(input, output.replace(/\.glb$/, `-${verb}-${kind}.glb`), verb, kind));
  }
  return faults;
}

if (mode === 'corpus' && !process.env.FOVEA_DATA) {
  console.log('skipped: FOVEA_DATA is not set');
  process.exit(SKIPPED);
}
fs.mkdirSync(outputFolder, { recursive: true });
const faults = await (mode === 'sample' ? sampleFaults() : corpusFaults());
process.exit(faults ? 1 : 0);
