// Starts the page; whatever goes wrong becomes a sentence in it.
import {make_api} from './api.js';
import {App} from './app.js';
import {Live} from './live.js';
import {set_up_controls} from './controls.js';
import {set_up_gestures} from './gestures.js';
import {PageError} from './page_error.js';
import {show_notes, show_numbers, show_readout} from './readout.js';
import {read_mesh, read_scene} from './scene.js';
import {Stage} from './stage.js';

const by_id = (id) => document.getElementById(id);

function report(error) {
  const sentence =
    error instanceof PageError ? error.message : `Something failed: ${error.message}`;
  by_id('problem').textContent = `${sentence}.`;
  by_id('problem').hidden = false;
}

function hide_picture() {
  by_id('content').hidden = true;
}

function show_header(scene) {
  by_id('title').textContent = scene.title;
  by_id('title').title = scene.title;
  by_id('program').textContent = scene.program ?? '';
  document.title = `${scene.title} – onmesh`;
  if (!scene.mesh.uvs) {
    scene.notes.unshift('The mesh has no UVs, so there is no texture to show: only its shape' +
      (scene.fields ? ' and distances' : ''));
  }
  show_notes(scene.notes);
}

function watch_context(canvas) {
  canvas.addEventListener('webglcontextlost', () =>
    report(new PageError('The graphics card has dropped the picture; reload the page to draw it')),
  );
  canvas.addEventListener('webglcontextrestored', () => (by_id('problem').hidden = true));
}

async function start() {
  let scene = null;
  try {
    scene = read_scene();
    show_header(scene);
    show_numbers(scene);
    const stage = new Stage();
    watch_context(stage.canvas);
    const app = new App(scene, await read_mesh(scene), stage, report);
    stage.canvas.addEventListener('webglcontextrestored', () => app.refresh());
    set_up_controls(scene, (changes) => app.set(changes).catch(() => {}));
    if (scene.live) app.live = new Live(app);
    app.show_theme();
    app.show_panes();
    app.fit();
    show_readout(scene, app.state, null, null, null);
    set_up_gestures(app);
    await app.refresh();
    make_api(app);
    app.live?.start().catch((error) => app.live.fail(error));
  } catch (error) {
    report(error);
    hide_picture();
    throw error;
  }
}

window.onmesh = {ready: null};
window.onmesh.ready = start();
// The page says it; whoever awaits `ready` gets the error, too.
window.onmesh.ready.catch(() => {});
