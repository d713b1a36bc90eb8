// SPDX-License-Identifier: Apache-2.0
// usage: decoder.test.mjs LIGHT_DECODER.wasm RECORDING
// The light decoder in WebAssembly has the library's state after every message of a recording
// (bench/stream/recording.h), bit for bit, and survives messages that are none.
import { readFileSync } from 'node:fs';
import { LightDecoder } from '../../web/lambent-three/light_decoder.js';
import { Checks } from './chromium.mjs';
import { readRecording } from './recording.mjs';

const [wasm, file] = process.argv.slice(2);
const decoder = await LightDecoder.make(readFileSync(wasm));
const messages = readRecording(file);
const checks = new Checks();
checks.that(decoder.needsKey && decoder.probes === 0 && decoder.update === 0n, 'there is no light at first');

let same = 0;
for (const { bytes, checksum } of messages) {
  if (!decoder.receive(bytes)) checks.that(false, `a message is refused: ${decoder.error}`);
  decoder.follow();
  if (decoder.checksum === checksum) ++same;
}
checks.that(messages.length > 0 && same === messages.length,
  `after ${same} of ${messages.length} messages the state is the library's`);
const { width, texels, irradiance, distances, places } = decoder.textures;
checks.that(decoder.probes > 0 && decoder.grids.length === 2 && decoder.grids[1].first > 0
  && decoder.grids[0].count.every((count) => count === 5), `${decoder.probes} probes in two volumes`);
checks.that(irradiance.length % width === 0 && irradiance.some((word) => word !== 0)
  && distances.length % width === 0 && texels.join() === '4,14' && places.length === 4 * width, 'textures have light');

// What nobody's server sends
const before = decoder.checksum;
const last = messages.at(-1).bytes;
const broken = last.slice();
broken[broken.length - 1] ^= 1;
for (const [bytes, what] of [[broken, 'broken'], [last, 'sent again'], [last.slice(0, 20), 'cut short'],
  [new Uint8Array(0), 'empty'], [crypto.getRandomValues(new Uint8Array(5000)), 'random']]) {
  checks.that(!decoder.receive(bytes) && decoder.error !== '' && decoder.checksum === before,
    `a message is refused that is ${what}: ${decoder.error}`);
}
checks.that(Math.abs(decoder.sunAt(12).direction[1] + Math.SQRT1_2) < 1e-5 && decoder.sunAt(0).share === 0,
  'the sun is high at noon, and gone at night');
decoder.close();
checks.end();
