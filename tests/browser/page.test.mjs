// SPDX-License-Identifier: Apache-2.0
// usage: page.test.mjs PROGRAM [SCREENSHOT.png]
// The page of lambent serve in Chromium: its pictures are the server's, all that are sent are decoded, and what is
// done by its controls is seen. Exits with 77 where there is no Chromium.
import { accessible, Checks, launch, listen, until } from './chromium.mjs';
import { DISPLAY, FIELD, pngOf, SCENE, Server } from './server.mjs';
import { difference, mean, meansOfElement, meansOfPng } from './pictures.mjs';

const [program, screenshot] = process.argv.slice(2);
const SIZE = { width: 320, height: 180 };
const MARGIN = 16; // of the page, around the picture
const PATIENCE = 60; // with pictures of a view at rest, which a busy machine takes long to render in full [s]
const PICTURE = 66, CAMERA = 3, LIGHT = 35; // types of messages

// Means of blocks, of 255. The codec at its first, coarsest pictures, one ray a pixel and other random numbers were seen
// to make 0.6 in the mean and 5 in the worst block, which an edge of the lamp's cone crosses.
const MOST_MEAN = 2, MOST_WORST = 12;
// How far a key turns the camera [rad]: the room stays in view even where the key is released late.
const TURN = 0.1;
// What is changed must change more than that.
const LEAST_CHANGE = 6;

const checks = new Checks();
const browser = await launch();
// At ten pictures a second, a busy machine of two cores makes them smaller than what they are compared with
const server = new Server(program, ['--size', `${SIZE.width}x${SIZE.height}`, '--rate', '4']);
const url = await server.url();

const page = await browser.newPage({ viewport: { width: SIZE.width + 2 * MARGIN, height: 900 }, deviceScaleFactor: 1 });
const complaints = listen(page);

// What goes over the wire, seen from outside of the page
let sent = 0, lastInput = 0, camera;
const sizes = []; // of pictures, each that is another than that of the one before
page.on('websocket', (socket) => {
  socket.on('framereceived', ({ payload }) => {
    if (payload.readUInt32LE(0) !== PICTURE) return;
    ++sent;
    const size = `${payload.readUInt32LE(16)}x${payload.readUInt32LE(20)}`;
    if (size !== sizes.at(-1)) sizes.push(size);
  });
  socket.on('framesent', ({ payload }) => {
    const type = payload.readUInt32LE(0);
    if (type === CAMERA || type === LIGHT) lastInput = payload.readUInt32LE(8);
    if (type !== CAMERA) return;
    const real = (i) => payload.readFloatLE(12 + 4 * i);
    camera = { position: [0, 1, 2].map(real), rotation: [3, 4, 5, 6].map(real), fov: real(7) };
  });
});
const shown = () => page.locator('#picture').evaluate((canvas) => ({ ...canvas.dataset }));

/// Acts on the page, and waits until it has sent another input to the server.
async function act(action) {
  const before = lastInput;
  await action();
  await until(() => lastInput > before, 'the input to be sent');
}

/// Waits until what was sent last is shown, and pictures are all alike.
async function steady() {
  let before;
  return until(async () => {
    if (Number((await shown()).input) !== lastInput) return null;
    const now = await meansOfElement(page, '#picture');
    const { mean: all, worst } = before ? difference(now, before) : { mean: Infinity };
    before = now;
    if (all < 0.25 && worst < 2) return now;
    await page.waitForTimeout(500);
    return null;
  }, 'pictures that are alike', PATIENCE);
}

/// Waits until nothing more comes, and all that came has been decoded.
async function rest() {
  let before = -1;
  await until(async () => {
    const { pictures } = await shown();
    const still = sent > 0 && sent === before && Number(pictures) === sent;
    before = sent;
    if (!still) await new Promise((resolve) => setTimeout(resolve, 700));
    return still;
  }, 'pictures to come to rest', PATIENCE);
  return meansOfElement(page, '#picture');
}

/// One more picture may still be on its way when the others have come to rest: it is given 5 s.
async function countsAreEqual(when) {
  const end = Date.now() + 5000;
  for (;;) {
    const { received, pictures } = await shown();
    const made = (await server.stats()).pictures;
    const equal = sent > 0 && Number(received) === sent && Number(pictures) === sent && made === sent;
    if (!equal && Date.now() < end) {
      await new Promise((resolve) => setTimeout(resolve, 200));
      continue;
    }
    checks.that(equal,
      `${when}: ${made} pictures made, ${sent} sent, ${received} received, ${pictures} decoded and shown`);
    return;
  }
}

/// The angle of the rotation between two quaternions [rad].
function turn(a, b) {
  return 2 * Math.acos(Math.min(1, Math.abs(a.reduce((sum, value, i) => sum + value * b[i], 0))));
}

/// What the program renders with the server's settings.
async function rendered(more = []) {
  const png = pngOf(program, ['render', SCENE, '--quality', 'interactive', '--size', `${SIZE.width}x${SIZE.height}`,
    ...FIELD, ...DISPLAY, ...more]);
  return meansOfPng(blank, png);
}

function same(found, expected, what) {
  const { mean: all, worst } = difference(found, expected);
  checks.that(all <= MOST_MEAN && worst <= MOST_WORST,
    `${what}: off by ${all.toFixed(2)}, in the worst block by ${worst.toFixed(2)}, of 255`);
}

const blank = await browser.newPage();
const opened = performance.now();
await page.goto(url);
await until(async () => Number((await shown()).pictures) > 0, 'the first picture');
console.log(`first picture after ${(performance.now() - opened).toFixed(0)} ms`);
const first = await rest();
checks.that(mean(first) > 10, `the picture is lit: ${mean(first).toFixed(1)} of 255`);
same(first, await rendered(), 'the first view, against lambent render');
await countsAreEqual('at rest');

await accessible(checks, page);

// The camera, by keys, is where the page says that it is
await page.locator('#picture').focus();
let begin;
await page.keyboard.down('ArrowLeft');
await until(() => {
  begin ??= camera;
  return begin && turn(begin.rotation, camera.rotation) > TURN;
}, 'another view');
await page.keyboard.up('ArrowLeft');
await act(() => page.keyboard.press('w', { delay: 200 }));
const turned = await steady();
checks.that(difference(first, turned).mean > LEAST_CHANGE, 'keys turn and move the camera');
const [x, y, z, w] = camera.rotation;
const ahead = [-2 * (x * z + w * y), -2 * (y * z - w * x), -(1 - 2 * (x * x + y * y))];
const target = camera.position.map((value, i) => value + ahead[i]);
same(turned, await rendered(['--eye', camera.position.join(), '--target', target.join(),
  '--fov', String((camera.fov * 180) / Math.PI)]), 'the view after that, against lambent render');

// A lamp that is dimmed and moved by its sliders
const brightness = page.getByLabel('Brightness');
await brightness.focus();
await act(() => brightness.fill('0.25'));
await act(() => page.keyboard.press('ArrowLeft'));
const share = Number(await brightness.inputValue());
const dimmed = await steady();
checks.that(share < 0.25 && mean(dimmed) < 0.8 * mean(turned), `dimmed to ${share} the room is darker`);
await act(() => brightness.fill('1'));
same(await steady(), turned, 'the lamp at its brightness again, against before');
const lampX = page.getByLabel('X', { exact: true });
const [at, least] = await lampX.evaluate((input) => [Number(input.value), Number(input.min)]);
await act(() => lampX.fill(String(at + 0.5 * (least - at))));
checks.that(difference(turned, await steady()).mean > LEAST_CHANGE, 'the lamp moves');
await rest();
await countsAreEqual('after all that');

// Another size in the middle of the stream
const seen = sizes.length;
await page.setViewportSize({ width: 2 * MARGIN + SIZE.width / 2, height: 900 });
await until(() => sizes.length > seen, 'pictures of another size');
await rest();
const canvas = await page.locator('#picture').evaluate(({ width, height }) => `${width}x${height}`);
checks.that(sizes.at(-1) === canvas, `the picture has another size: ${sizes.join(', ')}`);
await countsAreEqual('after another size');

checks.that(complaints.length === 0, `the console is silent ${complaints.join('; ')}`);
if (screenshot) {
  await page.setViewportSize({ width: SIZE.width + 2 * MARGIN, height: 600 });
  await rest();
  await page.screenshot({ path: screenshot });
}
await browser.close();
checks.that((await server.end('SIGTERM')) === 0, 'the server ends as it should');
checks.end();
