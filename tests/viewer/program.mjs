// The program under test: pages of its own, and its numbers.
import {execFileSync, spawnSync} from 'node:child_process';
import {existsSync, readFileSync} from 'node:fs';
import {join} from 'node:path';
import {folder} from './browser.mjs';

const program = process.env.ONMESH;

export const file = (name) => join(folder, name);

export function onmesh(...words) {
  return execFileSync(program, words, {cwd: folder, encoding: 'utf8', stdio: 'pipe'});
}

let reason;

/// Why tests of the program's own pages cannot run, or false.
export function no_pages() {
  if (reason !== undefined) return reason;
  make_cube();
  const words = ['view', 'cube.obj', '-t', 'cube.png', '-o', 'probe.html'];
  const {status, stderr} = spawnSync(program, words, {cwd: folder, encoding: 'utf8'});
  const made = status === 0 && existsSync(file('probe.html'));
  reason = made && readFileSync(file('probe.html'), 'utf8').includes('onmesh-scene')
    ? false
    : `the program writes no page yet (${(stderr ?? '').trim().split('\n')[0]})`;
  return reason;
}

/// cube.obj, cube.png, and noisy.png in its place, 128 x 128 texels.
export function make_cube() {
  if (existsSync(file('noisy.png'))) return;
  onmesh('make-mesh', 'cube', '-o', 'cube.obj', '-t', 'cube.png', '--size', '128');
  const noise = ['--size', '128', '--noise', '0.2'];
  onmesh('make-mesh', 'cube', '-o', 'noisy.obj', '-t', 'noisy.png', ...noise);
}

/// \return the page's path
export function make_page(name, ...words) {
  onmesh('view', ...words, '-o', name);
  return file(name);
}

/// Triangles of an OBJ file: {positions, uvs} of three corners each.
export function read_obj(name) {
  const [v, vt, triangles] = [[], [], []];
  for (const line of readFileSync(file(name), 'utf8').split('\n')) {
    const [kind, ...words] = line.trim().split(/\s+/);
    if (kind === 'v') v.push(words.map(Number));
    if (kind === 'vt') vt.push(words.map(Number));
    if (kind !== 'f') continue;
    const corners = words.map((word) => word.split('/').map((i) => Number(i) - 1));
    for (let k = 2; k < corners.length; ++k) {
      const three = [corners[0], corners[k - 1], corners[k]];
      triangles.push({positions: three.map(([i]) => v[i]), uvs: three.map(([, i]) => vt[i])});
    }
  }
  return triangles;
}

/// Where a texel's centre lies on the surface: {triangle, weights, position}, or null.
export function place_of_texel(triangles, column, row, width, height) {
  const [u, v] = [(column + 0.5) / width, 1 - (row + 0.5) / height];
  for (const [triangle, {positions, uvs}] of triangles.entries()) {
    const [[au, av], [bu, bv], [cu, cv]] = uvs;
    const area = (bu - au) * (cv - av) - (bv - av) * (cu - au);
    const b1 = ((u - au) * (cv - av) - (v - av) * (cu - au)) / area;
    const b2 = ((bu - au) * (v - av) - (bv - av) * (u - au)) / area;
    const weights = [1 - b1 - b2, b1, b2];
    if (!(Math.min(...weights) >= 0)) continue;
    const position = [0, 1, 2].map((k) =>
      weights.reduce((sum, weight, i) => sum + weight * positions[i][k], 0),
    );
    return {triangle, weights, position};
  }
  return null;
}

/// The vertices of a binary PLY file of doubles: one array per vertex.
export function read_ply_vertices(name) {
  const bytes = readFileSync(file(name));
  const start = bytes.indexOf('end_header\n') + 'end_header\n'.length;
  const header = bytes.subarray(0, start).toString('latin1');
  const count = Number(/element vertex (\d+)/.exec(header)[1]);
  const properties = header.split('element face')[0].match(/property double/g).length;
  return Array.from({length: count}, (_, i) =>
    Array.from({length: properties}, (_, k) =>
      bytes.readDoubleLE(start + 8 * (i * properties + k)),
    ),
  );
}
