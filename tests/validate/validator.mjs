// What the Khronos glTF validator says of a file.
import fs from 'node:fs';
import path from 'node:path';
import validator from 'gltf-validator';

const ERROR = 0;

// { errors: its messages of that severity, triangles }; throws if it cannot be read as glTF at all.
export async function validate(file) {
  const folder = path.dirname(file);
  const report = await validator.validateBytes(new Uint8Array(fs.readFileSync(file)), {
    uri: path.basename(file),
    maxIssues: 0,
    externalResourceFunction: async (uri) =>
      new Uint8Array(fs.readFileSync(path.join(folder, decodeURIComponent(uri)))),
  });
  return {
    errors: report.issues.messages.filter((message) => message.severity === ERROR),
    triangles: report.info?.totalTriangleCount ?? 0,
  };
}
