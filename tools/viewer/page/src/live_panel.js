// The part of the form that tries the filter: its elements and what they say.
import {brief} from './format.js';
import {short} from './live_options.js';

const by_id = (id) => document.getElementById(id);
const part = (name) => by_id(`live-${name}`);

// Sliders of widths move by powers of two.
const kPowers = new Set(['spatial', 'range', 'normal_width', 'radius']);

function read(name, element) {
  if (element.type === 'checkbox') return element.checked;
  if (element.type !== 'range') return element.value.trim();
  const value = Number(element.value);
  return kPowers.has(name) ? Number(short(2 ** value)) : value;
}

function write(name, element, value) {
  if (element.type === 'checkbox') element.checked = value;
  else if (kPowers.has(name)) element.value = Math.log2(value);
  else element.value = value;
}

/// Ready the elements. \param changed called with a control's name and its value
export function set_up_panel({presets}, changed) {
  const select = part('preset');
  for (const {name, purpose} of presets) select?.append(new Option(`${name}: ${purpose}`, name));
  for (const element of document.querySelectorAll('[data-live]')) {
    const name = element.dataset.live;
    element.addEventListener('input', () => changed(name, read(name, element)));
  }
}

/// \param live what the scene says of the surface
export function show_panel(controls, live, touched) {
  for (const element of document.querySelectorAll('[data-live]')) {
    const name = element.dataset.live;
    if (element !== document.activeElement || element.type !== 'text')
      write(name, element, controls[name]);
  }
  const tell = (name, text) => {
    if (part(`${name}-text`)) part(`${name}-text`).textContent = text;
  };
  const length = (texels) => `${short(texels)} texels = ${brief(texels * live.texel_size)}`;
  tell('spatial', length(controls.spatial));
  tell('radius', controls.own_radius ? length(controls.radius) : 'by the width');
  const ranges = ['range', 'range_of_noise', 'blur', 'normals', 'normal_width'];
  const of_preset = controls.preset && !ranges.some((name) => touched.has(name));
  const range = short(controls.range) + (controls.range_of_noise ? ' × noise' : '');
  tell('range', of_preset ? 'as the preset has it' : range);
  tell('blur', controls.blur > 0 ? `${short(controls.blur)} texels` : 'not blurred');
  tell('normal_width', short(controls.normal_width));
  tell('strength', `${Math.round(100 * controls.strength)} %`);
  const bilateral = controls.kind === 'bilateral';
  const used = {
    range: bilateral,
    range_of_noise: bilateral,
    blur: bilateral,
    normals: bilateral,
    normal_width: bilateral && controls.normals,
    radius: controls.own_radius,
    spacing: controls.samples === 'poisson',
  };
  for (const [name, use] of Object.entries(used)) {
    const element = document.querySelector(`[data-live="${name}"]`);
    if (element) element.disabled = !use && element !== document.activeElement;
  }
}

/// One line on how the preview, or the run, is doing.
export function say(text, problem = false) {
  const line = part('status');
  if (!line) return;
  line.textContent = text;
  line.classList.toggle('problem', problem);
}

/// \param job of the server, or null when none runs
export function show_progress(job) {
  part('run').disabled = job !== null;
  part('cancel').disabled = job === null;
  const bar = part('progress');
  bar.value = job?.fraction ?? 0;
  part('stage').textContent = job ? job.stage : '';
}

export function show_errors(errors) {
  const table = part('errors');
  table.hidden = !errors;
  if (!errors) return;
  const body = table.tBodies[0];
  body.replaceChildren();
  const back_ends = Object.entries(errors).sort(([a], [b]) => (a < b ? -1 : 1));
  for (const [name, error] of back_ends) {
    const row = body.insertRow();
    const head = document.createElement('th');
    head.scope = 'row';
    head.textContent = name;
    row.append(head);
    if (error.skipped) {
      const cell = row.insertCell();
      cell.colSpan = 4;
      cell.textContent = error.skipped;
      continue;
    }
    for (const value of [error.mean, error.p99, error.max]) row.insertCell().textContent = brief(value);
    const seconds = error.seconds ?? 0;
    row.insertCell().textContent = `${Math.round(1000 * seconds)} ms`;
  }
}

/// Ask before something is written. \param question null: nothing is asked
export function show_question(question) {
  const box = part('question');
  const had_focus = box.contains(document.activeElement);
  box.hidden = question === null;
  part('question-text').textContent = question ?? '';
  if (question !== null) part('yes').focus();
  else if (had_focus) part('save').focus();
}
