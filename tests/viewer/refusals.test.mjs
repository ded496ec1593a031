// What the server of view --serve must refuse, without a browser.
import assert from 'node:assert';
import {createConnection} from 'node:net';
import {after, before, test} from 'node:test';
import {file, make_cube, no_pages, onmesh} from './program.mjs';
import {spawnSync} from 'node:child_process';
import {folder} from './browser.mjs';
import {post, raw, request, serve} from './server.mjs';

const skip = no_pages();
let server;

before(async () => {
  if (skip) return;
  make_cube();
  server = await serve('cube.obj', '-t', 'cube.png');
});
after(() => server?.stop());

const status_of = (answer) => Number(/^HTTP\/1\.1 (\d+)/.exec(answer)?.[1]);

function ask(target, fields = {}, method = 'GET') {
  const all = {Host: `127.0.0.1:${server.port}`, Connection: 'close', ...fields};
  const lines = Object.entries(all).flatMap(([name, value]) =>
    [value].flat().map((one) => `${name}: ${one}`),
  );
  return raw(server.port, `${method} ${target} HTTP/1.1\r\n${lines.join('\r\n')}\r\n\r\n`);
}

test('the page comes to whoever knows its address', {skip}, async () => {
  const home = `/${server.token}/`;
  assert.strictEqual(status_of(await ask(home)), 200);
  for (const host of ['localhost:1', '[::1]:8080', 'LOCALHOST', '127.0.0.1'])
    assert.strictEqual(status_of(await ask(home, {Host: host})), 200, host);
  const answer = await ask(home, {Origin: 'http://localhost:99'});
  assert.match(answer, /connect-src 'self'/);
  assert.doesNotMatch(answer, /connect-src 'none'/);
  assert.match(answer, /\r\nX-Content-Type-Options: nosniff\r\n/);
});

test('other hosts and origins are refused', {skip}, async () => {
  const home = `/${server.token}/`;
  const hosts = ['evil.example', '127.0.0.1.evil.example', 'localhost:8x', '127.0.0.1:', '0.0.0.0'];
  for (const host of [...hosts, ['127.0.0.1', 'evil.example'], []])
    assert.ok([400, 403].includes(status_of(await ask(home, {Host: host}))), String(host));
  const origins = ['http://evil.example', 'https://127.0.0.1', 'null', 'http://localhost.evil.example'];
  for (const origin of origins)
    assert.strictEqual(status_of(await ask(home, {Origin: origin})), 403, origin);
});

test('without the token there is nothing', {skip}, async () => {
  const {token} = server;
  const wrong = [
    '/',
    '/status',
    `/${token}`,
    `/${token}x/`,
    `/${token.slice(1)}/`,
    `/${token.toUpperCase().replace(/^./, '-')}/`,
    `//${token}/`,
    `/x/${token}/`,
    `http://127.0.0.1/${token}/`,
    '*',
  ];
  for (const target of wrong)
    assert.ok([400, 404].includes(status_of(await ask(target))), target);
});

test('no target is a path', {skip}, async () => {
  const tricks = ['../cube.obj', 'cube.obj', '..%2fcube.obj', './status', 'status/', '/etc/passwd', '%00'];
  for (const trick of [...tricks, 'result?job=../x', 'constructor', '__proto__']) {
    const code = status_of(await ask(`/${server.token}/${trick}`));
    assert.ok([400, 404].includes(code), `${trick}: ${code}`);
  }
});

test('other methods are refused', {skip}, async () => {
  for (const method of ['PUT', 'DELETE', 'OPTIONS', 'HEAD', 'CONNECT', 'FOO'])
    assert.ok([400, 405].includes(status_of(await ask(`/${server.token}/`, {}, method))), method);
  assert.strictEqual(status_of(await ask(`/${server.token}/run`)), 405);
  assert.strictEqual((await request(`${server.url}status`, {method: 'POST', body: '{}'})).status, 405);
});

test('what is too large is refused', {skip}, async () => {
  const large = await request(`${server.url}preview`, {method: 'POST', body: 'x'.repeat(2 << 20)});
  assert.strictEqual(large.status, 413);
  const fields = {'X-Long': 'x'.repeat(20000)};
  assert.strictEqual(status_of(await ask(`/${server.token}/`, fields)), 431);
  assert.strictEqual(status_of(await ask(`/${server.token}/${'x'.repeat(20000)}`)), 431);
});

test('garbage on the socket is refused', {skip}, async () => {
  let seed = 1;
  const random = () => (seed = (seed * 48271) % 2147483647) / 2147483647;
  for (let i = 0; i < 20; ++i) {
    const bytes = Buffer.from(Array.from({length: 300}, () => Math.floor(256 * random())));
    const end = Buffer.from('\r\n\r\n');
    assert.strictEqual(status_of(await raw(server.port, Buffer.concat([bytes, end]))), 400);
  }
  assert.strictEqual((await request(`${server.url}status`)).status, 200);
});

test('odd bodies get a sentence', {skip}, async () => {
  const bodies = ['', '[]', '{', 'null', '"x"', '['.repeat(100000)];
  for (const body of bodies) {
    const {status, json} = await request(`${server.url}preview`, {method: 'POST', body});
    assert.strictEqual(status, 400, body.slice(0, 20));
    assert.ok(json.error.length > 5);
  }
  const options = [
    {output: 'x.png'},
    {guides: ['/etc/passwd:0.1']},
    {guides: ['self@uv1:0.1']},
    {guides: 'self:0.1'},
    {kind: 'x'},
    {sigma_spatial: -1},
    {sigma_spatial: '-1'},
    {sigma_spatial: '1tx --output=x'},
    {sigma_range: 'x'.repeat(1000)},
    {texture: 'cube.png'},
    [],
  ];
  for (const of of options) {
    const {status, json} = await post(server, 'preview', {options: of});
    assert.strictEqual(status, 422, JSON.stringify(of));
    assert.ok(json.error.length > 5);
  }
  for (const point of [null, [1, 2], [1, 2, 'x'], {}])
    assert.strictEqual((await post(server, 'distance', {point})).status, 422);
});

test('a slow client is dropped, and others are answered meanwhile', {skip}, async () => {
  const began = Date.now();
  const slow = raw(server.port, 'GET / HTTP/1.1\r\nHost: ');
  assert.strictEqual((await request(`${server.url}status`)).status, 200);
  assert.strictEqual(status_of(await slow), 408);
  const seconds = (Date.now() - began) / 1000;
  assert.ok(seconds > 8 && seconds < 13, `${seconds} s`);
});

test('a connection that drops loses nothing', {skip}, async () => {
  const body = JSON.stringify({options: {sigma_spatial: '2tx'}});
  const socket = createConnection(server.port, '127.0.0.1');
  const head = `POST /${server.token}/run HTTP/1.1\r\nHost: localhost\r\nContent-Length: ${body.length}`;
  await new Promise((resolve) => socket.write(`${head}\r\n\r\n${body}`, resolve));
  socket.destroy();
  for (let i = 0; i < 200; ++i) {
    const {json} = await request(`${server.url}status`);
    if (json.run?.state === 'done') break;
    await new Promise((resolve) => setTimeout(resolve, 50));
  }
  assert.strictEqual((await request(`${server.url}result`)).status, 200);
});

test('a port in use, and options that do not fit, are said in one line', {skip}, () => {
  const run = (...words) =>
    spawnSync(process.env.ONMESH, ['view', ...words], {cwd: folder, encoding: 'utf8', timeout: 10000});
  const used = run('--serve', 'cube.obj', '--port', String(server.port));
  assert.strictEqual(used.status, 4);
  assert.match(used.stderr, /^onmesh view: port \d+: .*\n$/);
  const cases = [
    ['--serve', 'cube.obj', '-o', 'x.html'],
    ['--serve', 'cube.obj', '--port', '70000'],
    ['cube.obj', '-o', 'x.html', '--port', '1'],
    ['--serve'],
  ];
  for (const words of cases) {
    const {status, stderr} = run(...words);
    assert.strictEqual(status, 2, words.join(' '));
    assert.match(stderr, /^onmesh view: .*\n$/);
  }
  assert.strictEqual(run('--serve', 'missing.obj').status, 4);
  onmesh('info', 'cube.obj'); // the folder is as it was
  assert.ok(file('cube.obj'));
});
