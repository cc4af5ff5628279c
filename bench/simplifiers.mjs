// Other simplifiers, called alike.
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { run } from './commands.mjs';

/** {hasBlender, peers}: by name, functions of a model, a file to write and the share of triangles to keep. Blender takes part if it
 *  is installed, and numpy with it. */
export function simplifiers(gltfpack) {
  const pack = (...more) => (model, out, share) =>
    run(gltfpack, '-i', model, '-o', out, '-si', `${share}`, '-se', '1', '-noq', '-kn', '-km', ...more);
  const blender = (...words) => run('blender', '--background', '--python-exit-code', '1', ...words);
  const peers = { 'gltfpack -sv': pack('-sv'), 'gltfpack -sv -sp': pack('-sv', '-sp') };
  let hasBlender = true;
  try {
    blender('--python-expr', 'import numpy');
    const script = join(dirname(fileURLToPath(import.meta.url)), 'peer_blender.py');
    peers.Blender = (model, out, share) => blender('--python', script, '--', model, out, `${share}`);
  } catch {
    hasBlender = false;
  }
  return { hasBlender, peers };
}
