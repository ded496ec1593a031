// A page with a server: the filter is tried here. The preview follows the controls, one at a time,
// the newest wins; full runs, distances and samples are asked for by buttons and clicks.
import {fill_select} from './controls.js';
import {Cancelled, post, result, status} from './live_client.js';
import {controls_of_preset, filter_line, kInitial, options_of} from './live_options.js';
import {
  say,
  set_up_panel,
  show_errors,
  show_panel,
  show_progress,
  show_question,
} from './live_panel.js';
import {show_numbers} from './readout.js';

const by_id = (id) => document.getElementById(`live-${id}`);
const kPreview = 0; // among the scene's states after
const kRun = 1;
const kMostLayers = 12;
const kPoll = 200; // ms
const kGather = 15; // ms: moves of one frame are one

const pause = (ms) => new Promise((resolve) => setTimeout(resolve, ms));

export class Live {
  constructor(app) {
    this.app = app;
    this.live = app.scene.live;
    this.controls = {...kInitial};
    this.touched = new Set();
    this.wanted = false;
    this.shown = 0; // previews that came
    this.can_filter = app.scene.maps.length > 0;
    if (this.can_filter) app.scene.afters[kPreview].reduced = this.live.reduced;
    this.has_run = false;
    by_id('why').textContent = this.live.why_no_textures ? `${this.live.why_no_textures}.` : '';
    by_id('why').hidden = !this.live.why_no_textures;
    document.getElementById('layers').hidden = !app.scene.fields;
    set_up_panel(this.live, (name, value) => this.change(name, value));
    this.listen();
  }

  listen() {
    const on = (id, run) =>
      by_id(id)?.addEventListener('click', () => run().catch((error) => this.fail(error)));
    on('run', () => this.run());
    on('cancel', () => post('cancel'));
    on('save', () => this.save(false));
    on('yes', () => this.save(true));
    on('no', async () => show_question(null));
    on('copy', () => this.copy());
    on('samples-show', () => this.show_samples());
    on('from-mark', () => this.measure_from(this.marked()));
    if (this.can_filter) by_id('name').value = this.live.save_name;
    by_id('name')?.addEventListener('input', () => this.show());
  }

  async start() {
    this.show();
    if (!this.can_filter) return;
    say('The first preview is on its way');
    show_progress(null);
    await this.preview();
    const {run} = await status();
    if (run?.state === 'running' || run?.state === 'waiting') this.follow(run.number);
    else if (run?.has_result) await this.take_run();
  }

  fail(error) {
    say(`${error.message}.`, true);
  }

  /// A control has been moved. \return as preview()
  change(name, value) {
    this.controls[name] = value;
    if (name === 'preset') {
      this.touched.clear();
      const {preset, samples, spacing} = this.controls;
      const chosen = this.live.presets.find((p) => p.name === value);
      const changes = chosen ? controls_of_preset(chosen.options) : {};
      this.controls = {...kInitial, ...changes, preset, samples, spacing};
    } else {
      this.touched.add(name);
    }
    this.show();
    return this.preview();
  }

  options() {
    return options_of(this.controls, this.touched);
  }

  command() {
    const output = by_id('name')?.value || this.live.save_name;
    return filter_line(this.live.command, this.options(), output);
  }

  show() {
    if (!this.can_filter) return;
    show_panel(this.controls, this.live, this.touched);
    by_id('command').value = this.command();
    const run = document.querySelector(`[name="after"] option[value="${kRun}"]`);
    if (run) run.disabled = !this.has_run;
    by_id('save').disabled = !this.has_run;
  }

  /// Ask for a preview of the controls as they are. \return a promise of the frame that shows them
  preview() {
    this.wanted = true;
    this.running ??= this.keep_up().finally(() => (this.running = null));
    return this.running;
  }

  async keep_up() {
    await pause(kGather);
    while (this.wanted) {
      this.wanted = false;
      const began = performance.now();
      try {
        const part = await post('preview', {options: this.options()}, true);
        await this.take(kPreview, part);
        const size = this.live.reduced ? `, ${this.live.preview_size} of ${this.live.size}` : '';
        const ms = Math.round(performance.now() - began);
        say([`Preview${size}: ${ms} ms`, ...part.warnings].join('; '));
      } catch (error) {
        if (error instanceof Cancelled) continue;
        this.fail(error);
      }
      ++this.shown;
    }
  }

  /// Show images that the server made.
  async take(after, part) {
    const {app} = this;
    app.images.replace(0, after, part.images);
    app.kept.delete(`seam errors 0 ${after}`);
    const errors = app.scene.seams?.errors?.[0];
    if (errors) errors[after + 1] = part.seam_errors ?? null;
    const map = app.scene.maps[0];
    map.numbers ??= [];
    map.numbers[after] = part.numbers ?? null;
    if (part.rows) {
      const title = after === kRun ? 'Full run' : 'Preview';
      const others = app.scene.numbers.filter((table) => table.title !== title);
      app.scene.numbers = [{title, rows: part.rows}, ...others];
    }
    show_numbers(app.scene);
    // Whoever moves a control wants to see what it does.
    await app.set({after, compare: app.state.compare === 'before' ? 'slider' : app.state.compare});
    app.show_place();
  }

  async run() {
    const {job} = await post('run', {options: this.options()}, true);
    await this.follow(job);
  }

  /// Show the progress of a run until it is over.
  async follow(number) {
    for (;;) {
      const {run} = await status();
      if (run?.number !== number) break;
      if (run.state === 'done') {
        await this.take_run();
        break;
      }
      if (run.state === 'failed') this.fail(new Error(run.message));
      if (run.state === 'cancelled') say('The full run was cancelled');
      if (!['waiting', 'running'].includes(run.state)) break;
      show_progress(run);
      await pause(kPoll);
    }
    show_progress(null);
  }

  async take_run() {
    const part = await result();
    this.has_run = true;
    await this.take(kRun, part);
    this.show();
    say(['The full run is done; it can be saved', ...part.warnings].join('; '));
  }

  async save(confirmed) {
    show_question(null);
    const name = by_id('name').value.trim();
    const overwrite = confirmed && this.asked === name;
    const answer = await post('save', {name, confirmed, overwrite}, true);
    if (answer.saved) {
      say([`Written: ${answer.saved.join(', ')}`, ...answer.warnings].join('; '));
      return;
    }
    this.asked = answer.exists.length ? name : null;
    show_question(
      answer.exists.length
        ? `There is ${answer.exists.join(', ')} already. Write over it?`
        : `Write ${answer.asks.join(', ')} into the folder that onmesh was started in?`,
    );
  }

  async copy() {
    const field = by_id('command');
    try {
      await navigator.clipboard.writeText(field.value);
      say('The command is copied');
    } catch {
      field.focus();
      field.select();
      say('Press Ctrl+C to copy the command');
    }
  }

  /// The place that is marked, or else what is in the middle of the picture.
  marked() {
    const {place, stage} = this.app;
    if (place?.on_surface) return place;
    const {width, height} = stage.box('model');
    return this.app.pick(width / 2, height / 2);
  }

  /// A click on the model.
  tap(place) {
    if (!by_id('picks').checked || !place) return;
    this.measure_from(place).catch((error) => this.fail_distances(error));
  }

  fail_distances(error) {
    by_id('distance-status').textContent = `${error.message}.`;
  }

  async measure_from(place) {
    const told = by_id('distance-status');
    if (!place?.on_surface) {
      told.textContent = 'There is no surface in the middle of the picture.';
      return;
    }
    told.textContent = 'Distances are on their way';
    try {
      const part = await post(
        'distance',
        {
          point: place.position,
          backend: by_id('backend').value,
          compare: by_id('compares').checked,
          needs_surface: !this.app.scene.fields,
        },
        true,
      );
      show_errors(part.errors);
      await this.take_layers(part);
      told.textContent = `Distances from ${place.position.map((x) => x.toPrecision(4)).join(', ')}`;
    } catch (error) {
      if (!(error instanceof Cancelled)) this.fail_distances(error);
    }
  }

  async take_layers({fields, layers}) {
    const {app} = this;
    const {scene, model} = app;
    if (fields && !scene.fields) {
      scene.fields = fields;
      model.take_fields();
    }
    const all = scene.fields.layers;
    const first_new = Math.min(all.length, kMostLayers - layers.length);
    if (first_new < all.length) {
      all.splice(0, all.length - first_new);
      model.fields.forget_layers();
    }
    all.push(...layers);
    document.getElementById('layers').hidden = false;
    fill_select('layer', all.map(({name}) => name));
    const layer = first_new;
    const step = model.fields.natural_step(layer);
    app.state.layer = -1; // whatever was there is another one now
    await app.set({colour: 'distance', layer, step});
  }

  async show_samples() {
    const {app} = this;
    try {
      const {samples} = await post('samples', {spacing: by_id('spacing').value.trim()}, true);
      app.scene.samples = samples;
      app.model.forget_samples();
      const check = document.querySelector('[name="samples"]');
      check.nextElementSibling.textContent = samples?.kind ?? 'Sample points';
      await app.set({samples: true});
      say(`${samples?.count ?? 0} samples are shown`);
    } catch (error) {
      if (!(error instanceof Cancelled)) throw error;
    }
  }
}
