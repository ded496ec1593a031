// The tables of the panel and below it, notes and legends.
import {colour_map_gradient} from './colour_maps.js';
import {brief, grouped, plain} from './format.js';

const by_id = (id) => document.getElementById(id);

function element(tag, text, name) {
  const made = document.createElement(tag);
  if (text !== undefined) made.textContent = text;
  if (name) made.className = name;
  return made;
}

function fill_table(body, rows) {
  rows.forEach(([name, value], i) => {
    let row = body.rows[i];
    if (!row) {
      row = body.insertRow();
      const head = element('th');
      head.scope = 'row';
      row.append(head, element('td'));
    }
    row.cells[0].textContent = name;
    row.cells[0].title = name;
    row.cells[1].textContent = value;
    row.cells[1].title = value;
  });
  while (body.rows.length > rows.length) body.deleteRow(-1);
}

const list = (values) => values.map(plain).join('  ');

/// What is under the pointer; the same rows whatever it is, so that nothing jumps.
export function show_readout(scene, state, place, values, distance) {
  const rows = [];
  const found = (value) => (place && value !== undefined && value !== null ? value : null);
  if (scene.tiles.length > 1) rows.push(['Tile', scene.tiles[found(place?.tile)]?.name ?? '–']);
  if (scene.mesh.uvs) {
    const texel = found(place?.column) === null ? null : place;
    rows.push(['Texel', texel ? `column ${texel.column}, row ${texel.row}` : '–']);
    rows.push(['of', texel ? size_text(texel) : '–']);
  }
  rows.push(['Position', place?.on_surface ? list(place.position) : '–']);
  rows.push(['Triangle', found(place?.triangle) === null ? '–' : grouped(place.triangle)]);
  const weights = place?.on_surface && place.weights.map((w) => w.toFixed(4)).join('  ');
  rows.push(['Barycentric', weights || '–']);
  const map = scene.maps[state.map];
  if (map) {
    const names = ['before', ...scene.afters.map(({name}) => name)];
    const unit = values?.unit ?? '';
    names.forEach((name, i) => {
      const value = values?.states[i];
      rows.push([name, value ? list(value) + unit : '–']);
    });
  }
  if (scene.fields) {
    const {unit} = scene.fields.layers[state.layer];
    const text = Number.isNaN(distance) ? 'not reached' : `${plain(distance)} ${unit}`;
    rows.push(['Distance', distance === null ? '–' : text]);
  }
  fill_table(by_id('readout').tBodies[0], rows);
}

function size_text({width, height, shown}) {
  if (!shown) return `${width} × ${height} (no texture)`;
  const full = `${width} × ${height}`;
  return shown === full ? full : `${full}, shown at ${shown}`;
}

export function show_difference_numbers(numbers) {
  const table = by_id('difference-numbers');
  if (!table) return; // nothing to compare
  const text = (of) => (numbers ? plain(of) : '–');
  fill_table(table.tBodies[0], [
    ['Largest', text(numbers?.max)],
    ['Root mean square', text(numbers?.rms)],
    ['PSNR', numbers ? `${plain(numbers.psnr_db)} dB` : '–'],
  ]);
}

export function show_notes(notes) {
  const box = by_id('notes');
  box.replaceChildren(...notes.map((note) => element('li', note)));
  box.hidden = notes.length === 0;
}

/// \param legends [{title, low, high, unit}]
export function show_legends(legends) {
  const made = legends.map(({title, low, high, unit}) => {
    const legend = element('div', undefined, 'legend');
    const bar = element('div', undefined, 'bar');
    bar.style.backgroundImage = colour_map_gradient();
    const ends = element('div', undefined, 'ends');
    const middle = (low + high) / 2;
    ends.append(...[low, middle, high].map((x) => element('span', brief(x))));
    legend.append(element('div', title, 'title'), element('div', unit, 'unit'), bar, ends);
    return legend;
  });
  by_id('legends').replaceChildren(...made);
}

const number_names = {
  psnr_db: 'PSNR, dB',
  rms: 'root mean square of the difference',
  max: 'largest difference',
  seam_rms_before: 'seam error before',
  seam_rms_after: 'seam error after',
};

function map_tables(scene) {
  const tables = [];
  for (const map of scene.maps) {
    const {range, space, channels} = map;
    const rows = [
      ['colour space', String(space ?? '–')],
      ['channels', (channels ?? []).join(' ')],
    ];
    if (range) rows.push(['values', `${plain(range[0])} to ${plain(range[1])}`]);
    tables.push({title: `Map ${map.name}`, rows});
    (map.numbers ?? []).forEach((numbers, i) => {
      if (!numbers) return;
      const found = Object.entries(numbers).map(([key, value]) => [
        number_names[key] ?? key,
        typeof value === 'number' || value === null ? plain(value) : String(value),
      ]);
      tables.push({title: `${map.name}: before and ${scene.afters[i]?.name}`, rows: found});
    });
  }
  return tables;
}

function mesh_table({mesh}) {
  const rows = [
    ['vertices', grouped(mesh.file_vertices ?? mesh.vertices)],
    ['triangles', grouped(mesh.file_triangles ?? mesh.triangles)],
  ];
  if (mesh.diagonal) rows.push(['diagonal', `${plain(mesh.diagonal)} ${mesh.unit ?? ''}`]);
  return {title: `Mesh ${mesh.name ?? ''}`, rows};
}

/// The numbers of the run, of the maps and of the mesh.
export function show_numbers(scene) {
  const tables = [...scene.numbers, ...map_tables(scene), mesh_table(scene)];
  by_id('numbers').replaceChildren(
    ...tables.map(({title, rows}) => {
      const box = element('div');
      const table = element('table');
      fill_table(table.createTBody(), rows ?? []);
      box.append(element('h2', title), table);
      return box;
    }),
  );
}
