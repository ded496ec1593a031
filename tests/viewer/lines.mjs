// A reporter of node's test runner that prints a line a test.
export default async function* lines(source) {
  const count = {ok: 0, failed: 0, skipped: 0};
  for await (const {type, data} of source) {
    const summary = /^(tests|suites|pass|fail|cancelled|skipped|todo|duration_ms) /;
    if (type === 'test:diagnostic' && !summary.test(data.message)) yield `  ${data.message}\n`;
    if (type !== 'test:pass' && type !== 'test:fail') continue;
    // A file is a test of its own, which only matters when it could not be run.
    if (data.name.endsWith('.test.mjs') && type === 'test:pass') continue;
    const skipped = data.skip !== undefined;
    const result = type === 'test:fail' ? 'failed' : skipped ? 'skipped' : 'ok';
    ++count[result];
    const why = typeof data.skip === 'string' ? `: ${data.skip}` : '';
    yield `${result}  ${data.name}${why}\n`;
    const error = data.details?.error;
    if (result === 'failed') yield `${error?.cause?.stack ?? error?.message ?? error}\n`;
  }
  yield `${count.ok} passed, ${count.failed} failed, ${count.skipped} skipped\n`;
}
