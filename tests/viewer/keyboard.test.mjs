// Every control by keyboard alone.
import assert from 'node:assert';
import {after, before, test} from 'node:test';
import {launch, open, set, state} from './browser.mjs';
import * as fixture from './fixture.mjs';

let browser, page;
before(async () => {
  browser = await launch();
  const blocks = new fixture.Blocks();
  page = await open(browser, 'full.html', fixture.page(fixture.full_scene(blocks), blocks));
});
after(() => browser.close());

// Names of what has the focus; radio buttons of a group are one stop.
const focused = () =>
  page.evaluate(() => {
    const {id, name, tagName} = document.activeElement;
    return tagName === 'BODY' ? null : name || id;
  });

async function tab_to(name) {
  for (let i = 0; i < 80; ++i) {
    if ((await focused()) === name) return;
    await page.keyboard.press('Tab');
  }
  assert.fail(`no way to ${name}`);
}

test('Tab reaches every control and both panes, and focus is seen', async () => {
  await set(page, {colour: 'distance', seam_errors: true});
  const stops = '#controls :is(input, select, button, textarea), .pane';
  const wanted = await page.$$eval(stops, (list) =>
    [...new Set(list.filter((e) => !e.disabled).map((e) => e.name || e.id))].sort(),
  );
  const reached = new Set();
  await page.evaluate(() => document.activeElement.blur());
  for (let i = 0; i < 80; ++i) {
    await page.keyboard.press('Tab');
    const name = await focused();
    if (name === null) break;
    reached.add(name);
    const outline = await page.evaluate(
      () => getComputedStyle(document.activeElement).outlineStyle,
    );
    assert.strictEqual(outline, 'solid', `focus on ${name} is not seen`);
  }
  assert.deepStrictEqual(wanted.filter((name) => !reached.has(name)), []);
});

test('every control has a label', async () => {
  const bare = await page.$$eval('#controls :is(input, select, textarea)', (list) =>
    list.filter((e) => !e.labels[0]?.innerText.trim()).map((e) => e.name || e.id),
  );
  assert.deepStrictEqual(bare, []);
});

test('Space switches every check box', async () => {
  await set(page, {compare: 'flicker', colour: 'distance'});
  const names = await page.$$eval('#controls [type=checkbox]', (list) => list.map((e) => e.name));
  for (const name of names) {
    const before_press = (await state(page))[name];
    await tab_to(name);
    await page.keyboard.press('Space');
    assert.strictEqual((await state(page))[name], !before_press, name);
    await page.keyboard.press('Space');
  }
});

test('arrow keys move every slider', async () => {
  const usable = {
    split: {compare: 'slider'},
    flicker_speed: {compare: 'flicker'},
    exposure: {map: 1},
    checker_power: {colour: 'checker'},
    difference_share: {colour: 'difference', map: 0},
    seam_share: {seam_errors: true},
  };
  const names = await page.$$eval('#controls [type=range]', (list) => list.map((e) => e.name));
  for (const name of names) {
    await set(page, usable[name]);
    const before_press = (await state(page))[name];
    await tab_to(name);
    await page.keyboard.press('ArrowLeft');
    assert.ok((await state(page))[name] < before_press, name);
  }
});

test('arrow keys change every list and every choice', async () => {
  await set(page, {colour: 'texture', compare: 'before', map: 0, panes: 'both'});
  const names = await page.$$eval('#controls select', (list) => list.map((e) => e.name));
  for (const name of [...names, 'compare', 'panes']) {
    if (name === 'filtering') await set(page, {colour: 'texture'});
    const before_press = (await state(page))[name];
    await tab_to(name);
    await page.keyboard.press('ArrowDown');
    assert.notStrictEqual((await state(page))[name], before_press, name);
  }
});

test('keys turn, move, zoom and reset the model', async () => {
  await set(page, {panes: 'both'});
  await tab_to('model-pane');
  const press = async (key, shift) => {
    if (shift) await page.keyboard.down('Shift');
    await page.keyboard.press(key);
    if (shift) await page.keyboard.up('Shift');
    return state(page);
  };
  const home = await press('0');
  assert.ok((await press('ArrowRight')).azimuth !== home.azimuth);
  assert.ok((await press('ArrowUp')).elevation > home.elevation);
  assert.ok((await press('+')).extent < home.extent);
  assert.ok((await press('ArrowLeft', true)).target[0] !== home.target[0]);
  await press('-');
  const back = await press('Home');
  for (const name of ['azimuth', 'elevation', 'extent']) assert.strictEqual(back[name], home[name]);
});

test('a texel is marked by typing its column and row', async () => {
  await set(page, {tile: 0, map: 0});
  await tab_to('texel-column');
  await page.keyboard.type('7');
  await tab_to('texel-row');
  await page.keyboard.type('9');
  await tab_to('mark');
  await page.keyboard.press('Enter');
  const {place} = await state(page);
  assert.deepStrictEqual([place.column, place.row], [7, 9]);
});

test('mouse and touch turn, move and zoom the model', async () => {
  await page.evaluate(() => document.getElementById('reset').click());
  const home = await state(page);
  const box = await (await page.$('#model-pane')).boundingBox();
  const [x, y] = [box.x + box.width * 0.7, box.y + box.height * 0.7];
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x - 60, y + 30, {steps: 3});
  await page.mouse.up();
  const turned = await state(page);
  assert.ok(turned.azimuth > home.azimuth && turned.elevation > home.elevation);
  await page.mouse.wheel({deltaY: -300});
  await new Promise((resolve) => setTimeout(resolve, 200));
  const zoomed = await state(page);
  assert.ok(zoomed.extent < turned.extent);
  const first = await page.touchscreen.touchStart(x - 20, y);
  const second = await page.touchscreen.touchStart(x + 20, y);
  await second.move(x + 60, y);
  await second.end();
  await first.end();
  const pinched = await state(page);
  assert.ok(pinched.extent < zoomed.extent, 'a pinch zooms');
});
