// Geodesic distances on the surface: colours and isolines over the finer mesh that holds them.
import {
  BufferAttribute,
  BufferGeometry,
  DoubleSide,
  GLSL3,
  Mesh,
  ShaderMaterial,
} from 'three';
import {read_block} from './blocks.js';
import {read_field_mesh} from './scene.js';
import {kLight, set_uniforms} from './surface.js';
import {BoxTree} from './tree.js';

const vertex_shader = `
in float scalar;
in vec3 surface_normal;
out float value;
out float known;
out vec3 normal_in_view;
out vec3 position_in_view;
void main() {
  bool missing = (floatBitsToUint(scalar) & 0x7f800000u) == 0x7f800000u;
  value = missing ? 0.0 : scalar;
  known = missing ? 0.0 : 1.0;
  normal_in_view = mat3(viewMatrix) * surface_normal;
  vec4 p = modelViewMatrix * vec4(position, 1.0);
  position_in_view = p.xyz;
  gl_Position = projectionMatrix * p;
}`;

// Isolines one and a half pixels wide: the distance to the nearest one is that of the values over
// the slope per pixel. Where lines would run together they fade; the least value has none.
const fragment_shader = `
precision highp float;
uniform sampler2D ramp;
uniform float low, high, interval, pixels;
uniform bool light;
in float value;
in float known;
in vec3 normal_in_view;
in vec3 position_in_view;
out vec4 pixel;
${kLight}
void main() {
  vec3 colour = vec3(0.72);
  float slope = length(vec2(dFdx(value), dFdy(value))) * pixels;
  if (known > 0.999) {
    float t = high > low ? clamp((value - low) / (high - low), 0.0, 1.0) : 0.5;
    colour = texture(ramp, vec2((t * 255.0 + 0.5) / 256.0, 0.5)).rgb;
    float line = interval > 0.0 ? (value - low) / interval : 0.0;
    if (slope > 0.0 && round(line) != 0.0) {
      float spacing = interval / slope;
      float distance = abs(line - round(line)) * spacing;
      float ink = clamp(1.25 - distance, 0.0, 1.0) * clamp((spacing - 2.0) / 4.0, 0.0, 1.0);
      colour = mix(colour, vec3(0.05, 0.05, 0.08), 0.8 * ink);
    }
  }
  if (light) colour *= lit(normal_in_view, position_in_view);
  pixel = vec4(colour, 1.0);
}`;

export class Fields {
  constructor(fields, ramp) {
    this.layers = fields.layers ?? [];
    this.source = fields;
    const uniforms = {ramp, low: 0, high: 1, interval: 0, pixels: 1, light: true};
    this.material = new ShaderMaterial({
      glslVersion: GLSL3,
      vertexShader: vertex_shader,
      fragmentShader: fragment_shader,
      uniforms: Object.fromEntries(Object.entries(uniforms).map(([k, value]) => [k, {value}])),
      side: DoubleSide,
      polygonOffset: true,
      polygonOffsetFactor: 1,
      polygonOffsetUnits: 1,
    });
    this.object = null;
    this.values = new Map();
  }

  /// The layers are others now, by their numbers.
  forget_layers() {
    this.values.clear();
    this.shown = null;
  }

  async load_mesh() {
    this.mesh ??= read_field_mesh(this.source);
    return this.mesh;
  }

  async layer_values(layer) {
    if (!this.values.has(layer)) this.values.set(layer, read_block(this.layers[layer].values));
    return this.values.get(layer);
  }

  /// Show a layer. \param parent where the object is put when there is one for the first time
  async show(layer, parent) {
    const [mesh, values] = await Promise.all([this.load_mesh(), this.layer_values(layer)]);
    if (!this.object) {
      const geometry = new BufferGeometry();
      geometry.setAttribute('position', new BufferAttribute(mesh.positions, 3));
      geometry.setAttribute('surface_normal', new BufferAttribute(mesh.normals, 3, true));
      geometry.setIndex(new BufferAttribute(mesh.indices, 1));
      this.object = new Mesh(geometry, this.material);
      this.object.frustumCulled = false;
      parent.add(this.object);
    }
    if (this.shown !== layer) {
      this.object.geometry.setAttribute('scalar', new BufferAttribute(values, 1));
      this.shown = layer;
    }
  }

  /// \return the step of the isolines that a layer has of itself
  natural_step(layer) {
    const {step, min, max} = this.layers[layer];
    return step > 0 ? step : (max - min) / 20;
  }

  set(layer, interval, light, pixels) {
    const {min, max} = this.layers[layer];
    set_uniforms(this.material, {low: min, high: max, interval, light, pixels});
  }

  /// Interpolated at the closest point of the surface; NaN where nothing was reached.
  async value_at(layer, position) {
    const [mesh, values] = await Promise.all([this.load_mesh(), this.layer_values(layer)]);
    this.tree ??= new BoxTree(mesh.positions, 3, mesh.indices);
    const {triangle, weights} = this.tree.nearest(position);
    return weights.reduce(
      (sum, weight, k) => sum + weight * values[mesh.indices[3 * triangle + k]],
      0,
    );
  }
}
