// SPDX-License-Identifier: Apache-2.0
// usage: light.test.mjs PROGRAM [SCREENSHOT.png]
// The page /light of lambent serve in Chromium, with WebGL by its processor: what it renders in the streamed light is what
// lambent render makes of the same view, and follows edits. Exits with 77 where there is no Chromium.
import { accessible, Checks, launch, listen, until, WEBGL } from './chromium.mjs';
import { difference, mean, meansOfElement, meansOfPng } from './pictures.mjs';
import { DISPLAY, FIELD, layerOf, pngOf, SCENE, Server } from './server.mjs';

const [program, screenshot] = process.argv.slice(2);
const SIZE = { width: 320, height: 180 };
const MARGIN = 16; // of the page, around the picture

// Means of blocks, of 255. Streamed light is rounded to 1 % of the mean irradiance, and to what a texture holds; the sky,
// the light's cone and shadows are three.js's own. Seen were 0.2 and 2.4; 0.6 and 11, at the cone's edge; 0.3 and 7.
const MOST_STREAMED = { mean: 1, worst: 6 };
const MOST_ALL = { mean: 2, worst: 20 };
const MOST_AGAIN = { mean: 1, worst: 14 }; // while the last of the change still settles
const LEAST_CHANGE = 6;

const checks = new Checks();
const browser = await launch(WEBGL);
// A finer volume, turned, in a corner of the box, which fades into the other
const VOLUME = ['--volume', '2,0.3,2,5,3,5:probes=4x4x4:turn=20:priority=1'];
const server = new Server(program, [...VOLUME, '--share-scene', '--rate', '10', '--size', `${SIZE.width}x${SIZE.height}`]);
const url = await server.url();
const page = await browser.newPage({ viewport: { width: SIZE.width + 2 * MARGIN, height: 900 }, deviceScaleFactor: 1 });
const complaints = listen(page);
const blank = await browser.newPage();

const data = () => page.locator('#picture').evaluate((canvas) => ({ ...canvas.dataset }));

/// Waits until pictures are all alike, of the latest light.
async function steady() {
  let before;
  return until(async () => {
    const { rendered, update, shown } = await data();
    if (!rendered || update !== shown) return null;
    const now = await meansOfElement(page, '#picture');
    const { mean: all, worst } = before ? difference(now, before) : { mean: Infinity };
    before = now;
    if (all < 0.25 && worst < 2) return now;
    await page.waitForTimeout(400);
    return null;
  }, 'pictures that are alike');
}

function same(found, expected, most, what) {
  const { mean: all, worst } = difference(found, expected);
  checks.that(all <= most.mean && worst <= most.worst,
    `${what}: off by ${all.toFixed(2)}, in the worst block by ${worst.toFixed(2)}, of 255`);
}

const render = ['render', SCENE, '--method', 'field', '--without', 'gather,glossy', '--size',
  `${SIZE.width}x${SIZE.height}`, '--samples', '4', ...FIELD, ...VOLUME];

await page.goto(`${url}light`);
await until(async () => (await data()).rendered, 'the first picture');
await page.getByLabel('Tones').selectOption('Linear');
const all = await steady();
checks.that(mean(all) > 10, `the picture is lit: ${mean(all).toFixed(1)} of 255`);
same(all, await meansOfPng(blank, pngOf(program, [...render, ...DISPLAY])), MOST_ALL, 'all light, against lambent render');
await page.getByLabel('Show').selectOption('Streamed light alone');
const streamed = await steady();
checks.that(mean(streamed) > 5, `streamed light is seen: ${mean(streamed).toFixed(1)} of 255`);
same(streamed, await meansOfPng(blank, layerOf(program, render, 'indirect', DISPLAY)), MOST_STREAMED,
  'streamed light alone, against its layer of lambent render');

await accessible(checks, page);

// Edits reach the server, and come back as light
await page.getByLabel('Brightness').fill('0.25');
await until(async () => difference(streamed, await meansOfElement(page, '#picture')).mean > LEAST_CHANGE, 'dimmed light');
await page.getByLabel('Brightness').fill('1');
same(await steady(), streamed, MOST_AGAIN, 'the lamp at its brightness again, against before');
await page.getByLabel('Show').selectOption('All light');
await steady();
const lampX = page.getByLabel('X', { exact: true });
const [at, least] = await lampX.evaluate((input) => [Number(input.value), Number(input.min)]);
await lampX.fill(String(at + 0.5 * (least - at)));
const moved = await steady();
checks.that(difference(all, moved).mean > LEAST_CHANGE, 'the lamp moves');

// The camera is this page's own
await page.locator('#picture').focus();
await page.keyboard.down('ArrowLeft');
await until(async () => difference(moved, await meansOfElement(page, '#picture')).mean > LEAST_CHANGE, 'another view');
await page.keyboard.up('ArrowLeft');
checks.that(difference(moved, await steady()).mean > LEAST_CHANGE, 'keys turn the camera');

checks.that(complaints.length === 0, `the console is silent ${complaints.join('; ')}`);
if (screenshot) await page.screenshot({ path: screenshot });
await browser.close();
checks.that((await server.end('SIGTERM')) === 0, 'the server ends as it should');
checks.end();
