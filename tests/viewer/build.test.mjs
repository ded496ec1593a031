import assert from 'node:assert';
import {execFileSync} from 'node:child_process';
import {readFileSync} from 'node:fs';
import {test} from 'node:test';
import {make_page, no_pages} from './program.mjs';

const page = readFileSync(process.env.VIEWER_PAGE, 'utf8');

test('the committed page is what its sources build', () => {
  execFileSync('node', ['build.mjs', '--check'], {
    cwd: process.env.VIEWER_PAGE_SOURCE,
    stdio: 'pipe',
  });
});

test('the page has one place for data, one policy, and the licence of three.js', (t) => {
  t.diagnostic(`${Math.round(page.length / 1024)} KB without data`);
  assert.ok(page.length < 800 * 1024);
  assert.strictEqual(page.split('<!-- onmesh data -->').length, 2);
  assert.match(page, /default-src 'none'/);
  assert.match(page, /Permission is hereby granted, free of charge/);
  assert.ok(!/(src|href)="(?!data:)/.test(page), 'a reference to another file');
});

test('the program writes the committed page, with data in its place', {skip: no_pages()}, () => {
  const written = readFileSync(make_page('whole.html', 'cube.obj', '-t', 'cube.png'), 'utf8');
  const [start, end] = page.split('<!-- onmesh data -->');
  const older = 'is the program older than the page?';
  assert.ok(written.startsWith(start), `it starts differently: ${older}`);
  assert.ok(written.endsWith(end), `it ends differently: ${older}`);
  const data = written.slice(start.length, written.length - end.length);
  assert.match(data, /^\s*<script type="application\/json" id="onmesh-scene">/);
});
