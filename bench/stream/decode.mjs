// SPDX-License-Identifier: Apache-2.0
// usage: decode.mjs LIGHT_DECODER.wasm RECORDING
// Times of the light decoder in WebAssembly, for a recording of `lambent_light_stream record`.
import { readFileSync } from 'node:fs';
import { readRecording } from '../../tests/browser/recording.mjs';
import { LightDecoder } from '../../web/lambent-three/light_decoder.js';

const KIND_AT = 6; // offset in a message, docs/stream-light.md
const KINDS = ['', 'geometry', 'key', 'delta'];
const REPETITIONS = 5; // the first ones compile

const [wasm, file] = process.argv.slice(2);
const bytes = readFileSync(wasm);
const messages = readRecording(file);
const rows = new Map();
for (let repetition = 0; repetition < REPETITIONS; ++repetition) {
  const decoder = await LightDecoder.make(bytes);
  for (const { bytes: message, checksum } of messages) {
    const start = performance.now();
    if (!decoder.receive(message)) throw new Error(decoder.error);
    const decoded = performance.now();
    decoder.follow();
    const followed = performance.now();
    if (decoder.checksum !== checksum) throw new Error('the state is not the library\'s');
    if (repetition < 2) continue;
    const kind = KINDS[message[KIND_AT]];
    if (!rows.has(kind)) rows.set(kind, { bytes: [], decode: [], textures: [] });
    const row = rows.get(kind);
    row.bytes.push(message.length);
    row.decode.push(decoded - start);
    row.textures.push(followed - decoded);
  }
  decoder.close();
}

const at = (values, share) => [...values].sort((a, b) => a - b)[Math.floor(share * (values.length - 1))];
console.log(`### Decoding in WebAssembly, node ${process.version}, ${messages.length} messages`);
console.log('| message | bytes, median | decode: median, 95 % [ms] | textures: median, 95 % [ms] |\n|---|---|---|---|');
for (const [kind, { bytes: sizes, decode, textures }] of rows) {
  const pair = (values) => `${at(values, 0.5).toFixed(2)}, ${at(values, 0.95).toFixed(2)}`;
  console.log(`| ${kind} | ${at(sizes, 0.5)} | ${pair(decode)} | ${pair(textures)} |`);
}
