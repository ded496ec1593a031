// Everything that a state needs is decoded and handed to the materials here.
import {read_block} from './blocks.js';
import {kColourings, set_uniforms} from './surface.js';

/// Textures and uniforms of one tile's material.
async function dress(material, app, tile, colour, light) {
  const {state, images, scene, cursor} = app;
  const map = scene.maps[state.map];
  const shown = {colouring: kColourings[colour] ?? kColourings.grey, light};
  shown.most_taps = app.stage.most_taps;
  shown.linear_filter = state.filtering === 'linear';
  shown.checker_texels = 2 ** state.checker_power;
  if (tile === null) {
    set_uniforms(material, {...shown, colouring: kColourings.grey});
    return;
  }
  const {width, height} = cursor.size(state.map, tile);
  shown.checker_size = [width, height];
  if (map) {
    shown.channels = map.channels?.length ?? 3;
    shown.encode = map.display?.encoding === 'linear';
    shown.exposure = app.exposed() ? 2 ** state.exposure : 1;
  }
  if (map && colour === 'texture') {
    const [before, after] = await Promise.all([
      state.compare === 'before'
        ? images.texture(state.map, 0, tile)
        : images.texture_before(state.map, state.after, tile),
      images.texture(state.map, state.after + 1, tile),
    ]);
    Object.assign(shown, {has_before: before !== null, has_after: after !== null});
    if (before) shown.before_map = before;
    if (after) shown.after_map = after;
  }
  if (map && colour === 'difference') {
    const difference = await images.difference_texture(state.map, state.after, tile);
    shown.has_difference = difference !== null;
    if (difference) shown.difference_map = difference;
    shown.difference_end = app.ends.difference ?? 1;
  }
  set_uniforms(material, shown);
}

async function load_seam_errors(app) {
  const {scene, state} = app;
  const of_map = scene.seams?.errors?.[state.map] ?? [];
  const read = (reference) => (reference ? read_block(reference) : null);
  const [before, after] = await Promise.all([read(of_map[0]), read(of_map[state.after + 1])]);
  let most = 0;
  for (const values of [before, after]) {
    for (const x of values ?? []) if (x > most && x < Infinity) most = x;
  }
  return {before, after, most};
}

async function load_seams(app) {
  const {state, model, uv_view} = app;
  const lines = await model.load_seams();
  if (uv_view) await uv_view.load_seams(state.tile);
  const errors = await app.once(`seam errors ${state.map} ${state.after}`, () =>
    load_seam_errors(app),
  );
  app.ends.seam_error = errors.most * state.seam_share;
  lines.set_values(errors.before, errors.after);
  uv_view?.set_seam_values(state.tile, errors.before, errors.after);
  for (const of of [lines, uv_view?.overlays[state.tile].seams]) {
    of?.set({by_value: state.seam_errors, value_end: app.ends.seam_error});
  }
}

/// Load and show what the app's state asks for. \return the numbers of the difference, or null
export async function load(app) {
  const {state, scene, model, uv_view, images, cursor} = app;
  app.ends = {difference: null, seam_error: null};
  let numbers = null;
  if (state.colour === 'difference') {
    numbers = await images.difference_numbers(state.map, state.after);
    app.ends.difference = (numbers?.largest_texel ?? 0) * state.difference_share;
  }
  await Promise.all(
    model.mesh.parts.map(({tile}, i) =>
      dress(model.materials[i], app, tile, state.colour, state.light),
    ),
  );
  if (uv_view && state.panes !== 'model') {
    const on_surface = state.colour === 'distance' || state.colour === 'grey';
    const colour = on_surface && scene.maps.length ? 'texture' : state.colour;
    await dress(uv_view.material, app, state.tile, colour, false);
    const {width, height} = cursor.size(state.map, state.tile);
    uv_view.set_tile_aspect(width / height);
    if (state.borders) uv_view.load_borders(state.tile);
    if (state.wireframe) uv_view.load_wireframe(state.tile);
  }
  if (state.colour === 'distance') {
    await model.fields.show(state.layer, model.group);
    model.fields.set(state.layer, state.isolines ? state.step : 0, state.light, app.stage.pixels);
  }
  if (state.seams || state.seam_errors) await load_seams(app);
  if (state.samples) await model.load_samples();
  if (state.nodes) await model.load_nodes();
  if (state.wireframe) model.load_wireframe();
  model.show(state);
  uv_view?.show(state);
  return numbers;
}
