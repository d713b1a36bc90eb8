// SPDX-License-Identifier: Apache-2.0
// Streamed light on materials of three.js.
import * as THREE from 'three';
import lookup from 'lambent-lookup';

/// More volumes than this are not looked up: those that come last, which reach farthest.
const MAX_VOLUMES = 8;

function texture(width, format, type, filter) {
  const made = new THREE.DataTexture(null, width, 0, format, type);
  made.minFilter = made.magFilter = filter;
  made.generateMipmaps = false;
  return made;
}

/// Data that has grown is a texture of its own: what is on the device has one size.
function put(made, data, width, height) {
  if (made.image.height !== height) made.dispose();
  made.image = { data, width, height };
  made.needsUpdate = true;
}

const gridUniform = (grid) => ({
  origin_ws: new THREE.Vector3(...grid.origin), spacing: new THREE.Vector3(...grid.spacing),
  axes: new THREE.Matrix3().fromArray(grid.axes), count: grid.count, scroll: grid.scroll, first: grid.first,
  fade_centre: new THREE.Vector3(...grid.fadeCentre), fade_half: new THREE.Vector3(...grid.fadeHalf),
  fade_cells: new THREE.Vector3(...grid.fadeCells),
});
const NO_GRID = {
  origin: [0, 0, 0], spacing: [1, 1, 1], axes: [1, 0, 0, 0, 1, 0, 0, 0, 1], count: [2, 2, 2], scroll: [0, 0, 0], first: 0,
  fadeCentre: [0, 0, 0], fadeHalf: [1, 1, 1], fadeCells: [1, 1, 1],
};

const DECLARATIONS = `#define LAMBENT_VOLUMES ${MAX_VOLUMES}
${lookup}
varying vec3 lambent_position_ws;
`;
const ADD_LIGHT = `#include <lights_fragment_begin>
irradiance += field_irradiance(lambent_position_ws, inverseTransformDirection(normal, viewMatrix),
                               normalize(cameraPosition - lambent_position_ws));
`;
const PLACE = `#include <project_vertex>
lambent_position_ws = (modelMatrix * vec4(transformed, 1.0)).xyz;
`;

export class FieldLight {
  #geometryChanges = 0;

  #mostRows;

  /// `width` is LightDecoder's, `mostRows` what the device's textures may have (capabilities.maxTextureSize).
  constructor(width, mostRows) {
    this.#mostRows = mostRows;
    this.irradiance = texture(width, THREE.RGBFormat, THREE.UnsignedInt5999Type, THREE.LinearFilter);
    this.distances = texture(width, THREE.RGFormat, THREE.HalfFloatType, THREE.LinearFilter);
    this.places = texture(width, THREE.RGBAFormat, THREE.FloatType, THREE.NearestFilter);
    this.uniforms = {
      lambent_irradiance: { value: this.irradiance }, lambent_distances: { value: this.distances },
      lambent_places: { value: this.places }, lambent_volumes: { value: 0 }, lambent_texels: { value: [4, 14] },
      lambent_grids: { value: Array.from({ length: MAX_VOLUMES }, () => gridUniform(NO_GRID)) },
    };
  }

  /// Takes over what a LightDecoder has decoded, before the next message. Throws where textures cannot hold it.
  follow(decoder) {
    const { width, texels, irradiance, distances, places, geometryChanges } = decoder.textures;
    if (distances.length / width > this.#mostRows) {
      throw new Error(`textures of this device are too small for ${decoder.probes} probes`);
    }
    put(this.irradiance, irradiance.slice(), width, irradiance.length / width);
    if (geometryChanges === this.#geometryChanges) return;
    this.#geometryChanges = geometryChanges;
    put(this.distances, new Uint16Array(distances.slice().buffer), width, distances.length / width);
    put(this.places, places.slice(), width, places.length / 4 / width);
    const grids = decoder.grids.slice(0, MAX_VOLUMES);
    this.uniforms.lambent_volumes.value = grids.length;
    this.uniforms.lambent_texels.value = texels;
    grids.forEach((grid, i) => { this.uniforms.lambent_grids.value[i] = gridUniform(grid); });
  }

  /// Has a material that three.js lights (MeshStandardMaterial, MeshPhysicalMaterial, MeshLambertMaterial) reflect the
  /// field's irradiance, too. Once, before it is drawn.
  light(material) {
    material.onBeforeCompile = (shader) => {
      Object.assign(shader.uniforms, this.uniforms);
      shader.vertexShader = `varying vec3 lambent_position_ws;\n${shader.vertexShader}`
        .replace('#include <project_vertex>', PLACE);
      shader.fragmentShader = DECLARATIONS + shader.fragmentShader
        .replace('#include <lights_fragment_begin>', ADD_LIGHT);
    };
    material.customProgramCacheKey = () => 'lambent';
  }
}
