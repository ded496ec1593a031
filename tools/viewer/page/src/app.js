// The page: it holds the state, draws on demand, and links the model with the UV layout.
import {OrbitCamera} from './camera.js';
import {colour_map_texture} from './colour_maps.js';
import {command_line} from './command.js';
import {show_controls} from './controls.js';
import {Cursor} from './cursor.js';
import {Images} from './images.js';
import {load} from './loading.js';
import {Model} from './model.js';
import {show_difference_numbers, show_legends, show_notes, show_readout} from './readout.js';
import {initial_state, valid_changes} from './state.js';
import {views_of} from './stage.js';
import {UvView} from './uv_view.js';

const by_id = (id) => document.getElementById(id);

export class App {
  /// \param report called with whatever goes wrong later
  constructor(scene, mesh, stage, report) {
    Object.assign(this, {scene, mesh, stage, report});
    this.images = new Images(scene, stage.largest_texture());
    this.cursor = new Cursor(scene, mesh, this.images);
    this.model = new Model(scene, mesh, colour_map_texture());
    this.uv_view = mesh.uvs && scene.tiles.length ? new UvView(scene, this.model) : null;
    this.camera = new OrbitCamera(scene.camera, mesh.box);
    this.state = initial_state(scene);
    this.ends = {difference: null, seam_error: null};
    this.kept = new Map();
    this.running = Promise.resolve();
    this.flicker_after = false;
    this.place = null;
    if (scene.fields) this.state.step = this.model.fields.natural_step(0);
  }

  once(key, make) {
    if (!this.kept.has(key)) this.kept.set(key, make());
    return this.kept.get(key);
  }

  /// Whether the exposure means something for the map.
  exposed() {
    const map = this.scene.maps[this.state.map];
    return Boolean(map && (map.hdr || map.display?.encoding === 'linear'));
  }

  /// Change parts of the state. \return a promise of the frame that shows it
  set(changes) {
    const valid = valid_changes(this.scene, this.state, changes);
    const new_layer = 'layer' in valid && valid.layer !== this.state.layer;
    if (new_layer && !('step' in valid)) valid.step = this.model.fields.natural_step(valid.layer);
    const resize = 'panes' in valid || 'compare' in valid;
    Object.assign(this.state, valid);
    if ('tile' in valid && this.place?.tile !== valid.tile) this.uv_view?.reset();
    this.show_panes();
    if (resize) this.fit();
    this.set_flicker();
    if (['map', 'after', 'layer'].some((name) => name in valid)) this.show_place();
    return this.refresh();
  }

  /// Load what the state needs and draw; calls that come meanwhile share the next turn.
  refresh() {
    if (!this.pending) {
      this.pending = this.running.then(() => {
        this.pending = null;
        return this.update();
      });
      this.running = this.pending.catch((error) => this.report(error));
    }
    return this.pending;
  }

  async update() {
    this.show_theme();
    const numbers = await load(this);
    show_controls(this.state, this.ends, this.exposed());
    show_difference_numbers(numbers);
    show_legends(this.legends());
    show_notes([...this.scene.notes, ...this.images.notes]);
    this.draw();
  }

  show_theme() {
    const dark = window.matchMedia('(prefers-color-scheme: dark)').matches ? 'dark' : 'light';
    const {theme} = this.state;
    document.documentElement.dataset.theme = theme === 'auto' ? dark : theme;
  }

  show_panes() {
    const {panes} = this.state;
    by_id('model-pane').hidden = panes === 'uv' && this.uv_view !== null;
    by_id('uv-pane').hidden = panes === 'model' || this.uv_view === null;
    by_id('stage').classList.toggle('both', panes === 'both');
  }

  legends() {
    const {state, scene, ends} = this;
    const legends = [];
    if (state.colour === 'difference' && ends.difference !== null) {
      const title = 'Difference of each texel';
      legends.push({title, low: 0, high: ends.difference, unit: '1 = full scale'});
    }
    if (state.colour === 'distance') {
      const {name, min, max, unit} = scene.fields.layers[state.layer];
      const title = name[0].toUpperCase() + name.slice(1);
      legends.push({title, low: min, high: max, unit});
    }
    if (state.seam_errors && ends.seam_error !== null) {
      const title = 'Seam error';
      legends.push({title, low: 0, high: ends.seam_error, unit: '1 = full scale'});
    }
    return legends;
  }

  set_flicker() {
    clearInterval(this.flicker);
    const {compare, flicker_runs, flicker_speed} = this.state;
    if (compare !== 'flicker' || !flicker_runs) return;
    this.flicker = setInterval(() => {
      this.flicker_after = !this.flicker_after;
      this.request_draw();
    }, 1000 / flicker_speed);
  }

  views() {
    return views_of(this.state, this.flicker_after);
  }

  aspect(pane) {
    return this.stage.aspect(pane, this.views());
  }

  /// After a change of size: all of the model again, unless somebody has chosen the view.
  fit() {
    this.stage.fit();
    if (!this.camera.moved) this.camera.frame(this.mesh.positions, this.aspect('model'));
  }

  reset_view() {
    this.camera.reset(this.mesh.positions, this.aspect('model'));
    this.request_draw();
  }

  request_draw() {
    this.frame ??= requestAnimationFrame(() => this.draw());
  }

  draw() {
    if (this.frame) cancelAnimationFrame(this.frame);
    this.frame = null;
    const {stage, camera, model, uv_view, state} = this;
    const views = this.views();
    stage.start_frame();
    stage.draw_pane('model', views, state.split, {
      three: model.three,
      camera: (aspect) => {
        camera.apply(aspect);
        return camera.three;
      },
      set_viewport: (of) => model.set_viewport(of),
    });
    if (uv_view) {
      stage.draw_pane('uv', views, state.split, {
        three: uv_view.three,
        camera: () => uv_view.camera,
        set_viewport: (of) => uv_view.set_viewport(of),
      });
    }
    this.show_tags(views);
    this.show_markers();
    const command = this.command();
    if (by_id('command').value !== command) by_id('command').value = command;
  }

  // Says which state is where.
  show_tags(views) {
    const after = this.scene.afters[this.state.after]?.name ?? 'after';
    const names = {before: 'before', after: `after: ${after}`};
    const shown = views.length > 1 ? ['before', 'after'] : [views[0].show, null];
    const [left, right] = views[0].show === 'split' ? ['before', 'after'] : shown;
    const told = this.scene.maps.length > 0 && this.state.colour === 'texture';
    for (const pane of Object.values(this.stage.panes)) {
      const write = (side, name) => {
        pane.querySelector(`.tag.${side}`).textContent = told && name ? names[name] : '';
      };
      write('left', left);
      write('right', right);
    }
    const divider = by_id('divider');
    divider.hidden = views[0].show !== 'split' || !told;
    divider.style.left = `${100 * this.state.split}%`;
  }

  show_markers() {
    const {stage, place, uv_view, state} = this;
    const views = this.views();
    let on_model = null;
    let behind = false;
    if (place?.on_surface) {
      on_model = this.camera.project(place.position, this.aspect('model'));
      if (on_model.depth <= 0) on_model = null;
      else behind = this.hidden_from_eye(place.position);
    }
    stage.mark('model', views, on_model, {behind});
    if (!uv_view) return;
    const in_tile = place && place.tile === state.tile && place.column !== undefined;
    if (!in_tile) return stage.mark('uv', views, null);
    const aspect = this.aspect('uv');
    const centre = [(place.column + 0.5) / place.width, 1 - (place.row + 0.5) / place.height];
    const texel = stage.box('uv').height / uv_view.view_height(aspect) / place.height;
    const look = texel > 8 ? {size: texel + 4, square: true} : {};
    stage.mark('uv', views, uv_view.project(centre, aspect), look);
  }

  hidden_from_eye(position) {
    const origin = this.camera.eye();
    const hit = this.cursor.hit({origin, direction: position.map((x, k) => x - origin[k])});
    return hit !== null && hit.distance < 1 - 1e-3 * Math.min(1, this.mesh.box.diagonal);
  }

  /// \return what lies under a place of the model's pane, CSS pixels, or null
  pick(x, y) {
    const at = this.stage.place('model', this.views(), x, y);
    const hit = this.cursor.hit(this.camera.ray(at.x, at.y, this.aspect('model')));
    return hit && this.cursor.at_surface(this.state.map, hit);
  }

  /// \return what lies under a place of the UV layout's pane, or null
  pick_uv(x, y) {
    const at = this.stage.place('uv', this.views(), x, y);
    const [u, v] = this.uv_view.uv_at(at.x, at.y, this.aspect('uv'));
    const {map, tile} = this.state;
    const {width, height} = this.cursor.size(map, tile);
    const column = Math.floor(u * width);
    const row = Math.floor((1 - v) * height);
    return this.cursor.at_texel(map, tile, column, row);
  }

  /// Mark a place in both panes and say what is there.
  point_at(place) {
    this.place = place;
    const tile = place?.tile;
    const elsewhere = tile !== undefined && tile !== null && tile !== this.state.tile;
    if (elsewhere && this.state.follow) this.set({tile});
    else this.show_place();
    this.request_draw();
  }

  async show_place() {
    const {place} = this;
    const details = await this.details(place).catch(() => ({values: null, distance: null}));
    if (place === this.place)
      show_readout(this.scene, this.state, place, details.values, details.distance);
  }

  /// Values of the images and the distance at a place.
  async details(place) {
    const {scene, state} = this;
    const textured = place && place.column !== undefined && scene.maps.length > 0;
    const states = textured ? await this.cursor.values(state.map, place) : null;
    const source = textured && this.images.source(state.map, 0, place.tile);
    const codes = source && source.type === 'u8';
    const values = states && {states, unit: codes ? ' of 255' : ''};
    const measured = place?.on_surface && scene.fields;
    const distance = measured
      ? await this.model.fields.value_at(state.layer, place.position)
      : null;
    return {values, distance};
  }

  command() {
    return command_line(this.scene, this.camera);
  }
}
