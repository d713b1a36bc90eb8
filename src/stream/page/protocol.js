// SPDX-License-Identifier: Apache-2.0
// Messages of docs/protocol.md: what a client writes and reads.

export const VERSION = 1;
const MAGIC = 0x54424d4c;
const HEADER_BYTES = 8;
export const TYPE = {
  hello: 1, pictureRequest: 2, camera: 3, received: 4, timeOfDay: 33, light: 35,
  welcome: 65, picture: 66, stats: 68, error: 69,
};
export const EDITS = { position: 1, direction: 2, intensity: 4 };

/// A message of a type, whose fields `write` puts in their order.
function message(type, write) {
  const bytes = [];
  const number = (size, set) => {
    const view = new DataView(new ArrayBuffer(size));
    set(view);
    bytes.push(...new Uint8Array(view.buffer));
  };
  const to = {
    word: (value) => number(4, (view) => view.setUint32(0, value, true)),
    real: (value) => number(4, (view) => view.setFloat32(0, value, true)),
    reals: (values) => values.forEach((value) => to.real(value)),
    text: (value) => {
      const encoded = new TextEncoder().encode(value);
      to.word(encoded.length);
      bytes.push(...encoded);
    },
  };
  write(to);
  const whole = new Uint8Array(HEADER_BYTES + bytes.length);
  const header = new DataView(whole.buffer);
  header.setUint32(0, type, true);
  header.setUint32(4, bytes.length, true);
  whole.set(bytes, HEADER_BYTES);
  return whole;
}

export const hello = (size, rate, token) => message(TYPE.hello, (to) => {
  [MAGIC, VERSION, 1, size.width, size.height].forEach(to.word);
  to.real(rate);
  to.text(token);
});
export const pictureRequest = (size, rate) => message(TYPE.pictureRequest, (to) => {
  to.word(size.width);
  to.word(size.height);
  to.real(rate);
});
export const camera = (input, position, rotation, fov) => message(TYPE.camera, (to) => {
  to.word(input);
  to.reals([...position, ...rotation, fov]);
});
export const timeOfDay = (input, hours) => message(TYPE.timeOfDay, (to) => {
  to.word(input);
  to.real(hours);
});
export const light = (input, index, edits, numbers) => message(TYPE.light, (to) => {
  [input, index, edits].forEach(to.word);
  to.reals([...numbers.position, ...numbers.direction, ...numbers.intensity]);
});
export const received = (picture, decodeMs) => message(TYPE.received, (to) => {
  to.word(picture);
  to.real(decodeMs);
});

/// Reads fields one after the other; throws where there are too few.
class Reader {
  constructor(buffer) {
    this.view = new DataView(buffer);
    this.at = 0;
  }
  word() { this.at += 4; return this.view.getUint32(this.at - 4, true); }
  longWord() { this.at += 8; return Number(this.view.getBigUint64(this.at - 8, true)); }
  real() { this.at += 4; return this.view.getFloat32(this.at - 4, true); }
  reals(count) { return Array.from({ length: count }, () => this.real()); }
  bytes() {
    const size = this.word();
    this.at += size;
    return new Uint8Array(this.view.buffer, this.at - size, size);
  }
}

function readWelcome(from) {
  const told = {
    version: from.word(), role: from.word(), offers: from.word(),
    maxSize: { width: from.word(), height: from.word() }, rate: from.real(),
  };
  from.word();
  told.camera = { position: from.reals(3), rotation: from.reals(4), fov: from.real() };
  told.min = from.reals(3);
  told.max = from.reals(3);
  told.instances = from.word();
  told.lights = Array.from({ length: from.word() }, () => ({
    type: from.word(), intensity: from.reals(3), position: from.reals(3), direction: from.reals(3),
  }));
  return told;
}

const readers = {
  [TYPE.welcome]: readWelcome,
  [TYPE.picture]: (from) => ({
    number: from.word(), key: from.word() === 1, size: { width: from.word(), height: from.word() },
    state: from.longWord(), input: from.word(), renderMs: from.real(), encodeMs: from.real(),
    bytes: from.bytes(),
  }),
  [TYPE.stats]: (from) => ({
    state: from.longWord(), updateMs: from.real(), rate: from.real(), clients: from.word(),
    bitrate: from.word(), roundTripMs: from.real(),
  }),
  [TYPE.error]: (from) => ({ code: from.word(), text: new TextDecoder().decode(from.bytes()) }),
};

/// A message of the server's: its type and its fields; types that are not known here have none.
export function read(buffer) {
  const from = new Reader(buffer);
  const type = from.word();
  from.word();
  const reader = readers[type];
  return { type, ...(reader ? reader(from) : {}) };
}
