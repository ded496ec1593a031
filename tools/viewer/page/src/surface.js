// The material of the model and of the UV layout's picture: one shader that shows the texture
// before or after, their difference, a checker of texels, or grey.
import {DoubleSide, GLSL3, ShaderMaterial} from 'three';

export const kColourings = {grey: 0, texture: 1, difference: 2, checker: 3};
export const kStates = {before: 0, after: 1, split: 2};
const kWraps = {clamp: 0, repeat: 1, mirror: 2};

const vertex_shader = `
in vec2 texture_uv;
in vec3 surface_normal;
out vec2 at_uv;
out vec3 normal_in_view;
out vec3 position_in_view;
void main() {
  at_uv = texture_uv;
  normal_in_view = mat3(viewMatrix) * surface_normal;
  vec4 p = modelViewMatrix * vec4(position, 1.0);
  position_in_view = p.xyz;
  gl_Position = projectionMatrix * p;
}`;

/// Light from the eye on both sides of a face, as in the static pictures.
export const kLight = `
float lit(vec3 normal, vec3 position) {
  float lengths = length(normal) * length(position);
  return 0.4 + 0.6 * (lengths > 0.0 ? abs(dot(normal, position)) / lengths : 1.0);
}`;

const fragment_shader = `
precision highp float;
precision highp int;
uniform sampler2D before_map, after_map, difference_map, ramp;
uniform bool has_before, has_after, has_difference;
uniform int colouring, state, channels, most_taps;
uniform float split;
uniform bool linear_filter, light, encode;
uniform float exposure, difference_end, checker_texels;
uniform vec2 checker_size;
uniform ivec2 wrap;
in vec2 at_uv;
in vec3 normal_in_view;
in vec3 position_in_view;
out vec4 pixel;
${kLight}
const vec3 grey = vec3(0.72);
const vec3 magenta = vec3(1.0, 0.0, 1.0);

bool finite(float x) { return (floatBitsToUint(x) & 0x7f800000u) != 0x7f800000u; }

int wrapped(int i, int n, int mode) {
  if (i >= 0 && i < n) return i;
  if (mode == 0) return clamp(i, 0, n - 1);
  if (mode == 1) return ((i % n) + n) % n;
  int k = ((i % (2 * n)) + 2 * n) % (2 * n);
  return k < n ? k : 2 * n - 1 - k;
}

// Maps are named by number, so that what follows is compiled once and not once a map: before, after
// and the difference.
vec4 texel(int map, ivec2 at, ivec2 size) {
  ivec2 p = ivec2(wrapped(at.x, size.x, wrap.x), wrapped(at.y, size.y, wrap.y));
  if (map == 0) return texelFetch(before_map, p, 0);
  if (map == 1) return texelFetch(after_map, p, 0);
  return texelFetch(difference_map, p, 0);
}

ivec2 size_of(int map) {
  if (map == 0) return textureSize(before_map, 0);
  if (map == 1) return textureSize(after_map, 0);
  return textureSize(difference_map, 0);
}

// A texel of weight 0 does not count, so that what is not finite spreads no further than weights do.
vec4 look_up(int map, ivec2 size, vec2 uv, bool smoothly) {
  vec2 p = vec2(uv.x, 1.0 - uv.y) * vec2(size);
  if (!smoothly) return texel(map, ivec2(floor(p)), size);
  p -= 0.5;
  ivec2 i = ivec2(floor(p));
  vec2 f = p - floor(p);
  vec4 sum = vec4(0.0);
  for (int k = 0; k < 4; ++k) {
    ivec2 d = ivec2(k & 1, k >> 1);
    float weight = (d.x == 1 ? f.x : 1.0 - f.x) * (d.y == 1 ? f.y : 1.0 - f.y);
    if (weight > 0.0) sum += weight * texel(map, i + d, size);
  }
  return sum;
}

float encoded(float x) {
  return x <= 0.0031308 ? 12.92 * x : 1.055 * pow(x, 1.0 / 2.4) - 0.055;
}

vec3 display(vec4 value) {
  vec3 colour = channels >= 3 ? value.rgb : value.rrr;
  if (!finite(colour.r) || !finite(colour.g) || !finite(colour.b)) return magenta;
  colour = clamp(colour * exposure, 0.0, 1.0);
  return encode ? vec3(encoded(colour.r), encoded(colour.g), encoded(colour.b)) : colour;
}

vec3 heat(vec4 value) {
  if (!finite(value.r)) return magenta;
  float t = difference_end > 0.0 ? clamp(value.r / difference_end, 0.0, 1.0) : 0.0;
  return texture(ramp, vec2((t * 255.0 + 0.5) / 256.0, 0.5)).rgb;
}

// Mean over the pixel where it is larger than texels: unlike mip maps it does not reach into
// neighbouring charts.
vec3 mean_colour(int map, bool smoothly) {
  vec2 dx = dFdx(at_uv), dy = dFdy(at_uv);
  ivec2 size = size_of(map);
  float footprint = max(length(dx * vec2(size)), length(dy * vec2(size)));
  int taps = min(int(ceil(clamp(footprint - 0.25, 1.0, 4.0))), most_taps);
  bool blend = smoothly && taps * 2 <= most_taps;
  vec3 sum = vec3(0.0);
  for (int j = 0; j < taps; ++j) {
    for (int i = 0; i < taps; ++i) {
      vec2 share = (vec2(i, j) + 0.5) / float(taps) - 0.5;
      vec4 value = look_up(map, size, at_uv + share.x * dx + share.y * dy, blend);
      sum += map == 2 ? heat(value) : display(value);
    }
  }
  return sum / float(taps * taps);
}

// Where squares are smaller than pixels, their mean.
vec3 checker() {
  vec2 p = at_uv * checker_size / checker_texels;
  vec2 square = floor(vec2(p.x, checker_size.y / checker_texels - p.y));
  float odd = mod(square.x + square.y, 2.0);
  float footprint = max(length(dFdx(p)), length(dFdy(p)));
  return vec3(mix(mix(0.28, 0.86, odd), 0.57, smoothstep(0.5, 1.0, footprint)));
}

void main() {
  bool after = state == 1 || (state == 2 && gl_FragCoord.x >= split);
  bool textured = colouring == 1 && (after ? has_after : has_before);
  vec3 colour = grey;
  if (textured || (colouring == 2 && has_difference))
    colour = mean_colour(colouring == 2 ? 2 : after ? 1 : 0, linear_filter && textured);
  else if (colouring == 3)
    colour = checker();
  if (light) colour *= lit(normal_in_view, position_in_view);
  pixel = vec4(colour, 1.0);
}`;

/// \param ramp the colour map as a texture
export function surface_material(ramp, wrap) {
  const uniforms = {
    before_map: ramp,
    after_map: ramp,
    difference_map: ramp,
    ramp,
    has_before: false,
    has_after: false,
    has_difference: false,
    colouring: 0,
    state: 0,
    channels: 3,
    most_taps: 4,
    split: 0,
    linear_filter: true,
    light: true,
    encode: false,
    exposure: 1,
    difference_end: 1,
    checker_texels: 1,
    checker_size: [1024, 1024],
    wrap: wrap.map((mode) => kWraps[mode] ?? kWraps.repeat),
  };
  return new ShaderMaterial({
    glslVersion: GLSL3,
    vertexShader: vertex_shader,
    fragmentShader: fragment_shader,
    uniforms: Object.fromEntries(Object.entries(uniforms).map(([k, value]) => [k, {value}])),
    side: DoubleSide,
    // Lines and points on the surface win against it.
    polygonOffset: true,
    polygonOffsetFactor: 1,
    polygonOffsetUnits: 1,
  });
}

/// Set some uniforms of a material.
export function set_uniforms(material, values) {
  for (const [name, value] of Object.entries(values)) material.uniforms[name].value = value;
}
