// SPDX-License-Identifier: Apache-2.0
import * as protocol from './protocol.js';

const RATE = 30; // pictures a second, at most
const TURN = 0.005; // a pixel that is dragged [rad]
const KEY_TURN = 1.2; // [rad/s]
const KEYS_TO_CROSS = 4; // seconds to cross the scene
const FIRST_WAIT_MS = 250, LONGEST_WAIT_MS = 800; // until it is tried again to connect
const CODE_BAD_TOKEN = 3, CODE_REFUSED_INPUT = 5;

const element = (id) => document.getElementById(id);
const canvas = element('picture');
const paint = canvas.getContext('2d');

let socket, decoder, codec, welcome, wait = FIRST_WAIT_MS, ended = false;
let token = new URLSearchParams(location.hash.slice(1)).get('token') ?? '';
let input = 0, shown = 0, received = 0, pictures = 0, keyNeeded = true;
const view = { position: [0, 0, 0], yaw: 0, pitch: 0, fov: 0.8 };
const pressed = new Set();
const decodeStart = new Map();

function tell(text, isError = false) {
  element('status').textContent = text;
  element('status').className = isError ? 'error' : '';
}

/// Why this browser shows no pictures; empty: it does.
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

/// What has come and what was decoded: the same, once all has arrived.
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
  send(protocol.received(number, performance.now() - (start?.now ?? performance.now())));
  canvas.dataset.input = start?.input ?? 0;
  for (const known of decodeStart.keys()) if (known <= number) decodeStart.delete(known);
  count();
}

/// A stream that cannot be decoded begins again with a key picture.
function restart(error) {
  tell(`Decoding failed: ${error.message}`, true);
  keyNeeded = true;
  socket?.close();
}

/// A decoder for a stream that begins here. The one before goes on while it has pictures to show.
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

// Connection

function send(bytes) {
  if (socket?.readyState === WebSocket.OPEN) socket.send(bytes);
}

function connect() {
  const scheme = location.protocol === 'https:' ? 'wss:' : 'ws:';
  socket = new WebSocket(`${scheme}//${location.host}/stream`);
  socket.binaryType = 'arraybuffer';
  socket.onopen = () => send(protocol.hello(wantedSize(), RATE, token));
  socket.onmessage = (event) => take(protocol.read(event.data));
  socket.onclose = () => {
    keyNeeded = true;
    decodeStart.clear();
    if (ended) return;
    tell('The connection is lost. Trying again.');
    setTimeout(connect, wait);
    wait = Math.min(2 * wait, LONGEST_WAIT_MS);
  };
}

function take(message) {
  if (message.type === protocol.TYPE.welcome) greet(message);
  if (message.type === protocol.TYPE.picture) decode(message);
  if (message.type === protocol.TYPE.stats) tellNumbers(message);
  if (message.type !== protocol.TYPE.error) return;
  if (message.code === CODE_BAD_TOKEN) {
    ended = true;
    element('token-form').hidden = false;
    tell(token ? `The token was refused: ${message.text}.` : 'This server asks for a token.', Boolean(token));
  } else {
    tell(`The server says: ${message.text}.`, message.code !== CODE_REFUSED_INPUT);
  }
}

function greet(message) {
  const first = !welcome;
  welcome = message;
  wait = FIRST_WAIT_MS;
  tell(message.role === 2 ? 'Connected: you may look and change.' : 'Connected: you may look.');
  element('edits').hidden = message.role !== 2;
  if (first) {
    takeCamera(message.camera);
    offerEdits(message);
  } else {
    sendCamera();
  }
}

function tellNumbers(stats) {
  element('numbers').textContent = `${canvas.width} x ${canvas.height}, picture ${shown}, `
    + `${(stats.bitrate / 1e6).toFixed(1)} Mbit/s, ${stats.roundTripMs.toFixed(0)} ms to here, `
    + `light ${stats.rate.toFixed(1)} times a second, clients ${stats.clients}`;
}

// Camera

/// Rotation by yaw about +Y, then pitch about +X, as a quaternion x, y, z, w.
function rotation() {
  const [sy, cy] = [Math.sin(view.yaw / 2), Math.cos(view.yaw / 2)];
  const [sp, cp] = [Math.sin(view.pitch / 2), Math.cos(view.pitch / 2)];
  return [cy * sp, sy * cp, -sy * sp, cy * cp];
}

function takeCamera(camera) {
  const [x, y, z, w] = camera.rotation;
  view.position = camera.position;
  view.fov = camera.fov;
  // Where the camera's -Z points
  const forward = [-2 * (x * z + w * y), -2 * (y * z - w * x), -(1 - 2 * (x * x + y * y))];
  view.yaw = Math.atan2(-forward[0], -forward[2]);
  view.pitch = Math.asin(Math.max(-1, Math.min(1, forward[1])));
}

function sendCamera() {
  send(protocol.camera(++input, view.position, rotation(), view.fov));
}

let cameraMoved = false;
function turn(yaw, pitch) {
  view.yaw += yaw;
  view.pitch = Math.max(-1.5, Math.min(1.5, view.pitch + pitch));
  cameraMoved = true;
}

/// Along the view, to its right, and up, in shares of the scene's size.
function move(ahead, right, up) {
  const size = Math.hypot(...welcome.max.map((max, i) => max - welcome.min[i]));
  const [sin, cos] = [Math.sin(view.yaw), Math.cos(view.yaw)];
  const level = Math.cos(view.pitch);
  view.position[0] += size * (-sin * level * ahead + cos * right);
  view.position[1] += size * (Math.sin(view.pitch) * ahead + up);
  view.position[2] += size * (-cos * level * ahead - sin * right);
  cameraMoved = true;
}

let lastFrame = performance.now();
function everyFrame(now) {
  const seconds = Math.min(0.1, (now - lastFrame) / 1000);
  lastFrame = now;
  if (welcome) {
    const key = (name) => (pressed.has(name) ? 1 : 0);
    const step = seconds / KEYS_TO_CROSS;
    const [ahead, right, up] = [key('w') - key('s'), key('d') - key('a'), key('e') - key('q')];
    const [yaw, pitch] = [key('arrowleft') - key('arrowright'), key('arrowup') - key('arrowdown')];
    if (ahead || right || up) move(ahead * step, right * step, up * step);
    if (yaw || pitch) turn(yaw * KEY_TURN * seconds, pitch * KEY_TURN * seconds);
    if (cameraMoved) sendCamera();
    cameraMoved = false;
  }
  requestAnimationFrame(everyFrame);
}

canvas.addEventListener('keydown', (event) => {
  const name = event.key.toLowerCase();
  if (event.ctrlKey || event.metaKey || event.altKey) return;
  if (!/^([wasdqe]|arrow(left|right|up|down))$/.test(name)) return;
  pressed.add(name);
  event.preventDefault();
});
canvas.addEventListener('keyup', (event) => pressed.delete(event.key.toLowerCase()));
canvas.addEventListener('blur', () => pressed.clear());
canvas.addEventListener('pointerdown', (event) => canvas.setPointerCapture(event.pointerId));
canvas.addEventListener('pointermove', (event) => {
  if (event.buttons) turn(event.movementX * TURN, event.movementY * TURN);
});
canvas.addEventListener('wheel', (event) => {
  if (welcome) move(-Math.sign(event.deltaY) * 0.02, 0, 0);
  event.preventDefault();
}, { passive: false });
let resizing;
new ResizeObserver(() => {
  clearTimeout(resizing);
  resizing = setTimeout(() => { if (welcome) send(protocol.pictureRequest(wantedSize(), RATE)); }, 300);
}).observe(document.querySelector('main'));

// Edits

const lights = () => welcome.lights.map((light, index) => ({ light, index })).filter(({ light }) => light.type !== 0);

function offerEdits(message) {
  element('sun').hidden = !message.lights.some((light) => light.type === 0);
  element('lamp').hidden = lights().length === 0;
  for (const { index } of lights()) element('light').add(new Option(String(index), String(index)));
  ['x', 'y', 'z'].forEach((axis, i) => {
    element(`light-${axis}`).min = message.min[i];
    element(`light-${axis}`).max = message.max[i];
  });
  showLight();
}

function showLight() {
  const chosen = welcome.lights[Number(element('light').value)];
  if (!chosen) return;
  ['x', 'y', 'z'].forEach((axis, i) => { element(`light-${axis}`).value = chosen.position[i]; });
  element('light-power').value = 1;
}

/// Only what was touched is edited: a lamp need not stand exactly where a slider can be.
function sendLight(edits) {
  const index = Number(element('light').value);
  const chosen = welcome.lights[index];
  const hex = element('light-color').value;
  const linear = [1, 3, 5].map((at) => (parseInt(hex.slice(at, at + 2), 16) / 255) ** 2.2);
  const power = Number(element('light-power').value);
  send(protocol.light(++input, index, edits, {
    position: ['x', 'y', 'z'].map((axis) => Number(element(`light-${axis}`).value)),
    direction: chosen.direction,
    intensity: chosen.intensity.map((value, i) => value * power * linear[i]),
  }));
}

element('hours').addEventListener('input', () => {
  const hours = Number(element('hours').value);
  const minutes = Math.round(hours * 60);
  element('hours-told').textContent =
    `${String(Math.floor(minutes / 60)).padStart(2, '0')}:${String(minutes % 60).padStart(2, '0')}`;
  send(protocol.timeOfDay(++input, hours));
});
element('light').addEventListener('input', showLight);
for (const [edits, names] of [[protocol.EDITS.position, ['x', 'y', 'z']], [protocol.EDITS.intensity, ['power', 'color']]]) {
  for (const name of names) element(`light-${name}`).addEventListener('input', () => sendLight(edits));
}
element('edits').addEventListener('submit', (event) => event.preventDefault());
element('token-form').addEventListener('submit', (event) => {
  event.preventDefault();
  token = element('token').value;
  element('token-form').hidden = true;
  ended = false;
  connect();
});

const missing = obstacle();
if (missing) {
  tell(missing, true);
} else {
  connect();
  requestAnimationFrame(everyFrame);
}
