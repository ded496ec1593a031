// Pages of scenes that the program does not easily make: data in the format of the page, written
// into the built page, as the program does it.
import {readFileSync} from 'node:fs';
import {deflateSync} from 'node:zlib';

const built = process.env.VIEWER_PAGE;

const kinds = new Map([
  [Uint8Array, 'u8'],
  [Uint16Array, 'u16'],
  [Uint32Array, 'u32'],
  [Int8Array, 'i8'],
  [Float32Array, 'f32'],
]);

/// The blocks of a page; add() returns the reference that the scene holds.
export class Blocks {
  constructor() {
    this.texts = [];
  }

  add(values, fields = {}) {
    let bytes = Buffer.from(values.buffer, values.byteOffset, values.byteLength);
    if (fields.filter === 'rows') bytes = differences(bytes, fields.row, fields.step);
    this.texts.push(deflateSync(bytes, {level: 1}).toString('base64'));
    const reference = {block: this.texts.length - 1, type: kinds.get(values.constructor)};
    return {...reference, count: values.length, filter: 'none', ...fields};
  }

  image(values, width, height, channels, fields = {}) {
    const step = channels * values.BYTES_PER_ELEMENT;
    const rows = {filter: 'rows', row: width * step, step};
    const sizes = {width, height, channels, full_width: width, full_height: height};
    return {...this.add(values, rows), ...sizes, ...fields};
  }
}

function differences(bytes, row, step) {
  const out = Buffer.alloc(bytes.length);
  for (let i = 0; i < bytes.length; ++i) {
    const last = i >= row ? bytes[i - row] : i >= step ? bytes[i - step] : 0;
    out[i] = (bytes[i] - last) & 255;
  }
  return out;
}

/// \return the page's text
export function page(scene, blocks) {
  const json = JSON.stringify(scene).replaceAll('<', '\\u003c');
  const scripts = [`<script type="application/json" id="onmesh-scene">${json}</script>`];
  blocks.texts.forEach((text, i) => {
    const open = `<script type="application/octet-stream" id="onmesh-block-${i}">`;
    scripts.push(`${open}${text}</script>`);
  });
  const [start, end] = readFileSync(built, 'utf8').split('<!-- onmesh data -->');
  return start + scripts.join('\n') + end;
}

/// A grid of (columns + 1) x (rows + 1) vertices over [0, 1]^2.
/// \param surface (u, v) -> {position, normal}
export function grid(columns, rows, surface) {
  const vertices = (columns + 1) * (rows + 1);
  const positions = new Float32Array(3 * vertices);
  const normals = new Int8Array(3 * vertices);
  const uvs = new Float32Array(2 * vertices);
  for (let j = 0, i = 0; j <= rows; ++j) {
    for (let k = 0; k <= columns; ++k, ++i) {
      const [u, v] = [k / columns, j / rows];
      const {position, normal} = surface(u, v);
      positions.set(position, 3 * i);
      normals.set(normal.map((n) => Math.round(127 * n)), 3 * i);
      uvs.set([u, v], 2 * i);
    }
  }
  const indices = new Uint32Array(6 * columns * rows);
  for (let j = 0, at = 0; j < rows; ++j) {
    for (let k = 0; k < columns; ++k, at += 6) {
      const a = j * (columns + 1) + k;
      const c = a + columns + 1;
      indices.set([a, a + 1, c + 1, a, c + 1, c], at);
    }
  }
  return {positions, normals, uvs, indices};
}

export const plane = (u, v) => ({position: [u, v, 0], normal: [0, 0, 1]});

export function torus(u, v) {
  const [a, b] = [2 * Math.PI * u, 2 * Math.PI * v];
  const normal = [Math.cos(a) * Math.cos(b), Math.sin(b), -Math.sin(a) * Math.cos(b)];
  const [x, z] = [Math.cos(a), -Math.sin(a)];
  const position = [x + 0.4 * normal[0], 0.4 * normal[1], z + 0.4 * normal[2]];
  return {position, normal};
}

/// A scene of one mesh without anything else. \param mesh as grid() returns it
export function bare_scene(mesh, blocks) {
  const {positions, normals, uvs, indices} = mesh;
  const [vertices, triangles] = [positions.length / 3, indices.length / 3];
  return {
    version: 1,
    program: 'onmesh fixture',
    title: 'fixture.obj',
    created: ['onmesh', 'view', 'fixture.obj', '-o', 'page.html'],
    notes: [],
    camera: {azimuth: 35, elevation: 25, up: 'y', zoom: 1, target: null, extent: null},
    mesh: {
      name: 'fixture.obj',
      file_vertices: vertices,
      file_triangles: triangles,
      diagonal: 1,
      vertices,
      triangles,
      positions: blocks.add(positions),
      normals: blocks.add(normals),
      uvs: uvs && blocks.add(uvs),
      indices: blocks.add(indices),
      faces: null,
      tile_of_triangle: null,
      wrap: ['clamp', 'clamp'],
      unit: 'mesh units',
    },
    tiles: uvs ? [{name: '1001'}] : [],
    afters: [],
    maps: [],
    seams: null,
    samples: null,
    nodes: null,
    fields: null,
    numbers: [],
  };
}

/// \param colour (column, row) -> codes
export function picture(width, height, channels, colour) {
  const values = new Uint8Array(width * height * channels);
  for (let row = 0, at = 0; row < height; ++row) {
    for (let column = 0; column < width; ++column, at += channels) {
      values.set(colour(column, row), at);
    }
  }
  return values;
}

export function map_of(name, before, afters, fields = {}) {
  return {
    name,
    space: 'sRGB',
    hdr: false,
    display: {encoding: 'srgb'},
    channels: ['R', 'G', 'B'],
    before: [before],
    after: afters.map((after) => [after]),
    range: [0, 1],
    numbers: afters.map(() => null),
    ...fields,
  };
}

/// The 16-bit float code of a number that has one, rounded towards zero.
export function half_code(x) {
  if (Number.isNaN(x)) return 0x7e00;
  const sign = x < 0 ? 0x8000 : 0;
  const size = Math.abs(x);
  if (size >= 65536) return sign | 0x7c00;
  if (size < 2 ** -14) return sign | Math.floor(size * 2 ** 24);
  const exponent = Math.floor(Math.log2(size));
  return sign | ((exponent + 15) << 10) | Math.floor((size / 2 ** exponent - 1) * 1024);
}

const noise = (i) => {
  const x = Math.sin(i * 12.9898) * 43758.5453;
  return x - Math.floor(x);
};

/// A torus with everything: two maps, two afters, two tiles, seams, samples, nodes, distances.
export function full_scene(blocks, size = 256) {
  const mesh = grid(96, 48, torus);
  const scene = bare_scene(mesh, blocks);
  const triangles = mesh.indices.length / 3;
  const tiles = new Uint16Array(triangles).map((_, t) => (t < triangles / 2 ? 0 : 1));
  scene.title = 'torus.obj';
  scene.notes = ['texture a.png is shown at 256 x 256 instead of 512 x 512'];
  scene.mesh.tile_of_triangle = blocks.add(tiles);
  scene.tiles = [{name: '1001'}, {name: '1002'}];
  scene.afters = [{name: 'filtered.png'}, {name: 'stronger.png'}];
  const clean = (column, row, tint) => {
    const odd = (Math.floor((column * 16) / size) + Math.floor((row * 16) / size)) % 2;
    return odd ? [200, 160 + tint, 90] : [60, 90, 150 + tint];
  };
  const image = (strength, tint) =>
    blocks.image(
      picture(size, size, 3, (x, y) => {
        const bump = (noise(x + y * size) - 0.5) * strength;
        return clean(x, y, tint).map((code) => Math.max(0, Math.min(255, Math.round(code + bump))));
      }),
      size,
      size,
      3,
    );
  const both = (strength) => [image(strength, 0), image(strength, 60)];
  scene.maps = [
    map_of('albedo', null, [], {
      before: both(90),
      after: [both(25), both(5)],
      numbers: [{psnr_db: 27.5, rms: 0.042, max: 0.13, seam_rms_before: 0.08}, null],
    }),
    hdr_map(blocks),
  ];
  Object.assign(scene, overlays(blocks, mesh), {fields: distances(blocks)});
  scene.numbers = [
    {
      title: 'Run',
      rows: [
        ['sigma spatial', '4 texels'],
        ['sigma range', '0.1'],
        ['time', '1.2 s'],
      ],
    },
  ];
  return scene;
}

function hdr_map(blocks) {
  const [width, height] = [128, 64];
  const make = (gain) => {
    const codes = new Uint16Array(width * height * 3);
    for (let i = 0; i < width * height; ++i) {
      const x = i % width;
      const light = gain * 2 ** (x / 16 - 4);
      [1, 0.8, 0.5].forEach((share, c) => (codes[3 * i + c] = half_code(light * share)));
    }
    codes.fill(0x7e00, 0, 24);
    return blocks.image(codes, width, height, 3, {type: 'f16', full_width: 256, full_height: 128});
  };
  return map_of('light', null, [], {
    space: 'linear',
    hdr: true,
    display: {encoding: 'linear'},
    before: [make(1), null],
    after: [[make(1.5), null], [null, null]],
    range: [0.05, 24],
  });
}

function overlays(blocks, {positions, uvs}) {
  const seams = {segments: [], uvs: [], tiles: [], errors: [[], [], []]};
  for (let k = 0; k < 96; ++k) {
    const [a, b] = [k, k + 1];
    const top = 48 * 97;
    for (const v of [a, b]) seams.segments.push(...positions.subarray(3 * v, 3 * v + 3));
    for (const v of [a, b, a + top, b + top]) seams.uvs.push(...uvs.subarray(2 * v, 2 * v + 2));
    seams.tiles.push(0, 1);
    seams.errors.forEach((list, state) => list.push((0.1 * k) / 96 / (state + 1)));
  }
  const samples = Array.from({length: 400}, (_, i) => torus(noise(i), noise(i + 0.5)).position);
  const nodes = [];
  for (let i = 0; i < 24; ++i) {
    for (let j = 0; j < 12; ++j) {
      const at = (x, y) => torus(x / 24, y / 12).position;
      nodes.push(...at(i, j), ...at(i + 1, j), ...at(i, j), ...at(i, j + 1));
    }
  }
  return {
    seams: {
      count: 96,
      segments: blocks.add(Float32Array.from(seams.segments)),
      uvs: blocks.add(Float32Array.from(seams.uvs)),
      tiles: blocks.add(Uint16Array.from(seams.tiles)),
      errors: [seams.errors.map((list) => blocks.add(Float32Array.from(list))), []],
    },
    samples: {
      positions: blocks.add(Float32Array.from(samples.flat())),
      count: 400,
      kind: 'Poisson-disk samples, 2.5 texels apart',
    },
    nodes: {segments: blocks.add(Float32Array.from(nodes)), count: 288, edges: 576},
  };
}

// Straight distances stand in for geodesic ones: the page only shows what it is given.
function distances(blocks) {
  const {positions, normals, indices} = grid(192, 96, torus);
  const source = torus(0, 0).position;
  const values = new Float32Array(positions.length / 3);
  for (let i = 0; i < values.length; ++i) {
    values[i] = Math.hypot(...source.map((x, k) => positions[3 * i + k] - x));
  }
  const other = values.map((x) => (x > 2 ? NaN : x));
  const layer = (name, of, max, step) => ({
    name,
    values: blocks.add(of),
    min: 0,
    max,
    unit: 'mesh units',
    source,
    step,
  });
  return {
    positions: blocks.add(positions),
    normals: blocks.add(normals),
    indices: blocks.add(indices),
    vertices: values.length,
    triangles: indices.length / 3,
    layers: [
      layer('distance from vertex 12', values, 2.8, 0.2),
      layer('distance up to 2', other, 2, 0.25),
    ],
  };
}
