// One Chromium for a test file, and pages that watch for errors and requests.
import {writeFileSync} from 'node:fs';
import {join} from 'node:path';
import {pathToFileURL} from 'node:url';
import puppeteer from 'puppeteer-core';

export const folder = process.env.VIEWER_TEST_FOLDER;

export function launch(more = []) {
  const root = process.getuid() === 0 ? ['--no-sandbox'] : [];
  return puppeteer.launch({
    executablePath: process.env.CHROMIUM,
    headless: true,
    protocolTimeout: 120000,
    args: [
      '--headless=new',
      '--use-angle=swiftshader',
      '--enable-unsafe-swiftshader',
      ...root,
      ...more,
    ],
  });
}

/// Open a page's text from disk. \return the page, with `errors` and `requests` beyond the file
export async function open(browser, name, text, size = {width: 1280, height: 720}) {
  const path = join(folder, name);
  writeFileSync(path, text);
  return open_file(browser, path, size);
}

export async function open_file(browser, path, size = {width: 1280, height: 720}) {
  const page = await browser.newPage();
  await page.setViewport(size);
  page.errors = [];
  page.requests = [];
  page.on('console', (message) => {
    if (['error', 'warn'].includes(message.type())) page.errors.push(message.text());
  });
  page.on('pageerror', (error) => page.errors.push(error.message));
  page.on('request', (request) => page.requests.push(request.url()));
  await page.goto(pathToFileURL(path).href, {waitUntil: 'load', timeout: 60000});
  await page.evaluate(() => window.onmesh?.ready?.catch(() => {}));
  page.requests = page.requests.filter((url) => url !== pathToFileURL(path).href);
  page.requests = page.requests.filter((url) => !url.startsWith('data:'));
  return page;
}

export const set = (page, changes) => page.evaluate((c) => window.onmesh.set(c), changes);
export const state = (page) => page.evaluate(() => window.onmesh.state());

/// The middle colours of a strip of a pane: shares of its size. \return RGBA codes
export async function strip(page, pane, x0, x1, y) {
  return page.evaluate(
    (name, from, to, at) => {
      const {offsetWidth: width, offsetHeight: height} = document.getElementById(`${name}-pane`);
      return window.onmesh.pixels(name, from * width, at * height, (to - from) * width, 1);
    },
    pane,
    x0,
    x1,
    y,
  );
}
