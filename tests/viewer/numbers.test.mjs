// Heat maps and distances against the program's own numbers.
import assert from 'node:assert';
import {after, before, test} from 'node:test';
import {statSync} from 'node:fs';
import {launch, open, open_file, set, state, strip} from './browser.mjs';
import * as fixture from './fixture.mjs';
import {make_page, no_pages, onmesh, read_ply_vertices} from './program.mjs';

let browser;
before(async () => {
  browser = await launch();
});
after(() => browser.close());

const near = (a, b, share) =>
  assert.ok(Math.abs(a - b) <= share * Math.abs(b), `${a} instead of ${b}`);

test('numbers of the difference are those of onmesh compare', {skip: no_pages()}, async () => {
  const path = make_page('heat.html', 'cube.obj', '-t', 'cube.png', '--after', 'noisy.png');
  assert.ok(statSync(path).size < 8 * 2 ** 20);
  const page = await open_file(browser, path);
  const {psnr, rms, max} = JSON.parse(onmesh('compare', 'cube.png', 'noisy.png', '--json'));
  await set(page, {colour: 'difference'});
  const found = await page.evaluate(() => window.onmesh.difference());
  near(found.rms, rms, 1e-6);
  near(found.max, max, 1e-6);
  near(found.psnr_db, psnr, 1e-6);
  const table = await page.$eval('#difference-numbers', (box) => box.innerText);
  assert.ok(table.includes(String(Number(psnr.toPrecision(6)))), table);
  await page.close();
});

test('the heat map shows the difference of each texel in the colours of its legend', async () => {
  const blocks = new fixture.Blocks();
  const scene = fixture.bare_scene(fixture.grid(1, 1, fixture.plane), blocks);
  const image = (codes) => blocks.image(fixture.picture(8, 1, 4, codes), 8, 1, 4);
  scene.afters = [{name: 'a'}];
  // Alpha differs everywhere and must not count; the rest differs by the column.
  const [before_image, after_image] = [image(() => [0, 0, 0, 0]), image((x) => [x, x, x, 255])];
  const channels = ['R', 'G', 'B', 'A'];
  scene.maps = [fixture.map_of('steps', before_image, [after_image], {channels})];
  const page = await open(browser, 'heat.html', fixture.page(scene, blocks));
  await set(page, {colour: 'difference', compare: 'after', light: false, panes: 'uv'});
  const {ends} = await state(page);
  near(ends.difference, 7 / 255, 1e-6);
  const first = await strip(page, 'uv', 0.1, 0.105, 0.5);
  const last = await strip(page, 'uv', 0.92, 0.925, 0.5);
  // The ends of the colour map: dark violet and light yellow.
  assert.ok(first[0] < 80 && first[2] > first[1], String(first.slice(0, 3)));
  assert.ok(last[0] > 220 && last[1] > 220 && last[2] < 160, String(last.slice(0, 3)));
  await set(page, {difference_share: 0.1});
  const early = await strip(page, 'uv', 0.4, 0.405, 0.5);
  assert.deepStrictEqual(early.slice(0, 3), last.slice(0, 3));
  await page.close();
});

test('equal images have an infinite PSNR and no colour but the first', async () => {
  const blocks = new fixture.Blocks();
  const scene = fixture.bare_scene(fixture.grid(1, 1, fixture.plane), blocks);
  const image = blocks.image(fixture.picture(4, 4, 3, (x, y) => [x, y, 3]), 4, 4, 3);
  scene.afters = [{name: 'same'}];
  scene.maps = [fixture.map_of('same', image, [image])];
  const page = await open(browser, 'same.html', fixture.page(scene, blocks));
  await set(page, {colour: 'difference'});
  const found = await page.evaluate(() => window.onmesh.difference().then(({rms}) => rms));
  assert.strictEqual(found, 0);
  assert.match(await page.$eval('#difference-numbers', (box) => box.innerText), /infinite/);
  assert.deepStrictEqual(page.errors, []);
  await page.close();
});

test('distances are those of onmesh distance', {skip: no_pages()}, async () => {
  onmesh('make-mesh', 'sphere', '-o', 'sphere.obj', '-t', 'sphere.png', '--size', '128');
  const words = ['sphere.obj', '-t', 'sphere.png', '--distances', 'vertex:12'];
  const page = await open_file(browser, make_page('distances.html', ...words));
  assert.deepStrictEqual(page.errors, []);
  onmesh('distance', 'sphere.obj', '--vertex', '12', '-o', 'distances.ply');
  const vertices = read_ply_vertices('distances.ply').filter((_, i) => i % 40 === 0);
  for (const [x, y, z, distance] of vertices) {
    const found = await page.evaluate((p) => window.onmesh.distance_at(0, p), [x, y, z]);
    assert.ok(Math.abs(found - distance) < 2e-3, `${found} instead of ${distance}`);
  }
  await page.close();
});

test('isolines lie where the distance is a multiple of the step', async () => {
  const blocks = new fixture.Blocks();
  const scene = fixture.bare_scene(fixture.grid(8, 8, fixture.plane), blocks);
  const camera = {azimuth: 0, elevation: 0, target: [0.5, 0.5, 0], extent: 1};
  Object.assign(scene.camera, camera);
  const mesh = fixture.grid(16, 16, fixture.plane);
  const values = new Float32Array(17 * 17).map((_, i) => mesh.positions[3 * i]);
  const layer = {name: 'x', min: 0, max: 1, unit: 'm', source: [0, 0, 0], step: 0.25};
  scene.fields = {
    ...Object.fromEntries(
      ['positions', 'normals', 'indices'].map((name) => [name, blocks.add(mesh[name])]),
    ),
    vertices: 289,
    triangles: 512,
    layers: [{...layer, values: blocks.add(values)}],
  };
  const page = await open(browser, 'lines.html', fixture.page(scene, blocks));
  await set(page, {colour: 'distance', light: false, panes: 'model'});
  const row = await page.evaluate(() => {
    const {offsetWidth: width, offsetHeight: height} = document.getElementById('model-pane');
    const left = (width - height) / 2;
    return window.onmesh.pixels('model', left, height / 2, height, 1);
  });
  const pixels = row.length / 4;
  const dark = [];
  for (let i = 6; i + 1 < pixels; ++i) {
    const light = (k) => row[4 * k] + row[4 * k + 1] + row[4 * k + 2];
    const sunk = light(i) < light(i - 1) && light(i) <= light(i + 1);
    if (sunk && light(i) < 0.6 * light(i - 6)) dark.push((i + 0.5) / pixels);
  }
  assert.strictEqual(dark.length, 3, String(dark));
  dark.forEach((x, k) => assert.ok(Math.abs(x - 0.25 * (k + 1)) < 2 / pixels, String(dark)));
  const legend = await page.$eval('#legends', (box) => box.innerText);
  assert.match(legend, /X\s+m\s+0\s+0\.5\s+1/);
  await page.close();
});

test('what is not reached has no distance', async () => {
  const blocks = new fixture.Blocks();
  const page = await open(browser, 'full.html', fixture.page(fixture.full_scene(blocks), blocks));
  const far = await page.evaluate(() => window.onmesh.distance_at(1, [-1.4, 0, 0]));
  assert.ok(Number.isNaN(far));
  await page.close();
});
