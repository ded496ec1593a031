// Bundles src/ into built/page.html, one file without any reference to another.
//   node build.mjs           writes built/
//   node build.mjs --check   builds elsewhere and fails if built/ differs
import {createHash} from 'node:crypto';
import {mkdtempSync, mkdirSync, readFileSync, rmSync, writeFileSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {dirname, join} from 'node:path';
import {fileURLToPath} from 'node:url';
import {build, transform} from 'esbuild';

const here = dirname(fileURLToPath(import.meta.url));
const read = (...path) => readFileSync(join(here, ...path), 'utf8');
const read_bytes = (folder, name) => readFileSync(join(folder, name));
const hash = (text) => `'sha256-${createHash('sha256').update(text).digest('base64')}'`;

function fill(template, parts) {
  // A function as replacement, because `$` in a string would have a meaning.
  return template.replace(/\{\{(\w+)\}\}/g, (_, name) => parts[name]);
}

async function bundle() {
  const {outputFiles} = await build({
    absWorkingDir: here,
    entryPoints: ['src/main.js'],
    bundle: true,
    minify: true,
    format: 'iife',
    target: ['chrome110', 'firefox113', 'safari16.4'],
    charset: 'ascii',
    legalComments: 'none',
    write: false,
  });
  return outputFiles[0].text.trim();
}

async function build_into(folder) {
  const licence = read('node_modules', 'three', 'LICENSE').trim();
  const {version} = JSON.parse(read('node_modules', 'three', 'package.json'));
  const script = `/*\nContains three.js ${version}:\n\n${licence}\n*/\n${await bundle()}`;
  if (/<\/script|<!--/i.test(script)) throw new Error('the bundle holds what ends a script');
  const css = await transform(read('src', 'style.css'), {loader: 'css', minify: true});
  const style = css.code.trim();
  const policy = [
    "default-src 'none'",
    `script-src ${hash(script)}`,
    `style-src ${hash(style)}`,
    'img-src data: blob:',
    "connect-src 'none'",
    "form-action 'none'",
    "base-uri 'none'",
  ].join('; ');
  const page = fill(read('src', 'page.html'), {policy, style, script});
  if (page.split('<!-- onmesh data -->').length !== 2)
    throw new Error('the page must have one place for data');
  mkdirSync(folder, {recursive: true});
  writeFileSync(join(folder, 'page.html'), page);
  writeFileSync(join(folder, 'LICENSE.three'), `${licence}\n`);
}

async function check() {
  const folder = mkdtempSync(join(tmpdir(), 'onmesh-page-'));
  try {
    await build_into(folder);
    for (const name of ['page.html', 'LICENSE.three']) {
      const [made, committed] = [folder, join(here, 'built')].map((at) => read_bytes(at, name));
      if (made.equals(committed)) continue;
      console.error(`built/${name} is not what src/ builds: run node build.mjs and commit it`);
      process.exitCode = 1;
    }
  } finally {
    rmSync(folder, {recursive: true});
  }
}

if (process.argv.includes('--check')) await check();
else await build_into(join(here, 'built'));
