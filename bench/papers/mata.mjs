// Mata, Pastor, Rodríguez: Attention-based mesh simplification using distance transforms (2006).
import { count, fixed, table } from './workshop.mjs';

const error = 0.02;  // of the diagonal, away from the focus

/** Levels of the bunny, and of each how many triangles are left and how many of them are the original's. */
function levels(shop, name, at, settings) {
  const [bunny] = shop.real('scans/bunny.ply');
  if (!bunny) return undefined;
  const look = ['--elevation', '0', '--view-size', '220'];
  return settings.map(({ threshold, factor }) => {
    const out = shop.file(`bunny-${threshold}-${factor}.glb`);
    const report = shop.report('focus', bunny[1], '-o', out, '--force', '--allow-miss', '--at', at, '--threshold', `${threshold}`,
      '--factor', `${factor}`, '--error', `${error}`);
    const draw = (pass) => shop.draw(out, `${name}-${threshold}-${100 * factor}-${pass}`, ...look, '--pass', pass);
    const [judged] = shop.compared(bunny[1], [out], '--view-size', '256');
    return { threshold, factor, report, file: bunny[1], mesh: draw('triangle'), surface: () => draw('lit'), judged };
  });
}

function figure3(shop) {
  const found = levels(shop, 'mata-3', '75,60', [{ threshold: 178, factor: 0 }, { threshold: 178, factor: 0.05 }]);
  if (!found) return undefined;
  const [none, mild] = found, look = ['--elevation', '0', '--view-size', '220'];
  const heat = shop.file('bunny-heat.glb');
  shop.fovea('focus', none.file, '-o', heat, '--force', '--as', 'heat', '--at', '75,60', '--law', 'linear', '--threshold', '255');
  const column = (name) => found.map((level) => level[name]);
  return table(['the scan', 'distance from the focus', 'f = 0', 'f = 0.05', 'f = 0.05, as a surface'], [
    [shop.draw(none.file, 'mata-3-scan', ...look), shop.draw(heat, 'mata-3-heat', ...look, '--pass', 'base-color'), ...column('mesh'), mild.surface()],
    ['', '', ...column('report').map((r) => `${count(r.result.triangles)} triangles`), ''],
  ]);
}

function figure5(shop) {
  const thresholds = [60, 120, 200, 265];
  const found = levels(shop, 'mata-5', '75,60', thresholds.flatMap((threshold) => [0, 0.05].map((factor) => ({ threshold, factor }))));
  if (!found) return undefined;
  return table(['threshold:', 'f = 0', 'triangles:', 'as a surface', 'f = 0.05', 'triangles:', 'PSNR f = 0 / 0.05, dB:'], thresholds.map((threshold) => {
    const [none, mild] = found.filter((l) => l.threshold === threshold);
    return [threshold, none.mesh, count(none.report.result.triangles), none.surface(), mild.mesh, count(mild.report.result.triangles),
      `${fixed(none.judged.lit.psnr)} / ${fixed(mild.judged.lit.psnr)}`];
  }));
}

export default { 'mata-figure-3': figure3, 'mata-figure-5': figure5 };
