// What the scripts of this folder share: calling programs, and their own words.
import { execFileSync } from 'node:child_process';
import { readFileSync } from 'node:fs';
import { basename, dirname, join } from 'node:path';

/** Runs a program and returns what it prints; what it says on the way is dropped. */
export function run(program, ...words) {
  return execFileSync(program, words, { maxBuffer: 1 << 26, stdio: ['ignore', 'pipe', 'ignore'] });
}

/** `report(...words)` runs Fovea and returns its report. */
export function reporter(fovea) {
  return (...words) => JSON.parse(run(fovea, ...words, '--json'));
}

/** A model as tables call it. */
export function modelName(file) {
  return basename(file).replace(/\.[^.]*$/, '');
}

/** Takes `--name VALUE` out of words and returns the value; undefined if it is not there. */
export function takeOption(words, name) {
  const at = words.indexOf(name);
  return at < 0 ? undefined : words.splice(at, 2)[1];
}

export function usage(text) {
  console.error(`usage: ${text}`);
  process.exit(2);
}

/** The scores of tests against a model by another program, called as EVALUATOR MODEL TEST... --json FILE --quiet: of
 *  each test {unlit, lit} with psnr_fg, msssim and flip_fg. */
export function evaluated(evaluator, model, tests) {
  const out = join(dirname(tests[0]), 'evaluated.json');
  run(evaluator, model, ...tests, '--json', out, '--quiet');
  return JSON.parse(readFileSync(out)).tests;
}
