// SPDX-License-Identifier: Apache-2.0
// Chromium, where it is, and a test that needs it.
import { existsSync } from 'node:fs';

const SKIPPED = 77;
const NAMES = ['chromium', 'chromium-browser', 'google-chrome'];

export function skip(why) {
  console.log(`skipped: ${why}`);
  process.exit(SKIPPED);
}

/// A headless Chromium, without a GPU. Ends the process with 77 where there is none.
export async function launch(more = []) {
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
  return playwright.chromium.launch({
    executablePath, args: [...sandbox, '--use-angle=swiftshader', '--enable-unsafe-swiftshader', ...more],
  });
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
