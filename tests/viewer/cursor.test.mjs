// The linked cursor: what the page says of a texel and of a place on the model.
import assert from 'node:assert';
import {after, before, test} from 'node:test';
import {launch, open, open_file, set, state} from './browser.mjs';
import * as fixture from './fixture.mjs';
import {make_page, no_pages, onmesh, place_of_texel, read_obj} from './program.mjs';

let browser;
before(async () => {
  browser = await launch();
});
after(() => browser.close());

const texel = (page, tile, column, row) =>
  page.evaluate((...of) => window.onmesh.texel(...of), tile, column, row);

function close(a, b, error) {
  a.forEach((x, k) => assert.ok(Math.abs(x - b[k]) <= error, `${a} instead of ${b}`));
}

async function agrees(page, triangles, {width, height}, step) {
  let covered = 0;
  for (let row = 0; row < height; row += step) {
    for (let column = 0; column < width; column += step) {
      const found = await texel(page, 0, column, row);
      const truth = place_of_texel(triangles, column, row, width, height);
      assert.strictEqual(found.on_surface, truth !== null, `texel ${column}, ${row}`);
      if (!truth) continue;
      ++covered;
      assert.strictEqual(found.triangle, truth.triangle, `texel ${column}, ${row}`);
      close(found.position, truth.position, 2e-6);
      close(found.weights, truth.weights, 2e-5);
    }
  }
  return covered;
}

test('texels of the program\'s page lie where its mesh puts them', {skip: no_pages()}, async () => {
  const path = make_page('cursor.html', 'cube.obj', '-t', 'cube.png', '--after', 'noisy.png');
  const page = await open_file(browser, path);
  assert.deepStrictEqual(page.errors, []);
  const covered = await agrees(page, read_obj('cube.obj'), {width: 128, height: 128}, 5);
  assert.ok(covered > 150, `${covered} texels`);
  await page.close();
});

test('the page covers as many texels as onmesh map says', {skip: no_pages()}, async () => {
  const path = make_page('cursor.html', 'cube.obj', '-t', 'cube.png');
  const page = await open_file(browser, path);
  const words = ['cube.obj', '--resolution', '128x128', '-o', 'map.exr', '--json'];
  const report = JSON.parse(onmesh('map', ...words));
  const covered = await page.evaluate(async () => {
    let count = 0;
    for (let row = 0; row < 128; ++row) {
      for (let column = 0; column < 128; ++column)
        count += (await window.onmesh.texel(0, column, row)).on_surface;
    }
    return count;
  });
  assert.strictEqual(covered, report.covered ?? report.texels_covered);
  await page.close();
});

test('values are the codes of the images, a row from the top each', async () => {
  const blocks = new fixture.Blocks();
  const scene = fixture.bare_scene(fixture.grid(3, 3, fixture.plane), blocks);
  const image = (third, width, fields) =>
    blocks.image(
      fixture.picture(width, 8, 3, (x, y) => [x, y, third]),
      width,
      8,
      3,
      fields,
    );
  scene.afters = [{name: 'one'}, {name: 'half the width'}];
  const scaled = image(9, 8, {full_width: 16});
  scene.maps = [fixture.map_of('codes', image(5, 16), [image(7, 16), scaled])];
  const page = await open(browser, 'codes.html', fixture.page(scene, blocks));
  const found = await texel(page, 0, 11, 2);
  assert.deepStrictEqual(found.values.states, [[11, 2, 5], [11, 2, 7], [5, 2, 9]]);
  close(found.position, [11.5 / 16, 1 - 2.5 / 8, 0], 1e-6);
  assert.strictEqual(await texel(page, 0, 16, 0), null);
  await page.close();
});

test('half floats and what is no number are read as they are', async () => {
  const blocks = new fixture.Blocks();
  const scene = fixture.bare_scene(fixture.grid(1, 1, fixture.plane), blocks);
  const numbers = [0, 1, -2.5, 1000, 2 ** -20, 0.333251953125];
  const codes = Uint16Array.from([...numbers, NaN, Infinity], fixture.half_code);
  const image = blocks.image(codes, 8, 1, 1, {type: 'f16'});
  const fields = {hdr: true, channels: ['Y'], display: {encoding: 'linear'}};
  scene.maps = [fixture.map_of('light', image, [], fields)];
  const page = await open(browser, 'half.html', fixture.page(scene, blocks));
  for (const [column, number] of numbers.entries()) {
    assert.deepStrictEqual((await texel(page, 0, column, 0)).values.states, [[number]]);
  }
  Object.assign(scene.camera, {azimuth: 0, elevation: 0});
  await set(page, {light: false, filtering: 'nearest', panes: 'both'});
  const colour = async (u) => {
    const at = await page.evaluate((x) => {
      const {height, width} = document.getElementById('uv-pane').getBoundingClientRect();
      const left = (width - width / 1.08) / 2;
      return window.onmesh.pixels('uv', left + (x * width) / 1.08, height / 2, 1, 1);
    }, u);
    return at.slice(0, 3);
  };
  assert.deepStrictEqual(await colour(6.5 / 8), [255, 0, 255]);
  assert.deepStrictEqual(await colour(7.5 / 8), [255, 0, 255]);
  assert.deepStrictEqual(await colour(0.5 / 8), [0, 0, 0]);
  const grey = Math.round(255 * (1.055 * numbers[5] ** (1 / 2.4) - 0.055));
  assert.ok(Math.abs((await colour(5.5 / 8))[0] - grey) <= 1);
  await page.close();
});

test('a place on the model and its texel lead to each other', async () => {
  const blocks = new fixture.Blocks();
  const page = await open(browser, 'full.html', fixture.page(fixture.full_scene(blocks), blocks));
  for (const [x, y] of [[150, 300], [250, 450], [330, 330], [420, 380]]) {
    const on_model = await page.evaluate((...at) => window.onmesh.pick(...at), x, y);
    const {tile, column, row} = on_model;
    const in_texture = await texel(page, tile, column, row);
    // Half a texel's diagonal apart at most: 256 texels run once around the torus.
    const apart = Math.hypot(...on_model.position.map((p, k) => p - in_texture.position[k]));
    assert.ok(apart < (2 * Math.PI * 1.4) / 256, `${apart} apart`);
    const seen = await page.evaluate((p) => window.onmesh.project(p), on_model.position);
    const box = await (await page.$('#model-pane')).boundingBox();
    close([((seen.x + 1) / 2) * box.width, ((1 - seen.y) / 2) * box.height], [x, y], 0.01);
  }
  await page.close();
});

test('pointing in one pane marks the place in the other', async () => {
  const blocks = new fixture.Blocks();
  const page = await open(browser, 'full.html', fixture.page(fixture.full_scene(blocks), blocks));
  const boxes = {};
  for (const pane of ['model', 'uv']) {
    boxes[pane] = await (await page.$(`#${pane}-pane`)).boundingBox();
  }
  const marker = (pane) =>
    page.$eval(`#${pane}-pane .marker`, (m) => {
      const {left, top, width, height} = m.getBoundingClientRect();
      return m.hidden ? null : [left + width / 2, top + height / 2];
    });
  const marked = (pane) =>
    page.waitForFunction(
      (name) => !document.querySelector(`#${name}-pane .marker`).hidden,
      {timeout: 10000},
      pane,
    );
  const at = [boxes.model.x + 200, boxes.model.y + 380];
  await page.mouse.move(...at);
  await marked('model');
  await marked('uv');
  close(await marker('model'), at, 1);
  const in_uv = await marker('uv');
  assert.ok(in_uv);
  const {place} = await state(page);
  await page.mouse.move(...in_uv);
  await page.waitForFunction(
    (before) => (window.onmesh.state().place?.position[0] ?? before) !== before,
    {timeout: 10000},
    place.position[0],
  );
  await marked('model');
  const again = (await state(page)).place;
  for (const name of ['tile', 'column', 'row']) assert.strictEqual(again[name], place[name]);
  close(await marker('model'), at, 4);
  await page.waitForFunction(
    (text) => document.getElementById('readout').innerText.includes(text),
    {timeout: 10000},
    `column ${place.column}, row ${place.row}`,
  );
  await page.mouse.move(boxes.model.x + 5, boxes.model.y + 5);
  await page.waitForFunction(() => window.onmesh.state().place === null, {timeout: 10000});
  assert.strictEqual(await marker('uv'), null);
  await page.close();
});

test('repeated and mirrored UVs find their texel', async () => {
  for (const [mode, column] of [['repeat', 2], ['mirror', 7], ['clamp', 9]]) {
    const blocks = new fixture.Blocks();
    const mesh = fixture.grid(1, 1, fixture.plane);
    mesh.uvs = mesh.uvs.map((x, i) => (i % 2 === 0 ? x + 1 : x));
    const scene = fixture.bare_scene(mesh, blocks);
    scene.mesh.wrap = [mode, mode];
    Object.assign(scene.camera, {azimuth: 0, elevation: 0, target: [0.25, 0.5, 0], extent: 2});
    const image = blocks.image(fixture.picture(10, 10, 3, (x) => [x, x, x]), 10, 10, 3);
    scene.maps = [fixture.map_of('columns', image, [])];
    const page = await open(browser, 'wrap.html', fixture.page(scene, blocks));
    const place = await page.evaluate(() => {
      const {offsetWidth, offsetHeight} = document.getElementById('model-pane');
      return window.onmesh.pick(offsetWidth / 2, offsetHeight / 2);
    });
    assert.strictEqual(place.column, column, mode);
    if (mode !== 'clamp') {
      const back = await texel(page, 0, place.column, place.row);
      close(back.position, place.position, 0.08);
    }
    await page.close();
  }
});
