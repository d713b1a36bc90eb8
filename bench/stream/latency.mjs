// SPDX-License-Identifier: Apache-2.0
// usage: latency.mjs PROGRAM [INPUTS [SCENE]]
// The time from an input in the browser until the first picture that shows it has been decoded,
// with `lambent serve` and Chromium on this machine, 640x360. Needs npm ci in tests/browser.
import { launch, until } from '../../tests/browser/chromium.mjs';
import { Server } from '../../tests/browser/server.mjs';

const MARGIN = 16; // of the page around the picture
const [program, inputs = '300', scene] = process.argv.slice(2);

/// Runs in the page: turns the wheel at random times and records the times of events.
async function measure(count) {
  const canvas = document.querySelector('#picture');
  const inputs = [];
  let waiting;
  new MutationObserver(() => {
    const now = performance.now(), shown = Number(canvas.dataset.input);
    for (const input of inputs) if (input.number && input.number <= shown) input.ms ??= now - input.at;
  }).observe(canvas, { attributes: true, attributeFilter: ['data-input'] });
  window.onInput = (number) => { if (waiting) [waiting.number, waiting] = [number, undefined]; };
  for (let i = 0; i < count; ++i) {
    waiting = { at: performance.now() };
    inputs.push(waiting);
    canvas.dispatchEvent(new WheelEvent('wheel', { deltaY: i % 2 ? 1 : -1, cancelable: true }));
    await new Promise((resolve) => setTimeout(resolve, 150 + 300 * Math.random()));
  }
  await new Promise((resolve) => setTimeout(resolve, 2000));
  return { inputs, pictures: window.pictures, size: [canvas.width, canvas.height] };
}

/// Runs in the page before its own scripts: records sent inputs and received pictures
/// (docs/protocol.md).
function watch() {
  const CAMERA = 3, PICTURE = 66;
  window.pictures = [];
  const send = WebSocket.prototype.send;
  WebSocket.prototype.send = function sendAndTell(bytes) {
    const view = new DataView(bytes.buffer);
    if (view.getUint32(0, true) === CAMERA) window.onInput?.(view.getUint32(8, true));
    send.call(this, bytes);
  };
  const Original = window.WebSocket;
  window.WebSocket = class extends Original {
    constructor(url) {
      super(url);
      this.addEventListener('message', ({ data }) => {
        const view = new DataView(data);
        if (view.getUint32(0, true) !== PICTURE) return;
        const [render, encode] = [36, 40].map((at) => view.getFloat32(at, true));
        window.pictures.push({ at: performance.now(), input: view.getUint32(32, true), render, encode });
      });
    }
  };
}

const server = new Server(program, ['--size', '640x360', '--quality', 'draft', '--rate', '5'], 0, scene);
const browser = await launch();
const page = await browser.newPage({ viewport: { width: 640 + 2 * MARGIN, height: 900 }, deviceScaleFactor: 1 });
await page.addInitScript(watch);
await page.goto(await server.url());
await until(() => page.locator('#picture').evaluate((canvas) => Number(canvas.dataset.pictures) > 20), 'pictures');
await page.evaluate(() => { window.pictures.length = 0; });
const found = await page.evaluate(measure, Number(inputs));
await browser.close();
await server.end('SIGTERM');

const at = (values, share) => [...values].sort((a, b) => a - b)[Math.round(share * (values.length - 1))];
const seen = found.inputs.filter((input) => input.ms !== undefined);
const ms = seen.map((input) => input.ms);
// The number of pictures after an input until the one that shows it: load affects their time, not
// their number
const which = seen.map(({ at: from, number }) =>
  found.pictures.filter((picture) => picture.at >= from).findIndex((picture) => picture.input >= number) + 1);
const share = (most) => ((100 * which.filter((one) => one <= most).length) / which.length).toFixed(1);
const [render, encode] = ['render', 'encode'].map((what) => at(found.pictures.map((picture) => picture[what]), 0.5));
const gaps = found.pictures.slice(1).map((picture, i) => picture.at - found.pictures[i].at);
const frame = at(gaps, 0.5);
console.log(`### Input to decoded picture, ${found.size.join('x')} in the end, ${found.inputs.length} inputs, `
  + `${found.inputs.length - seen.length} never seen`);
console.log('| input to decoded picture: median, 95 %, largest [ms] | from picture to picture, median [ms] | '
  + 'rendered, encoded, median [ms] | two pictures and encoding [ms] | shown by the first, second, third picture at the latest [%] '
  + '|\n|---|---|---|---|---|');
console.log(`| ${[0.5, 0.95, 1].map((part) => at(ms, part).toFixed(0)).join(', ')} | ${frame.toFixed(0)} | `
  + `${render.toFixed(1)}, ${encode.toFixed(1)} | ${(2 * frame + encode).toFixed(0)} | ${[1, 2, 3].map(share).join(', ')} |`);
