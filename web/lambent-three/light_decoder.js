// SPDX-License-Identifier: Apache-2.0
// The decoder of light streams in WebAssembly, built from the C++ of src/stream/light/.

const GRID_WORDS = 31; // of ProbeGrid, src/field/probes/probe_grid.h
const MOST_BYTES = 512 * 1024 * 1024; // that the state of a field may take

/// What the module asks for: it has no system, so that whatever but its memory's growth is called means its end.
function importsOf(module) {
  const imports = {};
  for (const { module: from, name } of WebAssembly.Module.imports(module)) {
    imports[from] ??= {};
    imports[from][name] = name === 'emscripten_notify_memory_growth'
      ? () => {}
      : () => { throw new Error(`the light decoder called ${name}`); };
  }
  return imports;
}

export class LightDecoder {
  #wasm;
  #client;

  /// From the bytes of light_decoder.wasm, or an answer to fetch() of it.
  static async make(source, mostBytes = MOST_BYTES) {
    const module = source instanceof Response
      ? await WebAssembly.compileStreaming(source) : await WebAssembly.compile(source);
    const { exports } = await WebAssembly.instantiate(module, importsOf(module));
    exports._initialize?.();
    return new LightDecoder(exports, mostBytes);
  }

  constructor(wasm, mostBytes) {
    this.#wasm = wasm;
    this.#client = wasm.lambent_make(mostBytes);
  }

  /// Frees the module's memory; the decoder cannot be used afterwards.
  close() {
    this.#wasm.lambent_free(this.#client);
    this.#client = 0;
  }

  /// Takes a message, a Uint8Array. False: it was refused, `error` says why, and the light is what it was.
  receive(bytes) {
    const at = this.#wasm.lambent_message(this.#client, bytes.length);
    new Uint8Array(this.#wasm.memory.buffer, at, bytes.length).set(bytes);
    return this.#wasm.lambent_receive(this.#client) === 1;
  }
  /// Brings `textures` up to date; to be called after each message that was taken.
  follow() { this.#wasm.lambent_follow(this.#client); }

  get error() {
    const bytes = new Uint8Array(this.#wasm.memory.buffer, this.#wasm.lambent_error(this.#client));
    return new TextDecoder().decode(bytes.slice(0, bytes.indexOf(0)));
  }
  get needsKey() { return this.#wasm.lambent_needs_key(this.#client) === 1; }
  /// The update whose light this is, and the number of the geometry, each a BigInt; 0: none.
  get update() { return BigInt.asUintN(64, this.#wasm.lambent_update(this.#client)); }
  get geometry() { return BigInt.asUintN(64, this.#wasm.lambent_geometry(this.#client)); }
  get probes() { return this.#wasm.lambent_probes(this.#client); }
  /// CRC-32 of all that was decoded.
  get checksum() { return this.#wasm.lambent_checksum(this.#client) >>> 0; }

  /// The way that the sun's light travels at a time of day, and the share of its irradiance that it has then.
  sunAt(hours) {
    const [x, y, z, share] = new Float32Array(this.#wasm.memory.buffer, this.#wasm.lambent_sun(hours), 4);
    return { direction: [x, y, z], share };
  }

  /// Views of the module's memory, good until the next message: what LightTextures
  /// (src/stream/light/light_textures.h) has.
  get textures() {
    const wasm = this.#wasm, client = this.#client;
    const words = (name) => new Uint32Array(wasm.memory.buffer, wasm[`lambent_${name}`](client),
      wasm[`lambent_${name}_words`](client));
    return {
      width: wasm.lambent_texture_width(),
      texels: [wasm.lambent_irradiance_texels(client), wasm.lambent_distance_texels(client)],
      irradiance: words('irradiance'),
      distances: words('distances'),
      places: new Float32Array(wasm.memory.buffer, wasm.lambent_places(client), 4 * wasm.lambent_places_count(client)),
      geometryChanges: wasm.lambent_geometry_changes(client),
    };
  }

  /// The volumes, in the order in which lookups use them.
  get grids() {
    const first = this.#wasm.lambent_grids(this.#client);
    return Array.from({ length: this.#wasm.lambent_grids_count(this.#client) }, (_, i) => {
      const from = first + 4 * GRID_WORDS * i;
      const reals = Array.from(new Float32Array(this.#wasm.memory.buffer, from, GRID_WORDS));
      const whole = Array.from(new Int32Array(this.#wasm.memory.buffer, from, GRID_WORDS));
      return {
        origin: reals.slice(0, 3), spacing: reals.slice(3, 6), axes: reals.slice(6, 15),
        count: whole.slice(15, 18), scroll: whole.slice(18, 21), first: whole[21],
        fadeCentre: reals.slice(22, 25), fadeHalf: reals.slice(25, 28), fadeCells: reals.slice(28, 31),
      };
    });
  }
}
