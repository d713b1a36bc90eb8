// SPDX-License-Identifier: Apache-2.0
// usage: faults.test.mjs PROGRAM
// The page of lambent serve in Chromium, where pictures are broken, the page sleeps, and the server is killed and starts
// again: each time pictures go on. Exits with 77 where there is no Chromium.
import { Checks, launch, listen, until, WEBGL } from './chromium.mjs';
import { Server } from './server.mjs';

const [program] = process.argv.slice(2);
const PICTURE = 66, PICTURE_BYTES_AT = 48; // docs/protocol.md
const AGAIN_MS = 1000; // until a page is connected again with a server that has started again
const SETTINGS = ['--size', '160x90', '--rate', '10'];

const checks = new Checks();
const browser = await launch(WEBGL);
let server = new Server(program, SETTINGS);
const port = await server.started;
const url = await server.url();
const page = await browser.newPage({ viewport: { width: 192, height: 700 }, deviceScaleFactor: 1 });

let connections = 0, breaks = false; // all pictures of a connection: a key picture would mend what one has broken
await page.routeWebSocket(/stream$/, (socket) => {
  ++connections;
  breaks = false;
  const upstream = socket.connectToServer();
  upstream.onMessage((message) => {
    if (breaks && message.readUInt32LE(0) === PICTURE) {
      message = Buffer.from(message);
      message.fill(0xa5, PICTURE_BYTES_AT);
    }
    socket.send(message);
  });
});
const pictures = async () => Number(await page.locator('#picture').evaluate((canvas) => canvas.dataset.pictures ?? 0));
const status = () => page.locator('#status').textContent();

/// Looks elsewhere, and waits until that is seen.
async function goesOn(what) {
  const before = await pictures();
  await page.locator('#picture').focus();
  await until(async () => {
    await page.keyboard.press('ArrowLeft', { delay: 60 });
    return (await pictures()) > before + 3;
  }, `pictures ${what}`);
  checks.that((await status()).startsWith('Connected'), `${what}, pictures go on`);
}

// A decoder that is deaf takes pictures, and neither shows them nor complains
await page.addInitScript(() => {
  const { decode } = VideoDecoder.prototype;
  const deaf = new WeakSet();
  let last;
  VideoDecoder.prototype.decode = function decodeUnlessDeaf(chunk) {
    last = this;
    if (!deaf.has(this)) decode.call(this, chunk);
  };
  window.deafen = () => deaf.add(last);
});
await page.goto(url);
await goesOn('at first');

breaks = true;
await page.keyboard.press('ArrowRight', { delay: 60 });
await until(() => connections === 2, 'another connection');
await goesOn('after broken pictures');

const sleep = await page.context().newCDPSession(page);
await sleep.send('Page.setWebLifecycleState', { state: 'frozen' });
await new Promise((resolve) => setTimeout(resolve, 1500));
await sleep.send('Page.setWebLifecycleState', { state: 'active' });
await goesOn('after it slept');
checks.that(connections === 2, 'sleep costs no connection');

await page.evaluate(() => window.deafen());
await page.keyboard.press('ArrowRight', { delay: 60 });
await until(() => connections === 3, 'another connection with a decoder that hears');
await goesOn('after its decoder swallowed pictures');

await server.end('SIGKILL');
await until(async () => (await status()).includes('lost'), 'word of the loss');
await new Promise((resolve) => setTimeout(resolve, 2500)); // by then it waits longest
server = new Server(program, SETTINGS, port);
await server.started;
const start = performance.now();
await until(async () => (await status()).startsWith('Connected'), 'another connection');
const took = performance.now() - start;
checks.that(took < AGAIN_MS, `connected again ${took.toFixed(0)} ms after the server started again`);
await goesOn('after the server was killed');

// A page of light where the scene is not shared says so; where it is not built, there is none
const light = await browser.newPage();
const complaints = listen(light);
if ((await light.goto(`${url}light`)).ok()) {
  await until(async () => (await light.locator('#status').textContent()).includes('--share-scene'), 'the reason');
  checks.that(complaints.every((one) => one.includes('404')), 'the page of light tells that the scene is not shared');
}

await browser.close();
checks.that((await server.end('SIGTERM')) === 0, 'the server ends as it should');
checks.end();
