// What is drawn of the model: its surface, distances on it, and lines and points over it.
import {
  BufferAttribute,
  BufferGeometry,
  Group,
  LineBasicMaterial,
  LineSegments,
  Mesh,
  Points,
  GLSL3,
  Scene,
  ShaderMaterial,
} from 'three';
import {read_block} from './blocks.js';
import {find_edges} from './edges.js';
import {Fields} from './fields.js';
import {Lines} from './lines.js';
import {set_uniforms, surface_material} from './surface.js';

const kSeam = {colour: [1, 0.45, 0.1], border: [0.05, 0.05, 0.08], width: 4};
// Chords of a curved surface run below it.
const kNode = {colour: [0.1, 0.45, 0.75], border: [0.1, 0.45, 0.75], width: 1, lift: 1.5e-3};

const point_vertex_shader = `
uniform float size;
void main() {
  gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
  gl_Position.z -= 3e-4 * gl_Position.w;
  gl_PointSize = size;
}`;

const point_fragment_shader = `
precision highp float;
out vec4 pixel;
void main() {
  float radius = length(gl_PointCoord - 0.5);
  if (radius > 0.5) discard;
  pixel = vec4(radius > 0.32 ? vec3(0.05, 0.05, 0.08) : vec3(1.0, 0.85, 0.2), 1.0);
}`;

export class Model {
  constructor(scene, mesh, ramp) {
    this.scene = scene;
    this.mesh = mesh;
    this.ramp = ramp;
    this.three = new Scene();
    this.group = new Group();
    const {centre, diagonal} = mesh.box;
    this.group.scale.setScalar(1 / diagonal);
    this.group.position.set(...centre.map((x) => -x / diagonal));
    this.three.add(this.group);
    this.materials = mesh.parts.map(() =>
      surface_material(ramp, scene.mesh.wrap ?? ['repeat', 'repeat']),
    );
    this.group.add((this.surface = this.make_surface()));
    this.fields = scene.fields ? new Fields(scene.fields, ramp) : null;
    this.lines = new Set();
  }

  /// Distances that the scene has got since.
  take_fields() {
    if (this.fields?.object) this.group.remove(this.fields.object);
    this.fields = new Fields(this.scene.fields, this.ramp);
  }

  make_surface() {
    const {mesh} = this;
    const geometry = new BufferGeometry();
    const uvs = mesh.uvs ?? new Float32Array(2 * mesh.vertices);
    this.position_attribute = new BufferAttribute(mesh.positions, 3);
    geometry.setAttribute('position', this.position_attribute);
    geometry.setAttribute('surface_normal', new BufferAttribute(mesh.normals, 3, true));
    geometry.setAttribute('texture_uv', new BufferAttribute(uvs, 2));
    geometry.setIndex(new BufferAttribute(mesh.indices, 1));
    mesh.parts.forEach(({first, count}, i) => geometry.addGroup(3 * first, 3 * count, i));
    const surface = new Mesh(geometry, this.materials);
    surface.frustumCulled = false;
    return surface;
  }

  add_lines(segments, look) {
    const lines = new Lines(segments, this.ramp, look);
    this.group.add(lines.object);
    this.lines.add(lines);
    return lines;
  }

  async load_seams() {
    this.seams ??= this.add_lines(await read_block(this.scene.seams.segments), kSeam);
    return this.seams;
  }

  async load_nodes() {
    this.nodes ??= this.add_lines(await read_block(this.scene.nodes.segments), kNode);
  }

  /// Other samples than before, to be loaded when they are shown.
  forget_samples() {
    if (!this.samples) return;
    this.group.remove(this.samples);
    this.samples.geometry.dispose();
    this.samples = null;
  }

  async load_samples() {
    if (this.samples || !this.scene.samples) return;
    const geometry = new BufferGeometry();
    const positions = await read_block(this.scene.samples.positions);
    geometry.setAttribute('position', new BufferAttribute(positions, 3));
    const material = new ShaderMaterial({
      glslVersion: GLSL3,
      vertexShader: point_vertex_shader,
      fragmentShader: point_fragment_shader,
      uniforms: {size: {value: 6}},
    });
    this.samples = new Points(geometry, material);
    this.samples.frustumCulled = false;
    this.group.add(this.samples);
  }

  /// The edges of the mesh, which the UV layout shows, too.
  edges() {
    this.found_edges ??= this.mesh.parts.map(({first, count}) =>
      find_edges(this.mesh.indices, this.mesh.vertices, first, count),
    );
    return this.found_edges;
  }

  load_wireframe() {
    if (this.wireframe) return;
    this.wireframe = new Group();
    const material = new LineBasicMaterial({color: 0x0d0d1a, transparent: true, opacity: 0.75});
    for (const {inner, border} of this.edges()) {
      for (const pairs of [inner, border]) {
        const geometry = new BufferGeometry();
        geometry.setAttribute('position', this.position_attribute);
        geometry.setIndex(new BufferAttribute(pairs, 1));
        const lines = new LineSegments(geometry, material);
        lines.frustumCulled = false;
        this.wireframe.add(lines);
      }
    }
    this.group.add(this.wireframe);
  }

  /// Show what the state asks for; all that it needs is loaded.
  show(state) {
    const distance = state.colour === 'distance' && this.fields?.object;
    this.surface.visible = !distance;
    if (this.fields?.object) this.fields.object.visible = Boolean(distance);
    if (this.seams) this.seams.object.visible = state.seams || state.seam_errors;
    if (this.nodes) this.nodes.object.visible = state.nodes;
    if (this.samples) this.samples.visible = state.samples;
    if (this.wireframe) this.wireframe.visible = state.wireframe;
  }

  /// Before a viewport is drawn: what depends on it. Sizes are in pixels of the screen.
  set_viewport({width, height, pixels, state, split}) {
    for (const material of this.materials) set_uniforms(material, {state, split});
    for (const lines of this.lines) {
      lines.set_viewport(width, height, pixels);
      lines.set({state, split});
    }
    if (this.samples) set_uniforms(this.samples.material, {size: 6 * pixels});
  }
}
