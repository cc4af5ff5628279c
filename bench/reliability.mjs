// Every verb over every model of FOVEA_DATA, as Markdown for docs/reliability.md:
//
//   node reliability.mjs FOVEA OUTPUT-FOLDER [--only matrix|threads|memory] [--match TEXT]
//
// matrix: each command on each file, in time and memory that are limited. A run has to end with a code of
// docs/cli.md, neither by a signal nor for lack of time. What it wrote has to be whole: valid by the Khronos
// validator, with the counts that it reported when `fovea info` reads it again, without a number that is none,
// and its target reached or said to be missed. What it refuses it has to refuse with a word, leaving nothing.
// threads: each command that writes gives the same bytes with 1, 2 and 4 threads.
// memory: each command with ever less memory either does its work or says that there is too little.
//
// Exit status: 0 if nothing was found, else 1.

import { spawn } from 'node:child_process';
import { createHash } from 'node:crypto';
import fs from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import { validate } from '../tests/validate/validator.mjs';

const words = process.argv.slice(2);
const option = (name) => {
  const at = words.indexOf(name);
  return at < 0 ? null : words.splice(at, 2)[1];
};
const only = option('--only'), match = option('--match');
const [fovea, outputFolder] = words;
const data = process.env.FOVEA_DATA;
if (!outputFolder || !data) {
  console.error('usage: FOVEA_DATA=FOLDER reliability.mjs FOVEA OUTPUT-FOLDER [--only matrix|threads|memory] [--match TEXT]');
  process.exit(2);
}

// Of the processor; the clock may say ten times as much, where others work too.
const SECONDS = 120, GIB = 2 ** 30, MEMORY = 8 * GIB;
const USAGE = 2, FORMAT = 4, UNSUPPORTED = 5, LIMIT = 6, MISSED = 8;
const DOCUMENTED = [0, 1, USAGE, 3, FORMAT, UNSUPPORTED, LIMIT, 7, MISSED, 130];
// Files that docs of the corpus call malformed.
const MALFORMED = /bufferview-past-end|index-out-of-range|truncated/;

// --- Running -----------------------------------------------------------------------------------------

// Ends with { code, signal, late, out, err, seconds }. `memory` limits the address space.
function run(args, memory = MEMORY, seconds = SECONDS) {
  return new Promise((resolve) => {
    const began = process.hrtime.bigint();
    const child = spawn('bash', ['-c', `ulimit -c 0 -v ${Math.floor(memory / 1024)} -t ${seconds}; exec "$@"`, 'bash', fovea, ...args],
      { stdio: ['ignore', 'pipe', 'pipe'] });
    let out = '', err = '', late = false;
    child.stdout.on('data', (text) => (out += text));
    child.stderr.on('data', (text) => (err += text));
    const timer = setTimeout(() => { late = true; child.kill('SIGKILL'); }, 10 * seconds * 1000);
    child.on('close', (code, signal) => {
      clearTimeout(timer);
      late ||= signal === 'SIGXCPU' || signal === 'SIGKILL';
      resolve({ code, signal, late, out, err, seconds: Number(process.hrtime.bigint() - began) / 1e9 });
    });
  });
}

// Works through `jobs` with as many at a time as there are cores.
async function all(jobs, work) {
  const left = [...jobs];
  await Promise.all(Array.from({ length: os.cpus().length }, async () => {
    while (left.length) await work(left.shift());
  }));
}

function filesIn(folder) {
  return fs.readdirSync(folder, { recursive: true })
    .map((name) => path.join(folder, name)).filter((file) => fs.statSync(file).isFile()).sort();
}

const models = filesIn(data)
  .filter((file) => /\.(glb|gltf|obj|ply|off|stl)$/i.test(file) && (!match || file.includes(match)));

// --- Commands ----------------------------------------------------------------------------------------

// `triangles` up to which files are large enough to take too long for many of these.
const SMALL = 30_000, MEDIUM = 200_000, ANY = Infinity;
const quick = ['--metric', 'quadric'];
const views = ['--view-size', '64'];
const plain = ['--no-pictures', '--distance-samples', '500', '--textures', 'keep'];

// Each: name, verb, output (none if nothing is written), the most triangles it is run on, options.
const commands = [
  ['info', 'info', null, ANY, []],
  ['simplify', 'simplify', 'out.glb', SMALL, ['--ratio', '0.3', ...views]],
  ['simplify, quadric', 'simplify', 'out.glb', ANY, ['--ratio', '0.1', ...quick]],
  ['simplify, visibility', 'simplify', 'out.glb', SMALL, ['--ratio', '0.1', '--metric', 'visibility', ...views]],
  ['simplify, entropy', 'simplify', 'out.glb', 5_000, ['--ratio', '0.5', '--metric', 'entropy', '--region-texels', '16384', ...views]],
  ['simplify, polygon-entropy', 'simplify', 'out.glb', 5_000, ['--ratio', '0.5', '--metric', 'polygon-entropy', ...views]],
  ['simplify, image', 'simplify', 'out.glb', 8_000, ['--ratio', '0.1', '--metric', 'image', ...views]],
  ['simplify, error', 'simplify', 'out.gltf', MEDIUM, ['--error', '0.01']],
  ['simplify, one triangle', 'simplify', 'out.glb', MEDIUM, ['--triangles', '1', ...quick]],
  ['simplify, integers', 'simplify', 'out.glb', MEDIUM, ['--ratio', '0.2', ...quick, '--placement', 'half-edge', '--quantize', '--compression', 'meshopt']],
  ['simplify, textures', 'simplify', 'out.glb', SMALL, ['--ratio', '0.3', ...quick, '--textures', '--new-normal-maps', '--max-texture', '64']],
  ['simplify, culled', 'simplify', 'out.glb', SMALL, ['--ratio', '0.3', ...quick, '--cull-hidden']],
  ['simplify, topology', 'simplify', 'out.glb', SMALL, ['--ratio', '0.05', ...quick, '--keep-topology', '--lock-boundary', '--per-mesh']],
  ['simplify, saliency', 'simplify', 'out.glb', SMALL, ['--ratio', '0.3', ...quick, '--saliency', 'yang']],
  ['simplify to OBJ', 'simplify', 'out.obj', MEDIUM, ['--ratio', '0.3', ...quick]],
  ['simplify to PLY', 'simplify', 'out.ply', MEDIUM, ['--ratio', '0.3', ...quick]],
  ['focus', 'focus', 'out.glb', MEDIUM, ['--at', '128,128', '--ratio', '0.3']],
  ['focus to a picture', 'focus', 'out.png', SMALL, ['--at', '128,128', '--error', '0.01']],
  ['fit', 'fit', 'out.glb', SMALL, ['--bytes', 'HALF', ...views]],
  ['lods in a folder', 'lods', 'out', SMALL, ['--levels', '3', ...plain]],
  ['lods in a file', 'lods', 'out.glb', SMALL, ['--levels', '3', ...plain]],
  ['all lods', 'lods', 'out.fovea', ANY, []],
  ['all lods in a GLB', 'lods', 'out.glb', SMALL, ['--as', 'levels']],
  ['texture', 'texture', 'out.glb', MEDIUM, ['--max-texture', '64', '--texture-format', 'webp', '--texture-psnr', '30']],
  ['texture, bytes', 'texture', 'out.glb', SMALL, ['--texture-bytes', '50000']],
  ['saliency', 'saliency', 'out.glb', MEDIUM, []],
  ['saliency, numbers', 'saliency', 'out.npy', SMALL, ['--key-poses', '2', '--preset', 'lee']],
  ['saliency, picture', 'saliency', 'out.png', SMALL, views],
  ['segment', 'segment', 'out.glb', MEDIUM, []],
  ['segment, properties', 'segment', 'out.json', SMALL, ['--method', 'kmeans']],
  ['fly', 'fly', 'out.csv', MEDIUM, ['--device', 'cpu', '--frames', '4', '--judge-every', '2', ...views]],
  ['compare', 'compare', null, MEDIUM, ['--distance-samples', '500', ...views]],
  ['render', 'render', 'out.png', ANY, views],
  ['render, triangles', 'render', 'out.webp', SMALL, [...views, '--pass', 'triangle', '--views', 'orbit']],
].map(([name, verb, output, most, options]) => ({ name, verb, output, most, options }));

function wordsOf(command, model, folder) {
  const bytes = String(Math.ceil(fs.statSync(model).size / 2));
  const inputs = command.verb === 'compare' ? [model, model] : [model];
  const output = command.output ? ['-o', path.join(folder, command.output)] : [];
  return [command.verb, ...inputs, ...output, ...command.options.map((word) => (word === 'HALF' ? bytes : word)), '--json'];
}

// --- What a run has to leave -------------------------------------------------------------------------

const parse = (text) => { try { return JSON.parse(text); } catch { return null; } };

// Numbers that are none, in what is text or a list of floats.
function faultOfNumbers(file) {
  const bytes = fs.readFileSync(file);
  // The PSNR of equal pictures is infinite, which tables may say.
  const none = file.endsWith('.csv') ? /\bnan\b/i : /\b(nan|inf)\b/i;
  if (/\.(json|csv|obj|txt)$/.test(file)) return none.test(bytes.toString().replace(/^#.*$/gm, '')) ? 'a number is none' : null;
  if (file.endsWith('.npy')) {
    const at = 10 + bytes.readUInt16LE(8);
    for (let i = at; i + 4 <= bytes.length; i += 4) if (!Number.isFinite(bytes.readFloatLE(i))) return 'a number is none';
  }
  if (/\.(png|webp)$/.test(file) && bytes.length < 50) return 'the picture is empty';
  return null;
}

const errorsOfInput = new Map();
async function knownErrors(model) {
  if (!errorsOfInput.has(model))
    errorsOfInput.set(model, /\.gl(b|tf)$/.test(model)
      ? validate(model).then((report) => report.errors.map((e) => e.code)).catch(() => ['UNREADABLE']) : Promise.resolve([]));
  return new Set(await errorsOfInput.get(model));
}

// A model that was written, against what the run said of it.
async function faultOfModel(file, model, report) {
  if (/\.gl(b|tf)$/.test(file)) {
    const { errors } = await validate(file);
    const known = await knownErrors(model);
    const added = errors.filter((e) => !known.has(e.code));
    if (added.length) return `${path.basename(file)}: ${added[0].code} ${added[0].pointer ?? ''} ${added[0].message}`;
  }
  // Of an empty scene there is nothing in formats that hold triangles alone.
  if (report.after?.triangles_drawn === 0 && /\.(obj|ply)$/.test(file)) return null;
  const again = await run(['info', file, '--json'], MEMORY, SECONDS);
  const info = parse(again.out);
  if (again.code !== 0 || !info) return `info cannot read ${path.basename(file)}: ${again.err.trim()}`;
  // OBJ and PLY have no nodes: what is shown several times is there as often.
  const flat = /\.(obj|ply)$/.test(file);
  const said = (flat ? report.after?.triangles_drawn : report.after?.triangles) ?? (['focus', 'fit'].includes(report.verb) ? report.result?.triangles : null);
  // On a grid of integers corners may meet, and reading drops such triangles (docs/limitations.md).
  const lost = report.verb === 'fit' || report.options?.quantize ? Math.ceil(0.005 * said) : 0;
  if (said !== null && said !== undefined && (said < info.totals.triangles || said > info.totals.triangles + lost))
    return `${said} triangles are told, and ${info.totals.triangles} are in the file`;
  const low = info.bounds?.low ?? [], high = info.bounds?.high ?? [];
  return [...low, ...high].every((x) => x === null || Number.isFinite(x)) ? null : 'the bounds are no numbers';
}

function faultOfTarget(report, code, allowed) {
  const result = report.result ?? report;
  if (result.reached === undefined) return null;
  if (result.reached !== (code === 0)) return `reached is ${result.reached} and the exit code ${code}`;
  const target = result.triangles_target;
  if (result.reached && target && result.triangles > Math.max(target, allowed)) return `${result.triangles} triangles instead of ${target}`;
  return null;
}

async function faultOf(command, model, folder, done) {
  if (done.late) return `no end within ${SECONDS} s`;
  if (done.signal) return `signal ${done.signal}: ${done.err.trim().slice(-300)}`;
  if (!DOCUMENTED.includes(done.code)) return `exit code ${done.code}`;
  if (done.code === 1 || done.code === USAGE) return `exit code ${done.code}: ${done.err.trim()}`;
  const report = parse(done.out);
  if (!report) return 'stdout is no JSON object';
  if (report.exit_code !== done.code) return `the report says ${report.exit_code}, the exit code is ${done.code}`;
  const left = filesIn(folder);
  const rest = left.find((file) => file.endsWith('.part'));
  if (rest) return `${path.basename(rest)} is left over`;
  if (MALFORMED.test(model) && ![3, FORMAT, UNSUPPORTED, LIMIT].includes(done.code)) return 'a malformed file is taken';
  const written = done.code === 0 || (done.code === MISSED && command.verb !== 'fit');
  if (!written) {
    if (left.length) return `${left.length} files are left of a run that failed`;
    if (done.code === MISSED) return null;
    return /^fovea: error: .+/m.test(done.err) && report.error?.message ? null : 'there is no message';
  }
  const target = faultOfTarget(report, done.code, 0);
  if (target) return target;
  if (command.output && !left.length) return 'nothing is written';
  for (const output of report.outputs ?? []) if (!fs.existsSync(output.path)) return `${output.path} is told and not there`;
  for (const file of left) {
    const fault = faultOfNumbers(file) ??
      (/\.(glb|gltf|obj|ply|fovea)$/.test(file) ? await faultOfModel(file, model, report) : null);
    if (fault) return fault;
  }
  return null;
}

// --- Matrix ------------------------------------------------------------------------------------------

const faults = [];
function blame(what, fault) {
  if (!fault) return;
  faults.push(`${what}: ${fault}`);
  console.error(`BAD ${what}: ${fault}`);
}
const nameOf = (model) => path.relative(data, model);

function fresh(name) {
  const folder = path.join(outputFolder, name);
  fs.rmSync(folder, { recursive: true, force: true });
  fs.mkdirSync(folder, { recursive: true });
  return folder;
}

const sizes = new Map();
async function trianglesOf(model) {
  if (!sizes.has(model)) sizes.set(model, parse((await run(['info', model, '--json'])).out)?.totals?.triangles_drawn ?? 0);
  return sizes.get(model);
}

const mb = (bytes) => `${Math.round(bytes / 1e6)} MB`;

async function matrix() {
  await all(models, trianglesOf);
  const rows = new Map(commands.map((command) => [command.name, { runs: 0, done: 0, missed: 0, refused: {}, faults: 0, seconds: 0, slowest: ['', 0], largest: ['', 0] }]));
  const jobs = models.flatMap((model) => commands.filter((command) => sizes.get(model) <= command.most).map((command) => ({ model, command })));
  let count = 0;
  await all(jobs, async ({ model, command }) => {
    const folder = fresh(`run-${count++}`);
    const done = await run(wordsOf(command, model, folder));
    const fault = await faultOf(command, model, folder, done).catch((error) => String(error));
    blame(`${command.name}, ${nameOf(model)}`, fault);
    const row = rows.get(command.name);
    ++row.runs;
    row.seconds += done.seconds;
    if (fault) ++row.faults;
    else if (done.code === 0) ++row.done;
    else if (done.code === MISSED) ++row.missed;
    else row.refused[done.code] = (row.refused[done.code] ?? 0) + 1;
    const memory = parse(done.out)?.peak_memory_bytes ?? 0;
    if (done.seconds > row.slowest[1]) row.slowest = [nameOf(model), done.seconds];
    if (memory > row.largest[1]) row.largest = [nameOf(model), memory];
    fs.rmSync(folder, { recursive: true, force: true });
    if (count % 200 === 0) console.error(`${count} of ${jobs.length} runs`);
  });
  console.log(`${models.length} files, ${jobs.length} runs\n`);
  console.log('| command | runs | done | target missed, said | refused: by code | faults | seconds, all | slowest | most memory |');
  console.log('|---|--:|--:|--:|---|--:|--:|---|---|');
  for (const [name, row] of rows) {
    if (!row.runs) continue;
    const refused = Object.entries(row.refused).map(([code, n]) => `${code}: ${n}`).join(', ') || '–';
    const at = ([file, value], text) => (file ? `${text(value)} (${path.basename(file)})` : '–');
    console.log(`| ${name} | ${row.runs} | ${row.done} | ${row.missed} | ${refused} | ${row.faults} | ${row.seconds.toFixed(0)} ` +
      `| ${at(row.slowest, (s) => `${s.toFixed(1)} s`)} | ${at(row.largest, mb)} |`);
  }
}

// --- Threads -----------------------------------------------------------------------------------------

// Of each kind one: textured, skinned, morphed, many meshes, a scan, another format.
const TRIED = ['textured/Duck.glb', 'textured/GlamVelvetSofa.glb', 'animated/CesiumMan.glb', 'animated/MorphStressTest.glb', 'animated/KayKitKnight.glb',
  'textured/spot/spot.obj', 'scans/hand.ply', 'conformance/NegativeScaleTest.glb'].map((name) => path.join(data, name)).filter((file) => fs.existsSync(file) && (!match || file.includes(match)));

function hashOf(folder) {
  const hash = createHash('sha256');
  for (const file of filesIn(folder)) hash.update(path.relative(folder, file)).update(fs.readFileSync(file));
  return hash.digest('hex');
}

async function threads() {
  const jobs = TRIED.flatMap((model) => commands.filter((c) => c.output && c.verb !== 'fly').map((command) => ({ model, command })));
  let same = 0, runs = 0, refused = 0;
  await all(jobs, async ({ model, command }) => {
    const hashes = new Set(), codes = new Set();
    for (const count of [1, 2, 4]) {
      const folder = fresh(path.join(`threads-${jobs.findIndex((j) => j.model === model && j.command === command)}`, 'same'));
      const done = await run([...wordsOf(command, model, folder), '--threads', String(count)], MEMORY, 3 * SECONDS);
      ++runs;
      codes.add(done.signal ?? done.code);
      hashes.add(hashOf(folder));
    }
    fs.rmSync(path.join(outputFolder, `threads-${jobs.findIndex((j) => j.model === model && j.command === command)}`), { recursive: true, force: true });
    if (codes.size > 1) blame(`${command.name}, ${nameOf(model)}`, `exit codes ${[...codes]} for 1, 2 and 4 threads`);
    else if (hashes.size > 1) blame(`${command.name}, ${nameOf(model)}`, 'other bytes for 1, 2 and 4 threads');
    else if ([0, MISSED].includes([...codes][0])) ++same;
    else ++refused;
  });
  console.log(`${jobs.length} commands on ${TRIED.length} models with 1, 2 and 4 threads (${runs} runs): ${same} gave the same bytes, ` +
    `${refused} had nothing to do, ${jobs.length - same - refused} differed`);
}

// --- Memory ------------------------------------------------------------------------------------------

// Address space, in MB. The program and its libraries take some 100 by themselves.
const LEVELS = [60, 120, 160, 200, 250, 300, 400, 500, 700, 1000, 1500, 2000];

async function memory() {
  const model = path.join(data, 'textured/DamagedHelmet.glb');
  const rows = [];
  await all(commands, async (command) => {
    const codes = [];
    for (const level of LEVELS) {
      const folder = fresh(`memory-${commands.indexOf(command)}`);
      const done = await run(wordsOf(command, model, folder), level * 1e6);
      const place = `${command.name} with ${level} MB`;
      const left = filesIn(folder).length;
      codes.push(done.late ? 'late' : done.signal ?? done.code);
      // Below what the program itself needs the system refuses to start it.
      if (level > LEVELS[0] && ![0, LIMIT, MISSED].includes(codes.at(-1))) blame(place, `ends with ${codes.at(-1)}: ${done.err.trim().slice(-200)}`);
      if (![0, MISSED].includes(done.code) && left) blame(place, `${left} files are left`);
      fs.rmSync(folder, { recursive: true, force: true });
      if ([0, MISSED].includes(done.code)) break;
    }
    rows[commands.indexOf(command)] = `| ${command.name} | ${codes.map((code, i) => `${LEVELS[i]}: ${code}`).join(', ')} |`;
  });
  console.log('| command | exit code by MB of address space |\n|---|---|');
  for (const row of rows) console.log(row);
}

for (const [name, part] of Object.entries({ matrix, threads, memory })) {
  if (only && only !== name) continue;
  const began = Date.now();
  console.log(`\n## ${name}\n`);
  await part();
  console.log(`\n${((Date.now() - began) / 60000).toFixed(1)} minutes`);
}
console.log(`\n${faults.length} faults${faults.length ? ':' : ''}`);
for (const fault of faults) console.log(`- ${fault}`);
process.exit(faults.length ? 1 : 0);
