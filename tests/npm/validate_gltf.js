// SPDX-License-Identifier: GPL-3.0-or-later
// Runs the Khronos validator over binary glTF files: node validate_gltf.js FILE.glb...
// gltf-validator is looked for in node_modules of the current folder, in those of NODE_PATH, and
// beside this script. Exit status: 0 no errors, 1 errors or an unreadable file, 2 usage.
'use strict';

const fs = require('fs');
const path = require('path');

const SEVERITIES = ['error', 'warning', 'information', 'hint'];

function loadValidator() {
  const folders = [process.cwd()]
    .concat((process.env.NODE_PATH || '').split(path.delimiter).filter(Boolean))
    .concat(__dirname);
  return require(require.resolve('gltf-validator', { paths: folders }));
}

async function validate(validator, file) {
  const bytes = new Uint8Array(fs.readFileSync(file));
  const report = await validator.validateBytes(bytes, { uri: path.basename(file), maxIssues: 100 });
  const issues = report.issues;
  for (const issue of issues.messages) {
    const where = issue.pointer || (issue.offset === undefined ? '' : `byte ${issue.offset}`);
    console.log(`${file}: ${SEVERITIES[issue.severity]}: ${where}: ${issue.code}: ${issue.message}`);
  }
  console.log(
    `${file}: ${issues.numErrors} errors, ${issues.numWarnings} warnings, ` +
      `${issues.numInfos} information, ${issues.numHints} hints; ` +
      `${report.info.totalTriangleCount} triangles`
  );
  return issues.numErrors === 0;
}

async function main(files) {
  if (files.length === 0) {
    console.error('validate_gltf.js: usage: node validate_gltf.js FILE.glb...');
    return 2;
  }
  const validator = loadValidator();
  let valid = true;
  for (const file of files) valid = (await validate(validator, file)) && valid;
  return valid ? 0 : 1;
}

main(process.argv.slice(2)).then(
  (status) => {
    process.exitCode = status;
  },
  (error) => {
    console.error(`validate_gltf.js: ${error.message || error}`);
    process.exitCode = 1;
  }
);
