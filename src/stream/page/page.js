// SPDX-License-Identifier: Apache-2.0
import { CameraControls } from './camera.js';
import { Connection, tell } from './connection.js';
import { Edits } from './edits.js';
import * as protocol from './protocol.js';

const RATE = 30; // maximum pictures per second
const SEND_MS = 15; // least time between two cameras; servers accept 200 messages per second
const DECODE_SECONDS = 5; // until a stream begins anew whose decoder shows nothing of what it was given

const element = (id) => document.getElementById(id);
const canvas = element('picture');
const paint = canvas.getContext('2d');

let decoder, codec, welcome;
let input = 0, shown = 0, received = 0, pictures = 0, keyNeeded = true;
const decodeStart = new Map();
const camera = new CameraControls(canvas);
const connection = new Connection({
  hello: (token) => protocol.hello(protocol.WANTS.pictures, wantedSize(), RATE, token), take, lost,
});
const edits = new Edits({ send: (bytes) => connection.send(bytes), nextInput: () => ++input });

/// The reason why this browser cannot show pictures; empty if it can.
function obstacle() {
  if (!window.isSecureContext) {
    return 'Browsers decode video streams on secure pages only: open this page over https, or as localhost on the '
      + 'machine that serves it (for example through ssh -L 8080:localhost:8080).';
  }
  if (!('VideoDecoder' in window)) {
    return 'This browser has no WebCodecs (VideoDecoder). Chrome and Edge 94, Safari 16.4, Firefox 130 and later do.';
  }
  return '';
}

function wantedSize() {
  const width = Math.max(64, Math.round(canvas.clientWidth * Math.min(devicePixelRatio, 1.5)));
  return { width: Math.min(width, 1280), height: Math.min(Math.max(36, Math.round(width * 9 / 16)), 720) };
}

// Decoding

/// "avc1." and profile, constraints and level, as the parameter set in front of key pictures has them.
function codecOf(bytes) {
  for (let i = 0; i + 7 < bytes.length; ++i) {
    if (bytes[i] || bytes[i + 1] || bytes[i + 2] !== 1 || (bytes[i + 3] & 31) !== 7) continue;
    return 'avc1.' + [4, 5, 6].map((k) => bytes[i + k].toString(16).padStart(2, '0')).join('');
  }
  return 'avc1.42e034';
}

/// Publishes the numbers of received and decoded pictures, which are equal once all are decoded.
function count() {
  Object.assign(canvas.dataset, { received, pictures });
}

function show(frame) {
  const number = frame.timestamp;
  if (canvas.width !== frame.displayWidth || canvas.height !== frame.displayHeight) {
    canvas.width = frame.displayWidth;
    canvas.height = frame.displayHeight;
  }
  paint.drawImage(frame, 0, 0);
  frame.close();
  ++pictures;
  shown = number;
  const start = decodeStart.get(number);
  connection.send(protocol.received(number, performance.now() - (start?.now ?? performance.now())));
  canvas.dataset.input = start?.input ?? 0;
  for (const known of decodeStart.keys()) if (known <= number) decodeStart.delete(known);
  count();
}

/// Restarts a stream that cannot be decoded, with a key picture.
function restart(error) {
  tell(`Decoding failed: ${error.message}`, true);
  keyNeeded = true;
  connection.again();
}

let waitsFor, waited = 0;

/// Restarts a stream whose decoder neither shows a picture nor reports an error. It counts calls and does not read the
/// clock, as a page that sleeps is not called.
function watchDecoder() {
  const [oldest] = decodeStart.keys();
  waited = oldest !== undefined && oldest === waitsFor ? waited + 1 : 0;
  waitsFor = oldest;
  if (waited < DECODE_SECONDS) return;
  waited = 0;
  restart(new Error(`no picture for ${DECODE_SECONDS} s`));
}
setInterval(watchDecoder, 1000);

/// Creates a decoder for a new stream. The previous one continues while it has pictures to show.
function beginDecoding(wanted) {
  const before = decoder;
  if (before?.state === 'configured') before.flush().then(() => before.close(), () => {});
  const own = new VideoDecoder({ output: show, error: (error) => { if (own === decoder) restart(error); } });
  own.configure({ codec: wanted, optimizeForLatency: true });
  [decoder, codec] = [own, wanted];
}

function decode(picture) {
  ++received;
  count();
  if (picture.key) {
    const wanted = codecOf(picture.bytes);
    if (keyNeeded || decoder.state !== 'configured' || wanted !== codec) beginDecoding(wanted);
    keyNeeded = false;
  }
  if (keyNeeded || decoder.state !== 'configured') return;
  decodeStart.set(picture.number, { now: performance.now(), input: picture.input });
  decoder.decode(new EncodedVideoChunk({
    type: picture.key ? 'key' : 'delta', timestamp: picture.number, data: picture.bytes,
  }));
}

// Messages

function lost() {
  keyNeeded = true;
  decodeStart.clear();
}

function take(message) {
  if (message.type === protocol.TYPE.welcome) greet(message);
  if (message.type === protocol.TYPE.picture) decode(message);
  if (message.type === protocol.TYPE.stats) tellNumbers(message);
}

function greet(message) {
  const first = !welcome;
  welcome = message;
  edits.offer(message);
  if (first) {
    camera.take(message);
  } else {
    sendCamera();
  }
}

function tellNumbers(stats) {
  element('numbers').textContent = `${canvas.width} x ${canvas.height}, picture ${shown}, `
    + `${(stats.bitrate / 1e6).toFixed(1)} Mbit/s, ${stats.roundTripMs.toFixed(0)} ms to here, `
    + `light ${stats.rate.toFixed(1)} times a second, clients ${stats.clients}`;
}

let lastSent = -SEND_MS;
function sendCamera() {
  lastSent = performance.now();
  connection.send(protocol.camera(++input, camera.position, camera.rotation, camera.fov));
}

let lastFrame = performance.now();
function everyFrame(now) {
  const seconds = Math.min(0.1, (now - lastFrame) / 1000);
  lastFrame = now;
  camera.step(seconds);
  if (camera.takeMoved()) sendCamera();
  requestAnimationFrame(everyFrame);
}

// Send movements by mouse and touch at once, not with the next frame of the screen
camera.onmove = () => {
  if (performance.now() - lastSent >= SEND_MS && camera.takeMoved()) sendCamera();
};

let resizing;
new ResizeObserver(() => {
  clearTimeout(resizing);
  resizing = setTimeout(() => {
    if (welcome) connection.send(protocol.pictureRequest(wantedSize(), RATE));
  }, 300);
}).observe(document.querySelector('main'));

const missing = obstacle();
if (missing) {
  tell(missing, true);
} else {
  connection.open();
  requestAnimationFrame(everyFrame);
}
