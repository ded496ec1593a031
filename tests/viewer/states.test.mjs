// Before and after: slider, side by side, flicker.
import assert from 'node:assert';
import {after, before, test} from 'node:test';
import {launch, open, set, state, strip} from './browser.mjs';
import * as fixture from './fixture.mjs';

const red = [200, 0, 0];
const blue = [0, 0, 200];
let browser, page;

before(async () => {
  browser = await launch();
  const blocks = new fixture.Blocks();
  const scene = fixture.bare_scene(fixture.grid(4, 4, fixture.plane), blocks);
  Object.assign(scene.camera, {azimuth: 0, elevation: 0});
  const image = (code) => blocks.image(fixture.picture(16, 16, 3, () => code), 16, 16, 3);
  scene.afters = [{name: 'blue'}, {name: 'green'}];
  scene.maps = [fixture.map_of('plain', image(red), [image(blue), image([0, 200, 0])])];
  page = await open(browser, 'plain.html', fixture.page(scene, blocks));
  await set(page, {light: false});
});
after(() => browser.close());

async function colours(x, pane = 'model') {
  return (await strip(page, pane, x, x + 0.01, 0.5)).slice(0, 3);
}

test('the slider changes pixels on one side only', async () => {
  for (const pane of ['model', 'uv']) {
    await set(page, {compare: 'slider', split: 0.5});
    assert.deepStrictEqual(await colours(0.4, pane), red);
    assert.deepStrictEqual(await colours(0.6, pane), blue);
    const left = await strip(page, pane, 0, 0.3, 0.5);
    await set(page, {split: 0.3});
    const same = await strip(page, pane, 0, 0.29, 0.5);
    assert.deepStrictEqual(same, left.slice(0, same.length));
    assert.deepStrictEqual(await colours(0.4, pane), blue);
  }
});

test('the divider drags the slider', async () => {
  await set(page, {compare: 'slider', split: 0.5});
  const box = await (await page.$('#divider')).boundingBox();
  const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x + 100, y, {steps: 4});
  await page.mouse.up();
  const {split, azimuth} = await state(page);
  assert.ok(split > 0.6, String(split));
  assert.strictEqual(azimuth, 0, 'the model must not turn');
});

test('before, after and another after are shown alone', async () => {
  await set(page, {compare: 'before'});
  assert.deepStrictEqual(await colours(0.6), red);
  await set(page, {compare: 'after'});
  assert.deepStrictEqual(await colours(0.4), blue);
  await set(page, {after: 1});
  assert.deepStrictEqual(await colours(0.4), [0, 200, 0]);
  await set(page, {after: 0});
});

test('side by side shows both with the same camera', async () => {
  await set(page, {compare: 'side'});
  assert.deepStrictEqual(await colours(0.25), red);
  assert.deepStrictEqual(await colours(0.75), blue);
  const count = (row, code) => {
    let n = 0;
    for (let i = 0; i < row.length; i += 4) n += code.every((c, k) => row[i + k] === c);
    return n;
  };
  const left = count(await strip(page, 'model', 0, 0.5, 0.5), red);
  const right = count(await strip(page, 'model', 0.5, 1, 0.5), blue);
  assert.ok(left > 50 && Math.abs(left - right) <= 2, `${left} and ${right} pixels`);
});

test('flicker alternates, and stops when asked', async () => {
  await set(page, {compare: 'flicker', flicker_speed: 3, flicker_runs: true});
  const seen = new Set();
  for (let i = 0; i < 30 && seen.size < 2; ++i) {
    seen.add(String(await colours(0.5)));
    await new Promise((resolve) => setTimeout(resolve, 60));
  }
  assert.deepStrictEqual([...seen].sort(), [String(blue), String(red)].sort());
  await set(page, {flicker_runs: false});
  const first = String(await colours(0.5));
  for (let i = 0; i < 10; ++i) {
    await new Promise((resolve) => setTimeout(resolve, 80));
    assert.strictEqual(String(await colours(0.5)), first);
  }
});

test('flicker waits to be asked where people prefer less motion', async () => {
  const context = await browser.createBrowserContext();
  const quiet = await context.newPage();
  await quiet.emulateMediaFeatures([{name: 'prefers-reduced-motion', value: 'reduce'}]);
  await quiet.goto(page.url());
  await quiet.evaluate(() => window.onmesh.ready);
  assert.strictEqual((await state(quiet)).flicker_runs, false);
  await context.close();
});
