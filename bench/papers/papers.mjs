// The tables and figures of the published systems again, on our models: papers.mjs BIN PAGE IMAGES [PART...] runs the
// parts that PAGE has places for, from <!-- NAME --> to <!-- /NAME -->, and puts what they print there. BIN is a
// build's folder, IMAGES the pictures' folder. FOVEA_DATA names a folder of real models: what needs those stays as it is without it.
import { readFileSync, writeFileSync } from 'node:fs';
import { dirname, relative } from 'node:path';
import { Workshop } from './workshop.mjs';
import gonzalez from './gonzalez.mjs';
import horbelt from './horbelt.mjs';
import mata from './mata.mjs';
import munaretti from './munaretti.mjs';
import yang from './yang.mjs';

const parts = { ...yang, ...munaretti, ...gonzalez, ...horbelt, ...mata };
const [bin, page, images, ...asked] = process.argv.slice(2);
const unknown = asked.filter((name) => !Object.keys(parts).some((part) => part.startsWith(name)));
if (!images || unknown.length > 0) {
  console.error(unknown.length > 0 ? `papers.mjs: no part begins with ${unknown.join(', ')}` : 'usage: papers.mjs BIN PAGE IMAGES [PART...]');
  console.error(`parts: ${Object.keys(parts).join(' ')}`);
  process.exit(2);
}

const workshop = new Workshop({
  bin, images, models: 'out/papers', link: relative(dirname(page), images), data: process.env.FOVEA_DATA,
});
for (const [name, part] of Object.entries(parts)) {
  if (asked.length > 0 && !asked.some((a) => name.startsWith(a))) continue;
  const text = part(workshop);
  if (text === undefined) {
    console.error(`papers: ${name} needs models of FOVEA_DATA and stays as it is`);
    continue;
  }
  // Each part is put there at once, so that nothing is lost if a later one fails.
  const before = readFileSync(page, 'utf8');
  const [from, to] = [`<!-- ${name} -->`, `<!-- /${name} -->`];
  const begin = before.indexOf(from), end = before.indexOf(to);
  if (begin < 0 || end < begin) throw new Error(`${page} has no place for ${name}`);
  writeFileSync(page, `${before.slice(0, begin + from.length)}\n\n${text.trim()}\n\n${before.slice(end)}`);
}
