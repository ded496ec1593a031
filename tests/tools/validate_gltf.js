// Print what the official validator says of a glTF file: node validate_gltf.js FILE, in a folder
// where the package gltf-validator is installed.
const fs = require('fs');
const path = require('path');
const validator = require(path.join(process.cwd(), 'node_modules', 'gltf-validator'));

const file = process.argv[2];
const read = (name) => Promise.resolve(new Uint8Array(fs.readFileSync(name)));
read(file)
  .then((bytes) =>
    validator.validateBytes(bytes, {
      uri: path.basename(file),
      maxIssues: 0,
      externalResourceFunction: (uri) =>
        read(path.join(path.dirname(file), decodeURIComponent(uri))),
    }))
  .then((report) => {
    for (const issue of report.issues.messages)
      console.log(issue.severity, issue.code, issue.pointer || '', issue.message);
  })
  .catch((error) => {
    console.error(error);
    process.exit(1);
  });
