// The form of controls: each element named after a part of the state follows it and sets it.
import {brief} from './format.js';

const form = () => document.getElementById('controls');

export function fill_select(name, labels) {
  const select = form().elements[name];
  select.replaceChildren(...labels.map((label, i) => new Option(label, i)));
}

/// Whatever the scene has nothing for is left out of the page once and for all.
function leave_out(scene) {
  const has = {
    uvs: scene.mesh.uvs,
    maps: scene.maps.length > 0,
    tiles: scene.tiles.length > 1,
    afters: scene.afters.length > 0 && scene.maps.length > 0,
    exposure: scene.maps.some((map) => map.hdr || map.display?.encoding === 'linear'),
    seams: scene.seams,
    'seam-errors': scene.seams?.errors?.some((map) => map?.some((errors) => errors)),
    samples: scene.samples || scene.live,
    nodes: scene.nodes,
    fields: scene.fields || scene.live,
    live: scene.live,
    filter: scene.live && scene.maps.length > 0,
  };
  for (const [need, met] of Object.entries(has)) {
    if (met) continue;
    for (const element of form().querySelectorAll(`.needs-${need}`)) element.remove();
  }
  const colours = form().elements.colour;
  const needs = {texture: has.maps, difference: has.afters, checker: has.uvs, distance: has.fields};
  for (const option of [...colours.options]) {
    if (option.value in needs && !needs[option.value]) option.remove();
  }
}

function value_of(element) {
  if (element.type === 'checkbox') return element.checked;
  const number = element.type === 'number' || element.type === 'range';
  return number || 'number' in element.dataset ? Number(element.value) : element.value;
}

/// Ready the form. \param set called with the part of the state that somebody has changed
export function set_up_controls(scene, set) {
  leave_out(scene);
  if (scene.maps.length) fill_select('map', scene.maps.map(({name}) => name));
  if (scene.tiles.length > 1) fill_select('tile', scene.tiles.map(({name}) => name));
  if (form().elements.after) fill_select('after', scene.afters.map(({name}) => name));
  if (scene.fields) fill_select('layer', scene.fields.layers.map(({name}) => name));
  const label = (name, text) => {
    const element = form().elements[name];
    if (element) element.nextElementSibling.textContent = text;
  };
  label('samples', scene.samples?.kind ?? 'Sample points');
  label('nodes', `Node mesh${scene.nodes ? `, ${scene.nodes.count} nodes` : ''}`);
  form().addEventListener('submit', (event) => event.preventDefault());
  form().addEventListener('input', ({target}) => {
    if (!target.name || (target.type === 'number' && target.value === '')) return;
    set({[target.name]: value_of(target)});
  });
}

const texts = {
  exposure: ({exposure}) => `${exposure > 0 ? '+' : ''}${exposure} stops`,
  checker: ({checker_power}) => `${2 ** checker_power} texels`,
  split: ({split}) => `${Math.round(100 * split)} %`,
  flicker_speed: ({flicker_speed}) => String(flicker_speed),
};

/// Let the form show the state. \param ends of the colour scales: {difference, seam_error}
export function show_controls(state, ends, exposed) {
  const {elements} = form();
  for (const element of elements) {
    if (!(element.name in state)) continue;
    const value = state[element.name];
    if (element.type === 'checkbox') element.checked = value;
    else if (element.type === 'radio') element.checked = element.value === value;
    else if (element !== document.activeElement || element.type !== 'number')
      element.value = value;
  }
  const write = (name, text) => {
    const place = form().querySelector(`[data-shows="${name}"]`);
    if (place) place.textContent = text;
  };
  for (const [name, text] of Object.entries(texts)) write(name, text(state));
  const end = (share, x) => `${Math.round(100 * share)} %${x === null ? '' : ` = ${brief(x)}`}`;
  write('difference', end(state.difference_share, ends.difference));
  write('seam_error', end(state.seam_share, ends.seam_error));
  // What has no effect now stays in its place, but cannot be used.
  const used = {
    split: state.compare === 'slider',
    flicker_runs: state.compare === 'flicker',
    flicker_speed: state.compare === 'flicker',
    exposure: exposed,
    checker_power: state.colour === 'checker',
    filtering: state.colour === 'texture',
    difference_share: state.colour === 'difference',
    seam_share: state.seam_errors,
    isolines: state.colour === 'distance',
    step: state.colour === 'distance' && state.isolines,
  };
  for (const [name, use] of Object.entries(used)) {
    const input = form().querySelector(`:is(input, select)[name="${name}"]`);
    if (!input) continue;
    // Browsers drop all keys while the focus is on something disabled.
    if (!use && input === document.activeElement) input.blur();
    input.disabled = !use;
  }
}
