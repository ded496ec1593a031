// window.onmesh: the page as seen by tests and by the browser's console.

export function make_api(app) {
  const with_details = async (place) => place && {...place, ...(await app.details(place))};
  Object.assign(window.onmesh, {
    state: () => ({
      ...app.state,
      azimuth: app.camera.azimuth,
      elevation: app.camera.elevation,
      target: [...app.camera.target],
      extent: app.camera.extent,
      ends: {...app.ends},
      flicker_after: app.flicker_after,
      place: app.place,
    }),
    set: async (changes) => {
      const {azimuth, elevation, target, extent} = changes;
      const view = {azimuth, elevation, target, extent};
      for (const [name, value] of Object.entries(view)) {
        if (value === undefined) continue;
        app.camera[name] = value;
        app.camera.moved = true;
      }
      await app.set(changes);
    },
    pick: (x, y) => with_details(app.pick(x, y)),
    pick_uv: (x, y) => with_details(app.uv_view ? app.pick_uv(x, y) : null),
    texel: (tile, column, row) =>
      with_details(app.cursor.at_texel(app.state.map, tile, column, row)),
    mark: (tile, column, row) =>
      app.point_at(app.cursor.at_texel(app.state.map, tile, column, row)),
    project: (position) => app.camera.project(position, app.aspect('model')),
    difference: (map = app.state.map, after = app.state.after) =>
      app.images.difference_numbers(map, after),
    distance_at: (layer, position) => app.model.fields.value_at(layer, position),
    command: () => app.command(),
    pixels: (pane, x, y, width, height) => {
      app.draw();
      return app.stage.pixels_of(pane, x, y, width, height);
    },
    finished: () => {
      app.draw(); // a frame that was shown already is gone from the buffer that is read
      app.stage.finish();
      return performance.now();
    },
    // Only where a program serves the page.
    live: app.live && {
      change: (name, value) => app.live.change(name, value),
      // Waits for the graphics card to draw what is under way, without drawing it again.
      settled: () => {
        app.stage.finish();
        return performance.now();
      },
      preview: () => app.live.preview(),
      options: () => app.live.options(),
      measure_from: (position) => app.live.measure_from({position, on_surface: true}),
      layers: () => app.scene.fields?.layers.map(({name}) => name) ?? [],
      codes: async (state, tile = 0) => {
        const image = await app.images.decoded(0, state, tile);
        return image && {...image, codes: Array.from(image.codes)};
      },
      codes_reduced: async (tile = 0) => {
        const image = await app.images.decode(app.images.source_before(0, 0, tile));
        return {width: image.width, height: image.height, codes: Array.from(image.codes)};
      },
    },
    lose_context: () => app.stage.renderer.forceContextLoss(),
  });
}
