// view --serve under test: its process, its page, and requests without a browser.
import {spawn} from 'node:child_process';
import {createConnection} from 'node:net';
import {folder} from './browser.mjs';

/// Start a server. \return {url, port, token, process, stop()}; stop() gives {code, stderr}
export function serve(...words) {
  const child = spawn(process.env.ONMESH, ['view', '--serve', ...words], {cwd: folder});
  let stdout = '';
  let stderr = '';
  child.stderr.on('data', (data) => (stderr += data));
  const ended = new Promise((resolve) =>
    child.on('close', (code, signal) => resolve({code, signal, stdout, stderr})),
  );
  const stop = (signal = 'SIGINT') => {
    child.kill(signal);
    return ended;
  };
  return new Promise((resolve, reject) => {
    child.stdout.on('data', (data) => {
      stdout += data;
      const found = /^http:\/\/127\.0\.0\.1:(\d+)\/([0-9a-f]{32})\/\n/.exec(stdout);
      if (!found) return;
      const [line, port, token] = found;
      resolve({url: line.trim(), port: Number(port), token, process: child, stop, ended});
    });
    ended.then(reject);
  });
}

/// A page of the server, with `errors`.
export async function open_url(browser, url, size = {width: 1280, height: 720}) {
  const page = await browser.newPage();
  await page.setViewport(size);
  page.errors = [];
  page.on('console', (message) => {
    if (['error', 'warn'].includes(message.type())) page.errors.push(message.text());
  });
  page.on('pageerror', (error) => page.errors.push(error.message));
  await page.goto(url, {waitUntil: 'load', timeout: 60000});
  await page.evaluate(() => window.onmesh.ready);
  return page;
}

/// \return {status, text, json}
export async function request(url, options = {}) {
  const answer = await fetch(url, options);
  const text = await answer.text();
  let json = null;
  try {
    json = JSON.parse(text);
  } catch {
    // It is no JSON.
  }
  return {status: answer.status, text, json};
}

export const post = (server, name, body) =>
  request(server.url + name, {method: 'POST', body: JSON.stringify(body)});

/// Send bytes as they are. \return what comes back until the server closes
export function raw(port, bytes, wait = 20000) {
  return new Promise((resolve, reject) => {
    const socket = createConnection(port, '127.0.0.1', () => socket.write(bytes));
    let answer = '';
    socket.setTimeout(wait, () => socket.destroy(new Error('no answer')));
    socket.on('data', (data) => (answer += data.toString('latin1')));
    socket.on('error', (error) => (answer ? resolve(answer) : reject(error)));
    socket.on('close', () => resolve(answer));
  });
}
