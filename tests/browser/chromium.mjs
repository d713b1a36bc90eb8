// SPDX-License-Identifier: Apache-2.0
// Chromium, where it is, and a test that needs it.
import { existsSync } from 'node:fs';

const SKIPPED = 77;
const NAMES = ['chromium', 'chromium-browser', 'google-chrome'];

export function skip(why) {
  console.log(`skipped: ${why}`);
  process.exit(SKIPPED);
}

/// WebGL by the processor, for launch().
export const WEBGL = ['--use-angle=swiftshader', '--enable-unsafe-swiftshader'];

/// A headless Chromium, without a GPU. Ends the process with 77 where there is none.
export async function launch(options = ['--disable-gpu']) {
  let playwright;
  try {
    playwright = await import('playwright-core');
  } catch (error) {
    skip(`npm package playwright-core is not installed (npm ci in tests/browser): ${error.message}`);
  }
  const folders = (process.env.PATH ?? '').split(':');
  const found = NAMES.flatMap((name) => folders.map((folder) => `${folder}/${name}`)).find(existsSync);
  const executablePath = process.env.LAMBENT_CHROMIUM || found;
  if (!executablePath) skip('there is no Chromium (LAMBENT_CHROMIUM names one that is not in PATH)');
  // Root, which tests are in containers, has no sandbox
  const sandbox = process.getuid() === 0 ? ['--no-sandbox'] : [];
  return playwright.chromium.launch({ executablePath, args: [...sandbox, ...options] });
}

/// Asserts, each with what is asserted.
export class Checks {
  failures = 0;

  that(fine, what) {
    console.log(`${fine ? 'ok  ' : 'FAIL'} ${what}`);
    if (!fine) ++this.failures;
  }

  /// Ends the process.
  end() {
    console.log(this.failures ? `${this.failures} failures` : 'all fine');
    process.exit(this.failures ? 1 : 0);
  }
}

/// Asks `what` until it says yes; throws after a while.
export async function until(what, description, seconds = 20) {
  const end = performance.now() + 1000 * seconds;
  for (;;) {
    const answer = await what();
    if (answer) return answer;
    if (performance.now() > end) throw new Error(`in vain waited ${seconds} s for ${description}`);
    await new Promise((resolve) => setTimeout(resolve, 20));
  }
}

/// Collects what a page complains of in its console.
export function listen(page) {
  const complaints = [];
  page.on('console', (message) => { if (message.type() === 'error') complaints.push(message.text()); });
  page.on('pageerror', (error) => complaints.push(error.message));
  page.on('requestfailed', (request) => complaints.push(`${request.url()} failed`));
  return complaints;
}

/// A page's landmarks, names and keyboard.
export async function accessible(checks, page) {
  const snapshot = await page.locator('body').ariaSnapshot();
  checks.that(/main/.test(snapshot) && /heading "Lambent.*" \[level=1\]/.test(snapshot) && /status/.test(snapshot),
    'there is a landmark, a heading and a status');
  checks.that(await page.evaluate(() => document.documentElement.lang === 'en' && document.title !== ''),
    'the page has a language and a title');
  const unnamed = await page.evaluate(() => [...document.querySelectorAll('input, select, button, output')]
    .filter((one) => one.checkVisibility() && ![...(one.labels ?? [])].some((label) => label.innerText.trim()))
    .map((one) => one.id));
  checks.that(unnamed.length === 0, `every control has a label${unnamed.map((id) => ` but ${id}`)}`);
  const focusable = await page.evaluate(() => [...document.querySelectorAll('#picture, input, select, button, a')]
    .filter((one) => one.checkVisibility()).map((one) => one.id || one.pathname));
  const reached = [];
  await page.evaluate(() => document.activeElement.blur());
  for (let i = 0; i < focusable.length + 2; ++i) {
    await page.keyboard.press('Tab');
    reached.push(await page.evaluate(() => document.activeElement.id || document.activeElement.pathname));
  }
  checks.that(focusable.every((id) => reached.includes(id)), `the keyboard reaches ${focusable.join(', ')}`);
  await page.locator('#picture').focus();
  checks.that(await page.locator('#picture').evaluate((canvas) => getComputedStyle(canvas).outlineStyle !== 'none'),
    'the focus is visible');
}
