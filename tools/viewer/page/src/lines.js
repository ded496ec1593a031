// Lines of even width on the screen, each with a value before and after that may colour it.
import {
  BufferAttribute,
  DoubleSide,
  GLSL3,
  InstancedBufferAttribute,
  InstancedBufferGeometry,
  InstancedInterleavedBuffer,
  InterleavedBufferAttribute,
  Mesh,
  ShaderMaterial,
} from 'three';
import {set_uniforms} from './surface.js';

// A quad along each segment; what lies behind the eye is cut off before the division.
const vertex_shader = `
uniform vec2 viewport;
uniform float width, lift;
in vec3 from, to;
in vec2 values;
out float across;
flat out vec2 value;
void main() {
  vec4 a = projectionMatrix * modelViewMatrix * vec4(from, 1.0);
  vec4 b = projectionMatrix * modelViewMatrix * vec4(to, 1.0);
  float least = 1e-5;
  if (a.w < least && b.w > least) a = mix(b, a, (b.w - least) / (b.w - a.w));
  if (b.w < least && a.w > least) b = mix(a, b, (a.w - least) / (a.w - b.w));
  vec2 along = (b.xy / b.w - a.xy / a.w) * viewport;
  along = length(along) > 0.0 ? normalize(along) : vec2(1.0, 0.0);
  vec4 p = position.x < 0.5 ? a : b;
  // Half a width beyond the end, so that neighbours join.
  vec2 shift = vec2(-along.y, along.x) * position.y + along * (position.x - 0.5) * 0.7;
  p.xy += shift * width / viewport * p.w;
  p.z -= lift * p.w;
  gl_Position = p;
  across = position.y;
  value = values;
}`;

const fragment_shader = `
precision highp float;
uniform sampler2D ramp;
uniform vec3 colour, border;
uniform float value_end, split;
uniform int state;
uniform bool by_value;
in float across;
flat in vec2 value;
out vec4 pixel;
void main() {
  bool after = state == 1 || (state == 2 && gl_FragCoord.x >= split);
  vec3 ink = colour;
  if (by_value) {
    float x = after ? value.y : value.x;
    bool known = (floatBitsToUint(x) & 0x7f800000u) != 0x7f800000u;
    float t = value_end > 0.0 ? clamp(x / value_end, 0.0, 1.0) : 0.0;
    ink = known ? texture(ramp, vec2((t * 255.0 + 0.5) / 256.0, 0.5)).rgb : vec3(0.6);
  }
  pixel = vec4(mix(ink, border, step(by_value ? 0.62 : 0.55, abs(across))), 1.0);
}`;

export class Lines {
  /// \param segments two points of three coordinates a line
  /// \param look width in CSS pixels; lift towards the eye, of the range of depths from -1 to 1
  constructor(segments, ramp, {colour, border, width, lift = 5e-4}) {
    this.count = segments.length / 6;
    const geometry = new InstancedBufferGeometry();
    const quad = new Float32Array([0, -1, 0, 1, -1, 0, 1, 1, 0, 0, 1, 0]);
    geometry.setAttribute('position', new BufferAttribute(quad, 3));
    geometry.setIndex([0, 1, 2, 0, 2, 3]);
    const ends = new InstancedInterleavedBuffer(segments, 6, 1);
    geometry.setAttribute('from', new InterleavedBufferAttribute(ends, 3, 0));
    geometry.setAttribute('to', new InterleavedBufferAttribute(ends, 3, 3));
    this.values = new InstancedBufferAttribute(new Float32Array(2 * this.count), 2);
    geometry.setAttribute('values', this.values);
    geometry.instanceCount = this.count;
    const uniforms = {
      ramp,
      colour,
      border,
      width,
      lift,
      viewport: [1, 1],
      value_end: 1,
      split: 0,
      state: 0,
      by_value: false,
    };
    this.material = new ShaderMaterial({
      glslVersion: GLSL3,
      vertexShader: vertex_shader,
      fragmentShader: fragment_shader,
      uniforms: Object.fromEntries(Object.entries(uniforms).map(([k, value]) => [k, {value}])),
      side: DoubleSide,
    });
    this.width = width;
    this.object = new Mesh(geometry, this.material);
    this.object.frustumCulled = false;
  }

  /// \param before, after a value a line; null = unknown
  set_values(before, after) {
    for (let i = 0; i < this.count; ++i) {
      this.values.array[2 * i] = before ? before[i] : NaN;
      this.values.array[2 * i + 1] = after ? after[i] : NaN;
    }
    this.values.needsUpdate = true;
  }

  set(values) {
    set_uniforms(this.material, values);
  }

  /// Before each viewport is drawn. \param pixels of the screen a CSS pixel
  set_viewport(width, height, pixels) {
    const wide = this.material.uniforms.by_value.value ? 1.6 : 1;
    this.set({viewport: [width, height], width: this.width * wide * pixels});
  }
}
