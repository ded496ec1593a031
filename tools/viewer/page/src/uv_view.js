// The UV layout: the picture of a tile with the borders of charts, edges and seams.
import {
  BufferAttribute,
  BufferGeometry,
  Group,
  LineBasicMaterial,
  LineSegments,
  Mesh,
  OrthographicCamera,
  Scene,
} from 'three';
import {read_block} from './blocks.js';
import {Lines} from './lines.js';
import {set_uniforms, surface_material} from './surface.js';

const kBorder = {colour: [1, 1, 1], border: [0.1, 0.1, 0.15], width: 2.5};
const kSeam = {colour: [1, 0.45, 0.1], border: [0.05, 0.05, 0.08], width: 4};

export class UvView {
  constructor(scene, model) {
    this.scene = scene;
    this.model = model;
    this.three = new Scene();
    this.group = new Group();
    this.three.add(this.group);
    this.camera = new OrthographicCamera(-1, 1, 1, -1, -1, 1);
    this.material = surface_material(model.ramp, ['clamp', 'clamp']);
    this.group.add(this.make_picture());
    this.overlays = scene.tiles.map(() => ({}));
    this.tile_aspect = 1;
    this.reset();
  }

  make_picture() {
    const geometry = new BufferGeometry();
    const corners = new Float32Array([0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0]);
    const uvs = new Float32Array([0, 0, 1, 0, 1, 1, 0, 1]);
    geometry.setAttribute('position', new BufferAttribute(corners, 3));
    geometry.setAttribute('texture_uv', new BufferAttribute(uvs, 2));
    geometry.setAttribute('surface_normal', new BufferAttribute(new Float32Array(12), 3));
    geometry.setIndex([0, 1, 2, 0, 2, 3]);
    const picture = new Mesh(geometry, this.material);
    picture.frustumCulled = false;
    this.material.depthTest = false;
    return picture;
  }

  reset() {
    this.centre = [0.5, 0.5];
    this.height = null; // all of the tile, until somebody zooms
  }

  /// Width of the tile's picture over its height, in texels.
  set_tile_aspect(aspect) {
    this.tile_aspect = aspect;
    this.group.scale.set(aspect, 1, 1);
  }

  view_height(aspect) {
    return this.height ?? Math.max(1, this.tile_aspect / aspect) * 1.08;
  }

  /// \param x, y from -1 to 1 in the view
  uv_at(x, y, aspect) {
    const half = this.view_height(aspect) / 2;
    return [this.centre[0] + (x * half * aspect) / this.tile_aspect, this.centre[1] + y * half];
  }

  project([u, v], aspect) {
    const half = this.view_height(aspect) / 2;
    return {
      x: ((u - this.centre[0]) * this.tile_aspect) / half / aspect,
      y: (v - this.centre[1]) / half,
    };
  }

  pan(x, y, aspect) {
    const height = this.view_height(aspect);
    this.centre[0] -= (x * height) / this.tile_aspect;
    this.centre[1] -= y * height;
  }

  zoom(factor, x, y, aspect) {
    const before = this.view_height(aspect);
    this.height = Math.min(20, Math.max(1e-4, before / factor));
    const change = this.height / before - 1;
    this.centre[0] -= (x * before * change) / this.tile_aspect;
    this.centre[1] -= y * before * change;
  }

  // Edges of the tile's triangles: vertices are shared by tiles, but parts are not.
  edges_of(tile, kind) {
    const part = this.model.mesh.parts.findIndex((p) => p.tile === tile);
    return part < 0 ? new Uint32Array(0) : this.model.edges()[part][kind];
  }

  load_borders(tile) {
    const overlay = this.overlays[tile];
    if (overlay.borders) return;
    const {uvs} = this.model.mesh;
    const pairs = this.edges_of(tile, 'border');
    const segments = new Float32Array(3 * pairs.length);
    pairs.forEach((vertex, i) => {
      segments[3 * i] = uvs[2 * vertex];
      segments[3 * i + 1] = uvs[2 * vertex + 1];
    });
    overlay.borders = this.add_lines(segments, kBorder);
  }

  load_wireframe(tile) {
    const overlay = this.overlays[tile];
    if (overlay.wireframe) return;
    this.uv_attribute ??= new BufferAttribute(this.model.mesh.uvs, 2);
    this.wire_material ??= new LineBasicMaterial({
      color: 0x0d0d1a,
      transparent: true,
      opacity: 0.6,
      depthTest: false,
    });
    const geometry = new BufferGeometry();
    geometry.setAttribute('position', this.uv_attribute);
    geometry.setIndex(new BufferAttribute(this.edges_of(tile, 'inner'), 1));
    const object = new LineSegments(geometry, this.wire_material);
    object.frustumCulled = false;
    this.group.add(object);
    overlay.wireframe = {object};
  }

  /// Both sides of every seam that lies in the tile; `order` says whose values they take.
  async load_seams(tile) {
    const overlay = this.overlays[tile];
    if (overlay.seams) return;
    const {uvs, tiles, count} = this.scene.seams;
    const [coordinates, wears] = await Promise.all([read_block(uvs), read_block(tiles)]);
    const points = [];
    const order = [];
    for (let seam = 0; seam < count; ++seam) {
      for (let side = 0; side < 2; ++side) {
        if (wears[2 * seam + side] !== tile) continue;
        const at = 8 * seam + 4 * side;
        const [u0, v0, u1, v1] = coordinates.subarray(at, at + 4);
        points.push(u0, v0, 0, u1, v1, 0);
        order.push(seam);
      }
    }
    if (overlay.seams) return;
    overlay.seams = this.add_lines(new Float32Array(points), kSeam);
    overlay.seam_order = order;
  }

  set_seam_values(tile, before, after) {
    const {seams, seam_order} = this.overlays[tile];
    const sorted = (values) => values && seam_order.map((seam) => values[seam]);
    seams.set_values(sorted(before), sorted(after));
  }

  add_lines(segments, look) {
    const lines = new Lines(segments, this.model.ramp, look);
    lines.material.depthTest = false;
    this.group.add(lines.object);
    return lines;
  }

  show(state) {
    this.overlays.forEach(({borders, wireframe, seams}, tile) => {
      const here = tile === state.tile;
      if (borders) borders.object.visible = here && state.borders;
      if (wireframe) wireframe.object.visible = here && state.wireframe;
      if (seams) seams.object.visible = here && (state.seams || state.seam_errors);
    });
  }

  /// Before a viewport is drawn: the camera, and what depends on its size.
  set_viewport({width, height, pixels, state, split}) {
    const aspect = width / height;
    const half = this.view_height(aspect) / 2;
    const x = this.centre[0] * this.tile_aspect;
    const y = this.centre[1];
    Object.assign(this.camera, {
      left: x - half * aspect,
      right: x + half * aspect,
      top: y + half,
      bottom: y - half,
    });
    this.camera.updateProjectionMatrix();
    set_uniforms(this.material, {state, split});
    for (const {borders, seams} of this.overlays) {
      for (const lines of [borders, seams]) {
        lines?.set_viewport(width, height, pixels);
        lines?.set({state, split});
      }
    }
  }
}
