// The scene that the program wrote into the page, and its mesh.
import {read_block, read_coordinates} from './blocks.js';
import {PageError} from './page_error.js';

/// \return the scene's description with what may be left out filled in
export function read_scene() {
  const element = document.getElementById('onmesh-scene');
  if (!element) throw new PageError('This page holds no data yet: onmesh view writes it');
  let scene;
  try {
    scene = JSON.parse(element.textContent);
  } catch {
    throw new PageError('The description of the scene is damaged');
  }
  if (scene?.version !== 1)
    throw new PageError(`The data has version ${scene?.version}; this page reads version 1`);
  for (const list of ['notes', 'tiles', 'afters', 'maps', 'numbers']) scene[list] ??= [];
  scene.camera = {azimuth: 35, elevation: 25, up: 'y', zoom: 1, ...scene.camera};
  scene.title ??= '';
  if (!scene.mesh) throw new PageError('The scene has no mesh');
  return scene;
}

// Triangles sorted by tile, so that each tile's are drawn in one go. Returns per tile, and for
// those that wear no texture, first triangle and count.
function sort_by_tile(mesh, tiles) {
  const {indices, tile_of_triangle, triangles} = mesh;
  const bucket = (t) => Math.min(tile_of_triangle[t], tiles);
  const offsets = new Uint32Array(tiles + 2);
  for (let t = 0; t < triangles; ++t) ++offsets[bucket(t) + 1];
  for (let k = 0; k <= tiles; ++k) offsets[k + 1] += offsets[k];
  const next = offsets.slice();
  const sorted = new indices.constructor(indices.length);
  const faces = new Uint32Array(triangles);
  const sorted_tiles = new Uint16Array(triangles);
  for (let t = 0; t < triangles; ++t) {
    const to = next[bucket(t)]++;
    for (let k = 0; k < 3; ++k) sorted[3 * to + k] = indices[3 * t + k];
    faces[to] = mesh.faces ? mesh.faces[t] : t;
    sorted_tiles[to] = bucket(t);
  }
  Object.assign(mesh, {indices: sorted, faces, tile_of_triangle: sorted_tiles});
  return Array.from({length: tiles + 1}, (_, k) => ({
    tile: k < tiles ? k : null,
    first: offsets[k],
    count: offsets[k + 1] - offsets[k],
  })).filter((part) => part.count > 0);
}

function check_indices(indices, vertices, name) {
  for (let i = 0; i < indices.length; ++i) {
    if (indices[i] >= vertices) throw new PageError(`${name} names a vertex that is not there`);
  }
}

/// Decode the mesh: flat arrays, the parts by tile, and its bounding box.
export async function read_mesh(scene) {
  const source = scene.mesh;
  const [positions, normals, uvs, indices, faces, tiles] = await Promise.all([
    read_coordinates(source.positions, 3),
    source.normals ? read_block(source.normals) : null,
    source.uvs ? read_coordinates(source.uvs, 2) : null,
    read_block(source.indices),
    source.faces ? read_block(source.faces) : null,
    source.tile_of_triangle ? read_block(source.tile_of_triangle) : null,
  ]);
  const vertices = positions.length / 3;
  const triangles = indices.length / 3;
  if (triangles === 0) throw new PageError('The mesh has no triangles');
  check_indices(indices, vertices, 'The mesh');
  const mesh = {positions, uvs, indices, faces, vertices, triangles};
  mesh.normals = normals ?? smooth_normals(positions, indices);
  mesh.tile_of_triangle = tiles;
  const textured = uvs !== null && scene.tiles.length > 0;
  if (tiles && textured) mesh.parts = sort_by_tile(mesh, scene.tiles.length);
  else mesh.parts = [{tile: textured ? 0 : null, first: 0, count: triangles}];
  mesh.box = bounding_box(positions);
  return mesh;
}

/// Decode the finer mesh that distances are given on, without their values.
export async function read_field_mesh(fields) {
  const [positions, normals, indices] = await Promise.all([
    read_coordinates(fields.positions, 3),
    fields.normals ? read_block(fields.normals) : null,
    read_block(fields.indices),
  ]);
  check_indices(indices, positions.length / 3, 'The mesh of distances');
  return {positions, normals: normals ?? smooth_normals(positions, indices), indices};
}

function smooth_normals(positions, indices) {
  const sums = new Float64Array(positions.length);
  for (let i = 0; i < indices.length; i += 3) {
    const [a, b, c] = [0, 1, 2].map((k) => 3 * indices[i + k]);
    const [x, y, z] = [0, 1, 2].map((k) => positions[b + k] - positions[a + k]);
    const [u, v, w] = [0, 1, 2].map((k) => positions[c + k] - positions[a + k]);
    const normal = [y * w - z * v, z * u - x * w, x * v - y * u];
    for (const at of [a, b, c]) normal.forEach((n, k) => (sums[at + k] += n));
  }
  const normals = new Int8Array(positions.length);
  for (let i = 0; i < sums.length; i += 3) {
    const length = Math.hypot(sums[i], sums[i + 1], sums[i + 2]) || 1;
    for (let k = 0; k < 3; ++k) normals[i + k] = Math.round((127 * sums[i + k]) / length);
  }
  return normals;
}

function bounding_box(positions) {
  const low = [Infinity, Infinity, Infinity];
  const high = [-Infinity, -Infinity, -Infinity];
  for (let i = 0; i < positions.length; i += 3) {
    for (let k = 0; k < 3; ++k) {
      const x = positions[i + k];
      if (x < low[k]) low[k] = x;
      if (x > high[k]) high[k] = x;
    }
  }
  const centre = low.map((x, k) => x + (high[k] - x) / 2);
  const diagonal = Math.hypot(...low.map((x, k) => high[k] - x)) || 1;
  if (!Number.isFinite(diagonal)) throw new PageError('The mesh has a position that is no number');
  return {low, high, centre, diagonal};
}
