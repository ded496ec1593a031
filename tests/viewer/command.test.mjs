// The command that the page offers renders the view that the page shows.
import assert from 'node:assert';
import {execFileSync} from 'node:child_process';
import {readFileSync} from 'node:fs';
import {after, before, test} from 'node:test';
import {folder, launch, open, open_file, set} from './browser.mjs';
import * as fixture from './fixture.mjs';
import {file, make_page, no_pages} from './program.mjs';

let browser;
before(async () => {
  browser = await launch();
});
after(() => browser.close());

async function command_of(created, more = {}) {
  const blocks = new fixture.Blocks();
  const scene = fixture.bare_scene(fixture.grid(2, 2, fixture.plane), blocks);
  Object.assign(scene, {created, ...more});
  Object.assign(scene.camera, {azimuth: -30, elevation: 0, target: [1, -2, 1 / 3], extent: 4});
  const page = await open(browser, 'command.html', fixture.page(scene, blocks));
  const command = await page.evaluate(() => window.onmesh.command());
  await page.close();
  return command;
}

const view = '--azimuth -30 --elevation 0 --target 1,-2,0.333333 --extent 4 -o picture.png';

test('options of the view are replaced in both spellings', async () => {
  const old = ['-o', 'page.html', '--azimuth', '5', '--zoom=2', '--target', '0,0,0', '--extent=1'];
  const page_only = ['--distances', 'vertex:1', '--samples=2tx', '--nodes', '1%'];
  const words = ['onmesh', 'view', 'a.obj', ...old, ...page_only, '-t', 'b.png', '--elevation=3'];
  assert.strictEqual(await command_of(words), `onmesh view a.obj -t b.png ${view}`);
});

test('a page that filter wrote names its own command', async () => {
  const more = {view_command: ['onmesh', 'view', 'a.obj', '-t', 'c.png']};
  const words = ['onmesh', 'filter', 'a.obj', '-t', 'b.png', '-o', 'c.png'];
  assert.strictEqual(await command_of(words, more), `onmesh view a.obj -t c.png ${view}`);
});

test('a shell reads the arguments as they were', async () => {
  const odd = [`it's "a" $HOME`, 'a b', '`x`', 'ü漢', '*', 'a;b'];
  const command = await command_of(['onmesh', 'view', ...odd]);
  const echoed = execFileSync('sh', ['-c', command.replace('onmesh', `printf '%s\\n'`)]);
  assert.deepStrictEqual(echoed.toString().split('\n').slice(1, 1 + odd.length), odd);
});

test('the button copies the command', async () => {
  const blocks = new fixture.Blocks();
  const scene = fixture.bare_scene(fixture.grid(2, 2, fixture.plane), blocks);
  const page = await open(browser, 'command.html', fixture.page(scene, blocks));
  await page.evaluate(() => {
    Object.defineProperty(navigator, 'clipboard', {
      value: {writeText: (text) => Promise.resolve((window.copied = text))},
    });
    document.getElementById('copy').click();
  });
  await page.waitForFunction(() => document.getElementById('copied').textContent === 'copied');
  const command = await page.evaluate(() => window.onmesh.command());
  assert.strictEqual(await page.evaluate(() => window.copied), command);
  await page.close();
});

test('without a clipboard the command is selected for copying by hand', async () => {
  const blocks = new fixture.Blocks();
  const scene = fixture.bare_scene(fixture.grid(2, 2, fixture.plane), blocks);
  const page = await open(browser, 'command.html', fixture.page(scene, blocks));
  const selected = await page.evaluate(async () => {
    Object.defineProperty(navigator, 'clipboard', {value: undefined});
    document.getElementById('copy').click();
    await new Promise((resolve) => setTimeout(resolve, 100));
    const field = document.activeElement;
    return field.value.slice(field.selectionStart, field.selectionEnd);
  });
  assert.strictEqual(selected, await page.evaluate(() => window.onmesh.command()));
  await page.close();
});

// Where a picture differs from its corner: the box around it as shares of the height, from the
// middle.
function silhouette(page, source) {
  return page.evaluate(async (url) => {
    const image = new Image();
    image.src = url;
    await image.decode();
    const {width, height} = image;
    const canvas = new OffscreenCanvas(width, height);
    const context = canvas.getContext('2d');
    context.drawImage(image, 0, 0);
    const {data} = context.getImageData(0, 0, width, height);
    const box = [Infinity, Infinity, -Infinity, -Infinity];
    for (let y = 0; y < height; ++y) {
      for (let x = 0; x < width; ++x) {
        const at = 4 * (y * width + x);
        const far = [0, 1, 2].some((k) => Math.abs(data[at + k] - data[k]) > 24);
        if (!far) continue;
        box[0] = Math.min(box[0], x);
        box[1] = Math.min(box[1], y);
        box[2] = Math.max(box[2], x + 1);
        box[3] = Math.max(box[3], y + 1);
      }
    }
    return box.map((x, k) => (x - (k % 2 ? height : width) / 2) / height);
  }, source);
}

test('the command renders the same view', {skip: no_pages()}, async () => {
  const blank = await browser.newPage();
  const page = await open_file(browser, make_page('same.html', 'cube.obj', '-t', 'cube.png'));
  await set(page, {panes: 'model', theme: 'light'});
  // No pane covers the canvas for the screenshot, so that only the model is on it.
  const hide = 'document.querySelectorAll(".tag, #legends").forEach((e) => (e.hidden = true))';
  await page.evaluate(hide);
  for (const change of [{}, {azimuth: -70, elevation: 50, target: [0.2, -0.3, 0.4], extent: 6}]) {
    await set(page, change);
    const command = await page.evaluate(() => window.onmesh.command());
    execFileSync('sh', ['-c', command.replace('onmesh', `"$ONMESH"`)], {cwd: folder});
    const canvas = await (await page.$('#canvas')).screenshot({encoding: 'base64'});
    const seen = await silhouette(blank, `data:image/png;base64,${canvas}`);
    const rendered = readFileSync(file('picture.png')).toString('base64');
    const drawn = await silhouette(blank, `data:image/png;base64,${rendered}`);
    seen.forEach((x, k) => assert.ok(Math.abs(x - drawn[k]) < 0.006, `${seen} and ${drawn}`));
  }
  await page.close();
});
