// SPDX-License-Identifier: Apache-2.0
// The page that renders the server's scene in the light that the server streams.
import * as THREE from 'three';
import { CameraControls } from '../../src/stream/page/camera.js';
import { Connection, tell } from '../../src/stream/page/connection.js';
import { Edits } from '../../src/stream/page/edits.js';
import * as protocol from '../../src/stream/page/protocol.js';
import { FieldLight } from '../lambent-three/field_light.js';
import { LightDecoder } from '../lambent-three/light_decoder.js';
import { LitScene } from './lit_scene.js';

const NO_PICTURES = { width: 16, height: 16 }; // of pictures, of which none are asked for
const NEAR = 1e-4, FAR = 10; // of the camera, in sizes of the scene

const element = (id) => document.getElementById(id);
const canvas = element('picture');

let decoder, field, welcome;
let scene; // undefined: on its way; null: cannot be had
let input = 0, bytes = 0, decodeMs = 0, stale = true, lost = false;
const EDITS = [protocol.TYPE.timeOfDay, protocol.TYPE.sun, protocol.TYPE.light, protocol.TYPE.object];
let waiting = []; // edits that came before the scene, while that is on its way
const eye = new THREE.PerspectiveCamera();
const camera = new CameraControls(canvas);
const connection = new Connection({
  hello: (token) => protocol.hello(protocol.WANTS.light, NO_PICTURES, 1, token), take,
  lost: () => { lost = true; },
});
const edits = new Edits({ send: (message) => connection.send(message), nextInput: () => ++input });

// Messages

function take(message) {
  if (message.type === protocol.TYPE.welcome) greet(message);
  if (message.type === protocol.TYPE.lightUpdate) takeLight(message);
  if (message.type === protocol.TYPE.stats) tellNumbers(message);
  if (EDITS.includes(message.type)) follow(message);
}

function greet(message) {
  edits.offer(message);
  // A server that has started again may have another scene
  if (welcome && !lost) return;
  lost = false;
  if (!welcome) camera.take(message);
  welcome = message;
  scene = undefined;
  waiting = [];
  load(message).catch((error) => {
    if (message === welcome) scene = null;
    tell(error.message, true);
  });
}

async function load(of) {
  const headers = connection.token ? { Authorization: `Bearer ${connection.token}` } : {};
  const answer = await fetch('scene.glb', { headers });
  if (answer.status === 404) throw new Error('This server does not share its scene (lambent serve --share-scene).');
  if (!answer.ok) throw new Error(`The scene cannot be had: ${answer.status} ${answer.statusText}.`);
  const made = await LitScene.make(await answer.arrayBuffer(), of, field);
  if (of !== welcome) return;
  scene = made;
  scene.direct = element('show').value === 'all';
  for (const message of waiting.splice(0)) follow(message);
  stale = true;
}

function follow(message) {
  if (scene === undefined) waiting.push(message);
  if (!scene) return;
  scene.follow(message, (hours) => decoder.sunAt(hours));
  stale = true;
}

function takeLight(message) {
  const start = performance.now();
  try {
    if (decoder.receive(message.bytes)) {
      decoder.follow();
      decodeMs = performance.now() - start;
      if (decoder.probes) field.follow(decoder);
      stale = true;
    }
  } catch (error) {
    // Memory or textures that are too small do not become larger
    connection.end(`Light of this scene cannot be shown here: ${error.message}.`);
    return;
  }
  bytes += message.bytes.length;
  connection.send(protocol.lightReceived(message.update, decoder.geometry, decoder.needsKey));
  canvas.dataset.update = String(decoder.update);
}

function tellNumbers(stats) {
  element('numbers').textContent = `${decoder.probes} probes, update ${decoder.update}, `
    + `${(8e-6 * bytes).toFixed(3)} Mbit/s of light, decoded in ${decodeMs.toFixed(1)} ms, `
    + `light ${stats.rate.toFixed(1)} times a second, clients ${stats.clients}`;
  bytes = 0;
}

// Pictures

function resize(renderer) {
  const width = Math.max(64, canvas.clientWidth), height = Math.round(width * 9 / 16);
  renderer.setPixelRatio(Math.min(devicePixelRatio, 1.5));
  renderer.setSize(width, height, false);
  eye.aspect = width / height;
  stale = true;
}

function render(renderer) {
  eye.position.set(...camera.position);
  eye.quaternion.set(...camera.rotation);
  eye.fov = THREE.MathUtils.radToDeg(camera.fov);
  [eye.near, eye.far] = [NEAR * camera.size, FAR * camera.size];
  eye.updateProjectionMatrix();
  renderer.toneMapping = element('tones').value === 'linear' ? THREE.LinearToneMapping : THREE.ACESFilmicToneMapping;
  renderer.toneMappingExposure = 2 ** Number(element('stops').value);
  renderer.render(scene.scene, eye);
  canvas.dataset.rendered = String(Number(canvas.dataset.rendered ?? 0) + 1);
  canvas.dataset.shown = String(decoder.update);
}

async function begin() {
  const renderer = new THREE.WebGLRenderer({ canvas, antialias: true, preserveDrawingBuffer: true });
  renderer.shadowMap.enabled = true;
  decoder = await LightDecoder.make(await fetch('light_decoder.wasm'));
  field = new FieldLight(decoder.textures.width, renderer.capabilities.maxTextureSize);
  new ResizeObserver(() => resize(renderer)).observe(document.querySelector('main'));
  resize(renderer);
  for (const id of ['show', 'tones', 'stops']) {
    element(id).addEventListener('input', () => {
      if (scene) scene.direct = element('show').value === 'all';
      stale = true;
    });
  }
  element('display').addEventListener('submit', (event) => event.preventDefault());
  connection.open();
  let last = performance.now();
  renderer.setAnimationLoop((now) => {
    camera.step(Math.min(0.1, (now - last) / 1000));
    last = now;
    if (camera.takeMoved()) stale = true;
    // Nothing is drawn that would look like what is there
    if (!stale || !scene || !decoder.probes) return;
    stale = false;
    render(renderer);
  });
}

begin().catch((error) => tell(`This page cannot show light here: ${error.message}`, true));
