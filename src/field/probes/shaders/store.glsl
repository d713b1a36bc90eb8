// SPDX-License-Identifier: Apache-2.0
// Access to a store in a device's memory, as field/lookup/lookup.inl.h requires it. The includer
// has declared push constants with a member `args.store`.
#ifndef LAMBENT_FIELD_PROBES_SHADERS_STORE_GLSL
#define LAMBENT_FIELD_PROBES_SHADERS_STORE_GLSL

#include "field/vulkan/device_records.h"
#include "field/probes/irradiance_encoding.h"
#include "field/lookup/lookup.h"
#include "field/probes/shaders/tiles.glsl"
#include "field/probes/tile.h"

ProbeGrid fetch_grid(int volume) {
  return args.store.grids.at[volume];
}

vec3 fetch_offset(int probe) {
  return decode_probe_offset(args.store.offsets.at[probe]);
}

vec2 moments_at(int texel) {
  if (kDistanceFormat == kRg16f) return decode_half2(args.store.distance.at[texel]);
  return vec2(uintBitsToFloat(args.store.distance.at[2 * texel]),
              uintBitsToFloat(args.store.distance.at[2 * texel + 1]));
}

vec2 fetch_moments(int probe, vec3 direction) {
  TileFetch fetch = moments_fetch(direction, kDistanceTexels);
  int width = kDistanceTexels + 2;
  int first = probe * (width * width) + fetch.corner.y * width + fetch.corner.x;
  return bilinear_moments(moments_at(first), moments_at(first + 1), moments_at(first + width),
                          moments_at(first + width + 1), fetch.fraction);
}

vec3 irradiance_at(int texel) {
  if (words_of_irradiance(kIrradianceFormat) == 1) {
    return decode_irradiance(kIrradianceFormat, args.store.irradiance.at[texel]);
  }
  return vec3(uintBitsToFloat(args.store.irradiance.at[3 * texel]),
              uintBitsToFloat(args.store.irradiance.at[3 * texel + 1]),
              uintBitsToFloat(args.store.irradiance.at[3 * texel + 2]));
}

vec3 fetch_irradiance(int probe, vec3 direction) {
  TileFetch fetch = tile_fetch(direction, kIrradianceTexels);
  int width = kIrradianceTexels + 2;
  int first = probe * (width * width) + fetch.corner.y * width + fetch.corner.x;
  vec3 top = mix(irradiance_at(first), irradiance_at(first + 1), fetch.fraction.x);
  vec3 bottom =
      mix(irradiance_at(first + width), irradiance_at(first + width + 1), fetch.fraction.x);
  return mix(top, bottom, fetch.fraction.y);
}

#endif
