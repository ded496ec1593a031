// Reads data blocks: base64 of a zlib stream of little-endian values.
import {PageError} from './page_error.js';

const kinds = {
  u8: Uint8Array,
  u16: Uint16Array,
  u32: Uint32Array,
  i8: Int8Array,
  f16: Uint16Array,
  f32: Float32Array,
};

function bytes_of_base64(text) {
  if (Uint8Array.fromBase64) return Uint8Array.fromBase64(text);
  const binary = atob(text);
  const bytes = new Uint8Array(binary.length);
  for (let i = 0; i < bytes.length; ++i) bytes[i] = binary.charCodeAt(i);
  return bytes;
}

async function inflate(bytes, size, name) {
  const out = new Uint8Array(size);
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('deflate'));
  const reader = stream.getReader();
  let at = 0;
  for (;;) {
    const {done, value} = await reader.read();
    if (done) break;
    if (at + value.length > size) throw new PageError(`${name} is longer than announced`);
    out.set(value, at);
    at += value.length;
  }
  if (at !== size) throw new PageError(`${name} is cut off`);
  return out;
}

// The first row holds differences from texel to texel, the others from row to row.
function unfilter(bytes, row, step) {
  for (let i = step; i < row; ++i) bytes[i] += bytes[i - step];
  for (let i = row; i < bytes.length; ++i) bytes[i] += bytes[i - row];
}

// Blocks that came after the page, by their numbers beyond its own. Each is read once.
const added = new Map();
let next_added = 1e6;

/// Take up what a server answers. \return its part of a scene, which refers to the blocks
export function adopt_blocks({part, blocks}) {
  const first = next_added;
  next_added += blocks.length;
  blocks.forEach((text, i) => added.set(first + i, text));
  const renumber = (value) => {
    if (value === null || typeof value !== 'object') return;
    if (typeof value.block === 'number') value.block += first;
    Object.values(value).forEach(renumber);
  };
  renumber(part);
  return part;
}

/// Let go of a block that nobody will read.
export function drop_block(reference) {
  added.delete(reference?.block);
}

function text_of_block(number) {
  const text = added.get(number);
  added.delete(number);
  return text ?? document.getElementById(`onmesh-block-${number}`)?.textContent;
}

/// Decode what a reference of the scene means; f16 values stay 16-bit codes, see half().
export async function read_block(reference) {
  const name = `Data block ${reference.block}`;
  const Kind = kinds[reference.type];
  if (!Kind) throw new PageError(`${name} has the unknown type ${reference.type}`);
  const text = text_of_block(reference.block);
  if (text === undefined) throw new PageError(`${name} is missing`);
  const size = reference.count * Kind.BYTES_PER_ELEMENT;
  let bytes;
  try {
    bytes = await inflate(bytes_of_base64(text), size, name);
  } catch (error) {
    if (error instanceof PageError) throw error;
    throw new PageError(`${name} cannot be unpacked`);
  }
  if (reference.filter === 'rows') unfilter(bytes, reference.row, reference.step ?? 1);
  return new Kind(bytes.buffer, 0, reference.count);
}

/// Decode coordinates: origin + scale * value where the reference has them.
export async function read_coordinates(reference, dimensions) {
  const values = await read_block(reference);
  const moved = reference.origin !== undefined || reference.scale !== undefined;
  if (values instanceof Float32Array && !moved) return values;
  const along = (field, without) =>
    Array.from({length: dimensions}, (_, k) =>
      Array.isArray(reference[field]) ? reference[field][k] : (reference[field] ?? without),
    );
  const origin = along('origin', 0);
  const scale = along('scale', 1);
  const out = new Float32Array(values.length);
  for (let i = 0, k = 0; i < out.length; ++i) {
    out[i] = origin[k] + scale[k] * values[i];
    k = k + 1 === dimensions ? 0 : k + 1;
  }
  return out;
}

let half_table = null;

/// The number that a 16-bit float code means.
export function half(code) {
  if (!half_table) {
    half_table = new Float32Array(65536);
    for (let i = 0; i < 65536; ++i) {
      const exponent = (i >> 10) & 31;
      const mantissa = i & 1023;
      let value;
      if (exponent === 31) value = mantissa ? NaN : Infinity;
      else if (exponent === 0) value = mantissa * 2 ** -24;
      else value = (1 + mantissa / 1024) * 2 ** (exponent - 15);
      half_table[i] = i & 0x8000 ? -value : value;
    }
  }
  return half_table[code];
}
