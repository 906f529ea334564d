// SPDX-License-Identifier: MIT
//
// usage: node validate_gltf.mjs [FILE...]
//
// What the Khronos Group's glTF validator (npm: gltf-validator) says of files; fails if that is an error or a warning. The
// package lies in build/npm, where cmake/test.sh puts it. Without a file it says whether it is there.

import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { fileURLToPath } from "node:url";

let validator;
try {
  validator = createRequire(fileURLToPath(new URL("../../build/npm/package.json", import.meta.url)))("gltf-validator");
} catch {
  console.log("abut skips: npm's gltf-validator is not there (cmake/test.sh brings it)");
  process.exit(process.argv.length > 2 ? 0 : 1);
}
let wrong = 0;
for (const file of process.argv.slice(2)) {
  const report = await validator.validateBytes(new Uint8Array(readFileSync(file)), { maxIssues: 100 });
  for (const issue of report.issues.messages) {
    if (issue.severity < 2) console.log(`${file}: ${issue.pointer}: ${issue.code}: ${issue.message}`);
  }
  wrong += report.issues.numErrors + report.issues.numWarnings;
}
process.exit(wrong > 0 ? 1 : 0);
