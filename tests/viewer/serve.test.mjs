// The window: a browser drives the page of view --serve.
import assert from 'node:assert';
import {existsSync, readFileSync, rmSync, writeFileSync} from 'node:fs';
import {after, before, test} from 'node:test';
import {deflateSync} from 'node:zlib';
import {launch, set} from './browser.mjs';
import {file, make_cube, no_pages, onmesh, read_obj, read_ply_vertices} from './program.mjs';
import {open_url, post, request, serve} from './server.mjs';

const skip = no_pages();
let browser, server, page;

before(async () => {
  if (skip) return;
  browser = await launch();
  make_cube();
  onmesh('make-mesh', 'cube', '-o', 'large.obj', '-t', 'large.png', '--size', '1024', '--noise', '0.1');
  server = await serve('cube.obj', '-t', 'noisy.png');
  page = await open_url(browser, server.url);
});
after(async () => {
  await browser?.close();
  await server?.stop();
});

const live = (of, name, ...values) =>
  of.evaluate((n, v) => window.onmesh.live[n](...v), name, values);

/// An RGB image as PNG.
function write_png(name, {width, height, codes}) {
  const chunk = (type, data) => {
    const body = Buffer.concat([Buffer.from(type), data]);
    const out = Buffer.alloc(8 + body.length);
    out.writeUInt32BE(data.length, 0);
    body.copy(out, 4);
    out.writeUInt32BE(crc32(body), 4 + body.length);
    return out;
  };
  const head = Buffer.alloc(13);
  head.writeUInt32BE(width, 0);
  head.writeUInt32BE(height, 4);
  head.set([8, 2, 0, 0, 0], 8);
  const rows = Buffer.alloc(height * (3 * width + 1));
  for (let y = 0; y < height; ++y) {
    rows.set(codes.slice(3 * width * y, 3 * width * (y + 1)), y * (3 * width + 1) + 1);
  }
  const mark = Buffer.from([137, 80, 78, 71, 13, 10, 26, 10]);
  const parts = [chunk('IHDR', head), chunk('IDAT', deflateSync(rows)), chunk('IEND', Buffer.alloc(0))];
  writeFileSync(file(name), Buffer.concat([mark, ...parts]));
}

function crc32(bytes) {
  let crc = ~0;
  for (const byte of bytes) {
    crc ^= byte;
    for (let k = 0; k < 8; ++k) crc = (crc >>> 1) ^ (crc & 1 ? 0xedb88320 : 0);
  }
  return ~crc >>> 0;
}

/// Fails unless a state's codes are those of the file.
function assert_same_codes(shown, name) {
  write_png('shown.png', shown);
  const {max} = JSON.parse(onmesh('compare', 'shown.png', name, '--json'));
  assert.strictEqual(max, 0, name);
}

async function wait_for_run(of = server) {
  for (;;) {
    const {json} = await request(`${of.url}status`);
    if (json.run && !['waiting', 'running'].includes(json.run.state)) return json.run;
    await new Promise((resolve) => setTimeout(resolve, 50));
  }
}

test('the window opens with a preview, without errors', {skip}, async () => {
  await live(page, 'preview');
  assert.deepStrictEqual(page.errors, []);
  const text = await page.$eval('#live-status', (line) => line.textContent);
  assert.match(text, /^Preview: \d+ ms/);
});

test('the preview of a small texture is what the command makes', {skip}, async () => {
  await live(page, 'change', 'spatial', 3);
  await live(page, 'change', 'range', 0.2);
  const shown = await live(page, 'codes', 1);
  onmesh('filter', 'cube.obj', '-t', 'noisy.png', '--sigma-spatial', '3tx', '--sigma-range', '0.2',
    '-o', 'small.png', '--quiet');
  assert_same_codes(shown, 'small.png');
});

test('the preview of a large texture is the filter of the reduced one', {skip}, async () => {
  const other = await serve('large.obj', '-t', 'large.png');
  try {
    const of = await open_url(browser, other.url);
    await live(of, 'change', 'spatial', 8);
    const reduced = await live(of, 'codes_reduced');
    assert.strictEqual(reduced.width, 512);
    write_png('reduced.png', reduced);
    const shown = await live(of, 'codes', 1);
    const {json} = await post(other, 'preview', {options: {sigma_spatial: '8tx', sigma_range: '0.1'}});
    const sigma = /^([\d.e-]+) mesh units/.exec(json.part.rows[0][1])[1];
    const told = onmesh('filter', 'large.obj', '-t', 'large.png', '-o', 'x.png', '--dry-run', '--json',
      '--sigma-spatial', '8tx');
    const plan = JSON.parse(told).plan;
    assert.ok(Math.abs(plan.sigma_spatial / Number(sigma) - 1) < 1e-4);
    onmesh('filter', 'large.obj', '-t', 'reduced.png', '--sigma-spatial', String(plan.sigma_spatial),
      '--sigma-range', '0.1', '-o', 'reduced-filtered.png', '--quiet');
    assert_same_codes(shown, 'reduced-filtered.png');
    await of.close();
  } finally {
    await other.stop();
  }
});

test('a click gives the distances of onmesh distance', {skip}, async () => {
  const vertices = read_obj('cube.obj').flatMap(({positions}) => positions);
  const source = vertices[0];
  await live(page, 'measure_from', source);
  onmesh('distance', 'cube.obj', '--point', source.join(','), '-o', 'distance.ply', '--quiet');
  for (const [x, y, z, distance] of read_ply_vertices('distance.ply')) {
    const found = await page.evaluate((p) => window.onmesh.distance_at(0, p), [x, y, z]);
    assert.ok(Math.abs(found - distance) < 1e-5, `${found} instead of ${distance}`);
  }
  const {colour} = await page.evaluate(() => window.onmesh.state());
  assert.strictEqual(colour, 'distance');
});

test('the pointer picks the point', {skip}, async () => {
  const count = (await live(page, 'layers')).length;
  const box = await (await page.$('#model-pane')).boundingBox();
  await page.mouse.click(box.x + box.width / 2 + 11, box.y + box.height / 2);
  await page.waitForFunction((n) => window.onmesh.live.layers().length > n, {}, count);
  await set(page, {colour: 'texture'});
});

test('samples are shown', {skip}, async () => {
  await page.$eval('#live-samples-show', (button) => button.click());
  await page.waitForFunction(() => window.onmesh.state().samples);
  const label = await page.$eval('[name="samples"]', (e) => e.nextElementSibling.textContent);
  assert.match(label, /^Poisson-disk samples, /);
  await set(page, {samples: false});
});

test('a full run is saved as the command saves it, once that is confirmed', {skip}, async () => {
  rmSync(file('saved.png'), {force: true});
  await live(page, 'change', 'spatial', 2);
  await page.$eval('#live-run', (button) => button.click());
  assert.strictEqual((await wait_for_run()).state, 'done');
  await page.waitForFunction(() => !document.getElementById('live-save').disabled);
  await page.$eval('#live-name', (field) => (field.value = 'saved.png'));
  await page.$eval('#live-save', (button) => button.click());
  await page.waitForFunction(() => !document.getElementById('live-question').hidden);
  assert.ok(!existsSync(file('saved.png')), 'nothing may be written yet');
  await page.$eval('#live-yes', (button) => button.click());
  await page.waitForFunction(() => /^Written/.test(document.getElementById('live-status').textContent));
  const line = await page.$eval('#live-command', (field) => field.value);
  const words = line.replace(/ -o .*/, ' -o by-command.png').split(' ').slice(1);
  onmesh(...words, '--quiet');
  assert.ok(readFileSync(file('saved.png')).equals(readFileSync(file('by-command.png'))), line);
});

test('what is there is not written over unless that is said', {skip}, async () => {
  writeFileSync(file('there.png'), 'mine');
  const asked = await post(server, 'save', {name: 'there.png', confirmed: true});
  assert.deepStrictEqual(asked.json.exists, ['there.png']);
  assert.strictEqual(readFileSync(file('there.png'), 'utf8'), 'mine');
  for (const name of ['../x.png', '/tmp/x.png', 'a/b.png', '.x.png', 'x', 'x.glb', 'cube.obj', '']) {
    const {status} = await post(server, 'save', {name, confirmed: true, overwrite: true});
    assert.strictEqual(status, 422, name);
  }
});

test('a second tab shows the full run, too', {skip}, async () => {
  const second = await open_url(browser, server.url);
  await second.waitForFunction(() => !document.getElementById('live-save').disabled);
  const [a, b] = [await live(page, 'codes', 2), await live(second, 'codes', 2)];
  assert.deepStrictEqual(a.codes, b.codes);
  await Promise.all([live(page, 'change', 'range', 0.3), live(second, 'change', 'range', 0.4)]);
  assert.deepStrictEqual(second.errors, []);
  await second.close();
});

test('a job that fails says why in the page', {skip}, async () => {
  await live(page, 'change', 'samples', 'poisson');
  await live(page, 'change', 'spacing', 'wide');
  const text = await page.$eval('#live-status', (line) => line.textContent);
  assert.match(text, /--spacing/);
  await live(page, 'change', 'samples', 'texel');
  assert.match(await page.$eval('#live-status', (line) => line.textContent), /^Preview/);
});

test('a run is cancelled, and a second one is refused meanwhile', {skip}, async () => {
  const other = await serve('large.obj', '-t', 'large.png');
  try {
    const slow = {sigma_spatial: '60tx', sigma_range: '0.1', distance: 'heat'};
    const {status, json} = await post(other, 'run', {options: slow});
    assert.strictEqual(status, 202);
    for (const name of ['run', 'preview']) {
      const refused = await post(other, name, {options: {}});
      assert.strictEqual(refused.status, 409, name);
      assert.match(refused.json.error, /not over yet/);
    }
    await post(other, 'cancel', {});
    const run = await wait_for_run(other);
    assert.deepStrictEqual([run.number, run.state], [json.job, 'cancelled']);
  } finally {
    const {code, stderr} = await other.stop();
    assert.strictEqual(code, 130);
    assert.strictEqual(stderr.trim(), 'onmesh view: interrupted');
  }
});

test('a texture that is replaced is noticed before a full run', {skip}, async () => {
  writeFileSync(file('mine.png'), readFileSync(file('noisy.png')));
  const other = await serve('cube.obj', '-t', 'mine.png');
  try {
    const of = await open_url(browser, other.url);
    await live(of, 'preview');
    writeFileSync(file('mine.png'), readFileSync(file('cube.png')));
    await of.$eval('#live-run', (button) => button.click());
    await of.waitForFunction(() => /is another file now/.test(document.getElementById('live-status').textContent));
    await of.reload();
    await of.evaluate(() => window.onmesh.ready);
    await live(of, 'preview');
    await of.$eval('#live-run', (button) => button.click());
    await of.waitForFunction(() => !document.getElementById('live-save').disabled);
    assert.deepStrictEqual(of.errors, []);
  } finally {
    await other.stop();
  }
});

test('a mesh without textures has its shape and distances', {skip}, async () => {
  const lines = readFileSync(file('cube.obj'), 'utf8').split('\n');
  const bare = lines.filter((line) => !/^(vt|mtllib|usemtl)/.test(line));
  writeFileSync(file('bare.obj'), bare.map((l) => (l.startsWith('f') ? l.replace(/\/\d*(\/\d*)?/g, '') : l)).join('\n'));
  const other = await serve('bare.obj');
  try {
    const of = await open_url(browser, other.url);
    assert.strictEqual(await of.$('#live-run'), null);
    assert.ok((await of.$eval('#live-why', (line) => line.textContent)).length > 20);
    await of.$eval('#live-from-mark', (button) => button.click());
    await of.waitForFunction(() => window.onmesh.live.layers().length === 1);
    assert.deepStrictEqual(of.errors, []);
  } finally {
    await other.stop();
  }
});

test('how long a move of a slider takes', {skip}, async (t) => {
  const median = (times) => times.sort((a, b) => a - b)[times.length >> 1];
  const other = await serve('large.obj', '-t', 'large.png');
  try {
    const of = await open_url(browser, other.url);
    const time = (name, value) =>
      of.evaluate(
        async (n, v) => {
          const began = performance.now();
          await window.onmesh.live.change(n, v);
          return window.onmesh.live.settled() - began;
        },
        name,
        value,
      );
    for (const guides of [0, 2]) {
      await live(of, 'change', 'blur', guides ? 2 : 0);
      await live(of, 'change', 'normals', guides > 0);
      await time('spatial', 8);
      const [range, spatial] = [[], []];
      for (let i = 0; i < 20; ++i) range.push(await time('range', 0.05 + 0.01 * i));
      for (let i = 0; i < 20; ++i) spatial.push(await time('spatial', 32 - 1.4 * i));
      t.diagnostic(
        `512 x 512, ${guides} guides, medians of 20 moves: range ${Math.round(median(range))} ms ` +
          `(goal 300), spatial ${Math.round(median(spatial))} ms (goal 600)`,
      );
    }
  } finally {
    await other.stop();
  }
});
