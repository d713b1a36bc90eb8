// SPDX-License-Identifier: Apache-2.0
// Writes and reads a client's messages of docs/protocol.md.

export const VERSION = 1;
const MAGIC = 0x54424d4c;
const HEADER_BYTES = 8;
export const TYPE = {
  hello: 1, pictureRequest: 2, camera: 3, received: 4, lightReceived: 5, timeOfDay: 33, sun: 34, light: 35, object: 36,
  welcome: 65, picture: 66, lightUpdate: 67, stats: 68, error: 69,
};
export const WANTS = { pictures: 1, light: 2 };
export const CODE = { badToken: 3, refusedInput: 5 };
export const LIGHT_KIND = { geometry: 1, key: 2, delta: 3, regions: 6, corrections: 7 };
export const EDITS = { position: 1, direction: 2, intensity: 4 };

/// A message of a type; `write` writes its fields in order.
function message(type, write) {
  const bytes = [];
  const number = (size, set) => {
    const view = new DataView(new ArrayBuffer(size));
    set(view);
    bytes.push(...new Uint8Array(view.buffer));
  };
  const to = {
    word: (value) => number(4, (view) => view.setUint32(0, value, true)),
    longWord: (value) => number(8, (view) => view.setBigUint64(0, value, true)),
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

export const hello = (wants, size, rate, token) => message(TYPE.hello, (to) => {
  [MAGIC, VERSION, wants, size.width, size.height].forEach(to.word);
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

/// `update` and `geometry` are BigInts.
export const lightReceived = (update, geometry, needsKey) => message(TYPE.lightReceived, (to) => {
  to.longWord(update);
  to.longWord(geometry);
  to.word(needsKey ? 1 : 0);
});

/// Reads fields one after the other; throws where there are too few.
class Reader {
  constructor(buffer) {
    this.view = new DataView(buffer);
    this.at = 0;
  }
  word() { this.at += 4; return this.view.getUint32(this.at - 4, true); }
  longWord() { this.at += 8; return this.view.getBigUint64(this.at - 8, true); }
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
    state: Number(from.longWord()), input: from.word(), renderMs: from.real(), encodeMs: from.real(),
    bytes: from.bytes(),
  }),
  [TYPE.stats]: (from) => ({
    state: Number(from.longWord()), updateMs: from.real(), rate: from.real(), clients: from.word(),
    bitrate: from.word(), roundTripMs: from.real(),
  }),
  [TYPE.timeOfDay]: (from) => ({ input: from.word(), hours: from.real() }),
  [TYPE.sun]: (from) => ({ input: from.word(), direction: from.reals(3) }),
  [TYPE.light]: (from) => ({
    input: from.word(), light: from.word(), edits: from.word(), position: from.reals(3), direction: from.reals(3),
    intensity: from.reals(3),
  }),
  [TYPE.object]: (from) => ({ input: from.word(), instance: from.word(), axes: from.reals(9), position: from.reals(3) }),
  [TYPE.lightUpdate]: (from) => ({
    kind: from.word(), update: from.longWord(), time: from.real(), bytes: from.bytes(),
  }),
  [TYPE.error]: (from) => ({ code: from.word(), text: new TextDecoder().decode(from.bytes()) }),
};

/// Reads a message of the server: its type and its fields. Unknown types have no fields.
export function read(buffer) {
  const from = new Reader(buffer);
  const type = from.word();
  from.word();
  const reader = readers[type];
  return { type, ...(reader ? reader(from) : {}) };
}
