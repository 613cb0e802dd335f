// SPDX-License-Identifier: GPL-3.0-or-later
//
// Prints the errors and warnings of Khronos's glTF validator for each file; fails if there are any.
// usage: node validate_gltf.mjs FILE...
import { readFile } from "node:fs/promises";
import validator from "gltf-validator";

let failed = false;
for (const path of process.argv.slice(2)) {
  const report = await validator.validateBytes(new Uint8Array(await readFile(path)), { maxIssues: 100 });
  for (const message of report.issues.messages)
    if (message.severity <= 1) console.error(`${path}: ${message.code} ${message.pointer}: ${message.message}`);
  const { numErrors, numWarnings } = report.issues;
  failed ||= report.mimeType !== "model/gltf-binary" || numErrors > 0 || numWarnings > 0;
}
process.exit(failed ? 1 : 0);
