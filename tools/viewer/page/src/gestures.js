// Connects mouse, touch, keys and buttons with the app.
import {listen} from './pointer.js';

const by_id = (id) => document.getElementById(id);

// One look-up a frame, however many events come.
function once_a_frame(run) {
  let latest = null;
  return (...values) => {
    if (latest === null) {
      requestAnimationFrame(() => {
        const now = latest;
        latest = null;
        run(...now);
      });
    }
    latest = values;
  };
}

function listen_to_model(app) {
  const {camera, stage} = app;
  const point = once_a_frame((x, y) => app.point_at(app.pick(x, y)));
  const orbit = (right, up) => {
    camera.orbit(right, up);
    app.request_draw();
  };
  listen(stage.panes.model, {
    orbit,
    key_orbit: (right, up) => orbit(-right, up),
    pan: (x, y) => {
      camera.pan(x, y);
      app.request_draw();
    },
    zoom: (factor, x, y) => {
      const at = stage.place('model', app.views(), x, y);
      camera.zoom(factor, (at.x * app.aspect('model')) / 2, at.y / 2);
      app.request_draw();
    },
    point,
    tap: (x, y) => app.live?.tap(app.pick(x, y)),
    leave: () => app.point_at(null),
    reset: () => app.reset_view(),
  });
}

function listen_to_uv(app) {
  const {uv_view, stage} = app;
  const pane = stage.panes.uv;
  const pan = (x, y) => {
    uv_view.pan(x, y, app.aspect('uv'));
    app.request_draw();
  };
  listen(pane, {
    orbit: (right, up, dx, dy) => pan(dx / pane.clientHeight, -dy / pane.clientHeight),
    key_orbit: (right, up) => pan(-0.01 * right, -0.01 * up),
    pan,
    zoom: (factor, x, y) => {
      const at = stage.place('uv', app.views(), x, y);
      const aspect = app.aspect('uv');
      uv_view.zoom(factor, (at.x * aspect) / 2, at.y / 2, aspect);
      app.request_draw();
    },
    point: once_a_frame((x, y) => app.point_at(app.pick_uv(x, y))),
    leave: () => app.point_at(null),
    reset: () => {
      uv_view.reset();
      app.request_draw();
    },
  });
}

function listen_to_divider(app) {
  const divider = by_id('divider');
  divider.addEventListener('pointerdown', (event) => divider.setPointerCapture(event.pointerId));
  divider.addEventListener('pointermove', (event) => {
    if (!divider.hasPointerCapture(event.pointerId)) return;
    const {left, width} = app.stage.panes.model.getBoundingClientRect();
    const split = Math.min(1, Math.max(0, (event.clientX - left) / width));
    app.set({split: Math.round(split * 1000) / 1000});
  });
}

// Pages that are opened from disk may not write to the clipboard; the field can be copied by hand.
async function copy_command(app) {
  const field = by_id('command');
  const told = by_id('copied');
  field.value = app.command();
  try {
    await navigator.clipboard.writeText(field.value);
    told.textContent = 'copied';
  } catch {
    field.focus();
    field.select();
    told.textContent = 'press Ctrl+C';
  }
  setTimeout(() => (told.textContent = ''), 3000);
}

export function set_up_gestures(app) {
  listen_to_model(app);
  if (app.uv_view) listen_to_uv(app);
  listen_to_divider(app);
  by_id('reset').addEventListener('click', () => app.reset_view());
  by_id('copy').addEventListener('click', () => copy_command(app));
  by_id('mark')?.addEventListener('click', () => {
    const [column, row] = ['texel-column', 'texel-row'].map((id) => Number(by_id(id).value));
    app.point_at(app.cursor.at_texel(app.state.map, app.state.tile, column, row));
  });
  new ResizeObserver(() => {
    if (!app.stage.fit()) return;
    app.fit();
    app.draw();
  }).observe(app.stage.canvas);
  window
    .matchMedia('(prefers-color-scheme: dark)')
    .addEventListener('change', () => app.refresh());
}
