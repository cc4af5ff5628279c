// Where the parts of papers.mjs work: runs the programs, keeps models and pictures, and writes Markdown.
import { execFileSync } from 'node:child_process';
import { existsSync, mkdirSync, readFileSync } from 'node:fs';
import { basename, join } from 'node:path';

export class Workshop {
  /** `bin` holds the programs, `models` what is made on the way, `images` pictures of the page, which it calls
   *  `link`; `data` is a folder of real models, or undefined. */
  constructor({ bin, models, images, link, data }) {
    Object.assign(this, { bin, models, images, link, data });
    mkdirSync(models, { recursive: true });
    mkdirSync(images, { recursive: true });
  }

  /** Runs a program of `bin` and returns what it prints. */
  run(program, words, environment = {}) {
    console.error(`papers: ${basename(program)} ${words.join(' ')}`);
    return execFileSync(join(this.bin, program), words,
      { maxBuffer: 1 << 28, encoding: 'utf8', env: { ...process.env, ...environment }, stdio: ['ignore', 'pipe', 'inherit'] });
  }
  fovea(...words) {
    return this.run('apps/cli/fovea', [...words, '--quiet']);
  }
  report(...words) {
    return JSON.parse(this.run('apps/cli/fovea', [...words, '--json']));
  }

  /** A file of `models`. */
  file(name) {
    return join(this.models, name);
  }
  /** Fovea's own sample. */
  sample(name, detail = 1) {
    const file = this.file(`sample-${name}-${detail}.glb`);
    if (!existsSync(file)) this.fovea('sample', name, '-o', file, '--detail', `${detail}`);
    return file;
  }
  /** The given ones of the folder of real models, as far as they are there: [name, file] of each. */
  real(...files) {
    return files.map((file) => [basename(file).replace(/\.[^.]*$/, ''), this.data && join(this.data, file)])
      .filter(([, file]) => file && existsSync(file));
  }
  /** A model by `fovea simplify` in `models`. */
  simplified(model, name, ...options) {
    const out = this.file(name);
    this.fovea('simplify', model, '-o', out, '--force', '--allow-miss', ...options);
    return out;
  }
  triangles(model) {
    return this.report('info', model).totals.triangles;
  }
  /** What `fovea compare` finds of tests against their original: {base, lit} of each, and distances. */
  compared(original, tests, ...options) {
    const scores = (s) => ({ psnr: s.psnr_foreground ?? Infinity, msssim: s.ms_ssim_foreground, flip: s.flip_foreground });
    return this.report('compare', original, ...tests, ...options).results.map((r) => ({ ...r, base: scores(r.base_color), lit: scores(r.lit) }));
  }

  /** Draws a model by `fovea render` for the page and returns the Markdown that shows it. */
  draw(model, picture, ...options) {
    this.fovea('render', model, '-o', join(this.images, `${picture}.webp`), '--force', ...kView, ...options);
    return this.shown(picture);
  }
  /** The Markdown of a picture. */
  shown(picture, extension = 'webp') {
    return `![](${this.link}/${picture}.${extension})`;
  }
}

/** How models are drawn unless said otherwise: once, from the front, a little from above. */
const kView = ['--views', 'orbit', '--view-count', '1', '--elevation', '10', '--view-size', '200', '--samples', '3', '--background', '#ffffff'];

/** And from where a model that looks away is better seen. */
export const kFromTheSide = ['--view-count', '6', '--view', '3'];

/** A Markdown table; columns of numbers end with a colon. */
export function table(head, rows) {
  const line = (cells) => `| ${cells.join(' | ')} |`;
  const names = head.map((h) => h.replace(/:$/, ''));
  return [line(names), `|${head.map((h) => (h.endsWith(':') ? '--:' : '---')).join('|')}|`, ...rows.map(line)].join('\n');
}

/** Numbers for tables. */
export const fixed = (x, digits = 2) => (x === null || x === undefined ? '–' : Number.isFinite(x) ? x.toFixed(digits) : 'same');
export const signed = (x, digits = 2) => `${x < 0 ? '−' : '+'}${Math.abs(x).toFixed(digits)}`;
export const count = (n) => n.toLocaleString('en-US');
export const bold = (text, is) => (is ? `**${text}**` : text);

/** Numbers of a text file, one a line. */
export const numbers = (file) => readFileSync(file, 'utf8').split('\n').filter((line) => line !== '').map(Number);
