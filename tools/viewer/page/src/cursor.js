// The place that is pointed at, on the surface and in the texture at once.
import {blend, BoxTree} from './tree.js';

const kNominal = 1024; // texels a side where no image says how many there are

export class Cursor {
  constructor(scene, mesh, images) {
    Object.assign(this, {scene, mesh, images});
    this.wrap = scene.mesh.wrap ?? ['repeat', 'repeat'];
  }

  /// \return {width, height} of the tile's texture in texels, and whether an image says so
  size(map, tile) {
    const states = this.scene.afters.length + 1;
    for (const of of [map, ...this.scene.maps.keys()]) {
      for (let state = 0; state < states; ++state) {
        const image = this.images.source(of, state, tile);
        if (!image) continue;
        const {full_width, full_height} = image;
        const shown = `${image.width} × ${image.height}`;
        return {width: full_width ?? image.width, height: full_height ?? image.height, shown};
      }
    }
    return {width: kNominal, height: kNominal, shown: null};
  }

  surface_tree() {
    this.tree ??= new BoxTree(this.mesh.positions, 3, this.mesh.indices);
    return this.tree;
  }

  uv_tree() {
    this.uv ??= new BoxTree(this.mesh.uvs, 2, this.mesh.indices);
    return this.uv;
  }

  corners(triangle, of, stride) {
    return [0, 1, 2].map((k) => {
      const at = stride * this.mesh.indices[3 * triangle + k];
      return [of[at], of[at + 1], stride === 3 ? of[at + 2] : 0];
    });
  }

  face(triangle) {
    return this.mesh.faces ? this.mesh.faces[triangle] : triangle;
  }

  tile_of(triangle) {
    const {parts} = this.mesh;
    return parts.find((p) => triangle >= p.first && triangle < p.first + p.count).tile;
  }

  /// \return where a ray first hits the surface: {triangle, weights, distance}, or null
  hit({origin, direction}) {
    return this.surface_tree().ray(origin, direction);
  }

  /// What a place of the surface is: its texel and all that the page says about it.
  at_surface(map, {triangle, weights}) {
    const tile = this.tile_of(triangle);
    const position = blend(this.corners(triangle, this.mesh.positions, 3), weights);
    const place = {triangle: this.face(triangle), weights, position, tile, on_surface: true};
    if (tile === null) return place;
    const [u, v] = blend(this.corners(triangle, this.mesh.uvs, 2), weights);
    const {width, height, shown} = this.size(map, tile);
    const column = Math.floor(wrapped(u, this.wrap[0]) * width);
    const row = Math.floor((1 - wrapped(v, this.wrap[1])) * height);
    return {
      ...place,
      column: Math.min(width - 1, column),
      row: Math.min(height - 1, row),
      width,
      height,
      shown,
    };
  }

  /// What a texel of a tile is; its position is that of its centre on the face that covers it, of
  /// several the first of the file.
  at_texel(map, tile, column, row) {
    const {width, height, shown} = this.size(map, tile);
    if (!(column >= 0 && column < width && row >= 0 && row < height)) return null;
    const texel = {tile, column, row, width, height, shown, on_surface: false};
    const found = this.first_at((column + 0.5) / width, 1 - (row + 0.5) / height, tile);
    if (!found) return texel;
    const {triangle, weights} = found;
    const position = blend(this.corners(triangle, this.mesh.positions, 3), weights);
    return {...texel, triangle: this.face(triangle), weights, position, on_surface: true};
  }

  first_at(u, v, tile) {
    let best = null;
    for (const x of this.unwrapped(u, 0)) {
      for (const y of this.unwrapped(v, 1)) {
        this.uv_tree().holding(x, y, (triangle, weights) => {
          if (this.tile_of(triangle) !== tile) return;
          if (!best || this.face(triangle) < this.face(best.triangle)) best = {triangle, weights};
        });
      }
    }
    return best;
  }

  // All coordinates that the wrap mode leads to this one, as far as the mesh's UVs go.
  unwrapped(x, axis) {
    if (this.wrap[axis] === 'clamp') return [x];
    this.ranges ??= [0, 1].map((k) => range(this.mesh.uvs, k));
    const [low, high] = this.ranges[axis];
    const first = Math.max(-64, Math.floor(low));
    const last = Math.max(first, Math.min(64, Math.ceil(high) - 1));
    return Array.from({length: last - first + 1}, (_, i) => {
      const turned = this.wrap[axis] === 'mirror' && (first + i) % 2 !== 0;
      return first + i + (turned ? 1 - x : x);
    });
  }

  /// Values of the map's images at a texel, per state; null where there is no image.
  async values(map, {tile, column, row}) {
    const states = Array.from({length: this.scene.afters.length + 1}, (_, state) => state);
    const images = await Promise.all(states.map((s) => this.images.decoded(map, s, tile)));
    return images.map((image) => image && image.values(column, row));
  }
}

function wrapped(x, mode) {
  if (mode === 'clamp') return Math.min(1, Math.max(0, x));
  const period = Math.floor(x);
  const share = x - period;
  return mode === 'mirror' && period % 2 !== 0 ? 1 - share : share;
}

function range(uvs, axis) {
  let low = Infinity;
  let high = -Infinity;
  for (let i = axis; i < uvs.length; i += 2) {
    if (uvs[i] < low) low = uvs[i];
    if (uvs[i] > high) high = uvs[i];
  }
  return [low, high];
}
