// Talks to the program that serves the page.
import {adopt_blocks} from './blocks.js';
import {PageError} from './page_error.js';

const kRetry = 300; // ms until what was refused for another job is asked again
const kRetries = 100;

const pause = (ms) => new Promise((resolve) => setTimeout(resolve, ms));

/// What the server says of a job that was cancelled.
export class Cancelled extends PageError {}

async function ask(name, options) {
  let answer;
  try {
    answer = await fetch(name, {cache: 'no-store', ...options});
  } catch {
    throw new PageError('The program that serves this page does not answer; is it still running?');
  }
  const text = await answer.text();
  let value;
  try {
    value = JSON.parse(text);
  } catch {
    value = {error: text.trim()};
  }
  return {status: answer.status, value};
}

function take({status, value}) {
  if (status >= 400) {
    const Kind = value.cancelled ? Cancelled : PageError;
    throw new Kind(String(value.error).replace(/\.$/, ''));
  }
  return value.blocks ? adopt_blocks(value) : value;
}

export const status = async () => take(await ask('status'));

export const result = async () => take(await ask('result'));

/// \param patient waits while another job runs, which may be that of another window
export async function post(name, body = {}, patient = false) {
  for (let i = 0; ; ++i) {
    const answer = await ask(name, {method: 'POST', body: JSON.stringify(body)});
    const busy = answer.status === 409 && !answer.value.cancelled;
    if (!busy || !patient || i >= kRetries) return take(answer);
    await pause(kRetry);
  }
}
