// What the page does with good data and bad, in a browser with and without graphics.
import assert from 'node:assert';
import {after, before, test} from 'node:test';
import {launch, open, set, state, strip} from './browser.mjs';
import * as fixture from './fixture.mjs';

let browser;
before(async () => {
  browser = await launch();
});
after(() => browser.close());

const problem = (page) =>
  page.evaluate(() => {
    const box = document.getElementById('problem');
    return box.hidden ? '' : box.textContent;
  });

function full_page() {
  const blocks = new fixture.Blocks();
  return fixture.page(fixture.full_scene(blocks), blocks);
}

test('a full page opens from disk without errors and without a request', async () => {
  const page = await open(browser, 'full.html', full_page());
  assert.deepStrictEqual(page.errors, []);
  assert.deepStrictEqual(page.requests, []);
  assert.strictEqual(await problem(page), '');
  const note = await page.$eval('#notes', (box) => box.textContent);
  assert.match(note, /texture a\.png is shown at 256/);
  await page.close();
});

test('every kind of picture draws without errors', async () => {
  const page = await open(browser, 'full.html', full_page());
  const changes = [
    ...['texture', 'difference', 'checker', 'distance', 'grey'].map((colour) => ({colour})),
    ...['before', 'after', 'slider', 'side', 'flicker'].map((compare) => ({compare})),
    {colour: 'texture', seams: true, samples: true, nodes: true, wireframe: true},
    {seam_errors: true, filtering: 'nearest', light: false, tile: 1},
    {map: 1, exposure: 2},
    {panes: 'uv'},
    {panes: 'model', theme: 'dark'},
  ];
  for (const change of changes) await set(page, change);
  assert.deepStrictEqual(page.errors, []);
  assert.strictEqual(await problem(page), '');
  await page.close();
});

test('the policy forbids requests', async () => {
  const page = await open(browser, 'full.html', full_page());
  const refused = await page.evaluate(() => fetch('https://example.org/').then(() => 0, () => 1));
  assert.strictEqual(refused, 1);
  await page.close();
});

test('the first frame of two 1024 x 1024 textures', async (t) => {
  const blocks = new fixture.Blocks();
  const scene = fixture.bare_scene(fixture.grid(60, 50, fixture.torus), blocks);
  const image = (shift) => {
    const codes = (x, y) => {
      const grain = ((x * 7919 + y * 104729) >> 3) & 63;
      return [x >> 2, y >> 2, grain].map((code) => code ^ shift);
    };
    return blocks.image(fixture.picture(1024, 1024, 3, codes), 1024, 1024, 3);
  };
  scene.afters = [{name: 'after'}];
  scene.maps = [fixture.map_of('map', image(0), [image(1)])];
  // Told, not tested: other programs may be busy.
  const times = [];
  for (let i = 0; i < 3; ++i) {
    const page = await open(browser, 'first.html', fixture.page(scene, blocks));
    times.push(Math.round(await page.evaluate(() => window.onmesh.finished())));
    await page.close();
  }
  t.diagnostic(`is there after ${times.join(', ')} ms`);
});

test('a mesh of two million triangles opens and answers the pointer', async (t) => {
  const blocks = new fixture.Blocks();
  const scene = fixture.bare_scene(fixture.grid(1000, 1000, fixture.torus), blocks);
  const page = await open(browser, 'large.html', fixture.page(scene, blocks));
  const time = await page.evaluate(() => window.onmesh.finished());
  const pick = await page.evaluate(async () => {
    await window.onmesh.pick(200, 300);
    const start = performance.now();
    const place = await window.onmesh.pick(210, 300);
    return {place, time: performance.now() - start};
  });
  t.diagnostic(`opens in ${Math.round(time)} ms, ${pick.time.toFixed(1)} ms a look-up`);
  assert.deepStrictEqual(page.errors, []);
  assert.ok(pick.place.triangle >= 0);
  await page.close();
});

test('names with markup, quotes and 300 characters stay text', async () => {
  const markup = '</script><script>window.harmed = 1</script>';
  const name = `${markup}"'<img src=x onerror=harm()>ü漢字${'x'.repeat(240)}`;
  const blocks = new fixture.Blocks();
  const scene = fixture.full_scene(blocks);
  Object.assign(scene, {title: name, notes: [name], created: ['onmesh', 'view', name]});
  scene.afters[0].name = scene.tiles[0].name = scene.maps[0].name = scene.mesh.name = name;
  scene.fields.layers[0].name = scene.samples.kind = name;
  scene.numbers.push({title: name, rows: [[name, name]]});
  for (const size of [{width: 1280, height: 720}, {width: 390, height: 844}]) {
    const page = await open(browser, 'names.html', fixture.page(scene, blocks), size);
    await set(page, {colour: 'distance', samples: true});
    const seen = await page.evaluate(() => ({
      harmed: window.harmed,
      images: document.images.length,
      title: document.getElementById('title').textContent,
      wide: document.documentElement.scrollWidth,
    }));
    assert.deepStrictEqual(page.errors, []);
    assert.strictEqual(seen.harmed, undefined);
    assert.strictEqual(seen.images, 0);
    assert.strictEqual(seen.title, name);
    assert.ok(seen.wide <= size.width, `${seen.wide} wide`);
    await page.close();
  }
});

test('a phone shows everything without scrolling sideways, dark and light', async () => {
  const size = {width: 390, height: 844, isMobile: true, hasTouch: true};
  const page = await open(browser, 'full.html', full_page(), size);
  const tones = [];
  for (const value of ['dark', 'light']) {
    await page.emulateMediaFeatures([{name: 'prefers-color-scheme', value}]);
    await set(page, {panes: 'both'});
    const wide = await page.evaluate(() => document.documentElement.scrollWidth);
    assert.ok(wide <= 390, `${wide} wide`);
    tones.push((await strip(page, 'model', 0.01, 0.05, 0.5))[0]);
  }
  assert.ok(tones[0] < 80 && tones[1] > 200, `backgrounds ${tones}`);
  await set(page, {theme: 'dark'});
  assert.ok((await strip(page, 'model', 0.01, 0.05, 0.5))[0] < 80);
  await page.close();
});

test('nothing jumps when values change', async () => {
  const page = await open(browser, 'full.html', full_page());
  const places = () =>
    page.$$eval('#controls :is(input, select, button)', (list) => list.map((x) => x.offsetTop));
  const first = await places();
  for (const change of [{colour: 'difference'}, {colour: 'distance'}, {seam_errors: true}]) {
    await set(page, change);
    assert.deepStrictEqual(await places(), first);
  }
  await page.evaluate(() => window.onmesh.mark(1, 100, 20));
  await new Promise((resolve) => setTimeout(resolve, 300));
  assert.deepStrictEqual(await places(), first);
  await page.close();
});

test('a mesh without UVs says so and shows its shape and distances', async () => {
  const blocks = new fixture.Blocks();
  const full = fixture.full_scene(blocks);
  const scene = fixture.bare_scene({...fixture.grid(20, 20, fixture.torus), uvs: null}, blocks);
  scene.fields = full.fields;
  const page = await open(browser, 'no-uvs.html', fixture.page(scene, blocks));
  assert.deepStrictEqual(page.errors, []);
  assert.match(await page.$eval('#notes', (box) => box.textContent), /no UVs/);
  const {colour, panes} = await state(page);
  assert.deepStrictEqual([colour, panes], ['distance', 'model']);
  await page.close();
});

test('without maps the model is grey', async () => {
  const blocks = new fixture.Blocks();
  const scene = fixture.bare_scene(fixture.grid(20, 20, fixture.plane), blocks);
  Object.assign(scene.camera, {azimuth: 0, elevation: 0});
  const page = await open(browser, 'grey.html', fixture.page(scene, blocks));
  const [r, g, b] = await strip(page, 'model', 0.5, 0.51, 0.4);
  assert.ok(r === g && g === b && Math.abs(r - 184) < 12, `${r} ${g} ${b}`);
  await page.close();
});

test('damaged data is said in a sentence', async () => {
  const blocks = new fixture.Blocks();
  const scene = fixture.full_scene(blocks);
  const good = fixture.page(scene, blocks);
  const broken = {
    'a block is missing': [good.replace('id="onmesh-block-0"', 'id="nothing"'), /missing/],
    'a block is no zlib stream': [
      good.replace(/(id="onmesh-block-0">)[^<]{40}/, `$1${'A'.repeat(40)}`),
      /cannot be unpacked/,
    ],
    'the scene is cut off': [good.replace('{"version":1', '{"version"'), /damaged/],
    'the version is newer': [good.replace('{"version":1', '{"version":2'), /version 2/],
    'there is no data': [good.replace('id="onmesh-scene"', 'id="nothing"'), /no data/],
  };
  for (const [name, [text, sentence]] of Object.entries(broken)) {
    const page = await open(browser, 'broken.html', text);
    assert.match(await problem(page), sentence, name);
    await page.close();
  }
});

test('a lost graphics context is said', async () => {
  const page = await open(browser, 'full.html', full_page());
  await page.evaluate(() => window.onmesh.lose_context());
  await page.waitForFunction(() => !document.getElementById('problem').hidden);
  assert.match(await problem(page), /reload the page/);
  await page.close();
});

test('without WebGL the page says so and shows the numbers', async () => {
  const plain = await launch(['--disable-gpu', '--disable-3d-apis']);
  try {
    const page = await open(plain, 'full.html', full_page());
    assert.match(await problem(page), /no WebGL 2/);
    assert.match(await page.$eval('#numbers', (box) => box.innerText), /sigma spatial/);
    assert.deepStrictEqual(page.errors, []);
  } finally {
    await plain.close();
  }
});
