// Binary glTF as these scripts need it: one JSON chunk, one chunk of bytes behind it.
import { readFileSync, writeFileSync } from 'node:fs';

/** A .glb as {json, bytes}. */
export function readGlb(file) {
  const glb = readFileSync(file), length = glb.readUInt32LE(12);
  return { json: JSON.parse(glb.subarray(20, 20 + length)), bytes: glb.subarray(20 + length + 8) };
}

/** Writes a .glb; the length of `bytes` is a multiple of four. */
export function writeGlb(file, json, bytes) {
  let text = Buffer.from(JSON.stringify(json));
  text = Buffer.concat([text, Buffer.alloc((4 - (text.length % 4)) % 4, ' ')]);
  const head = Buffer.alloc(20), chunk = Buffer.alloc(8);
  head.write('glTF');
  [2, 28 + text.length + bytes.length, text.length].forEach((n, i) => head.writeUInt32LE(n, 4 + 4 * i));
  head.write('JSON', 16);
  chunk.writeUInt32LE(bytes.length);
  chunk.write('BIN\0', 4);
  writeFileSync(file, Buffer.concat([head, text, chunk, bytes]));
}
