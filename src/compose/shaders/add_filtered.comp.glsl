// SPDX-License-Identifier: Apache-2.0
// Adds filtered light to the layers of the pixels that are shown.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "compose/filter_records.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push {
  AddFilteredArguments args;
};

/// Adds the filtered light of coats to the layers of a pixel.
void show_coat(uint i, LobeGuideArray lobes, Vec3Array albedo, Vec3Array filtered,
               inout PixelLayers layers) {
  if (lobes.at[i].sharpness <= 0.0f) return;
  vec3 glossy = args.share * albedo.at[i] * filtered.at[i];
  layers.glossy += glossy;
  layers.all += glossy;
}

void main() {
  uint k = gl_GlobalInvocationID.x;
  if (k >= args.count) return;
  uint i = args.first + k;
  PixelLayers layers = args.layers.at[k];
  if (args.emitters != 0u) {
    vec3 direct = args.share * args.pixels.at[0].emitter_albedo.at[i] *
                  args.pixels.at[0].filtered_emitters.at[i];
    vec3 glossy = args.share * args.pixels.at[0].highlight_albedo.at[i] *
                  args.pixels.at[0].filtered_highlights.at[i];
    layers.direct += direct;
    layers.glossy += glossy;
    layers.all += direct + glossy;
  }
  FilteredPixelsRecord pixels = args.pixels.at[0];
  if (args.coats != 0u) {
    show_coat(i, pixels.coat_lobes, pixels.coat_albedo, pixels.filtered_coats, layers);
  }
  if (args.clearcoats != 0u) {
    show_coat(i, pixels.clearcoat_lobes, pixels.clearcoat_albedo, pixels.filtered_clearcoats,
              layers);
  }
  if (args.mirrored != 0u) {
    show_coat(i, pixels.mirrored_lobes, pixels.mirrored_albedo, pixels.filtered_mirrored, layers);
  }
  bool shows_base = (args.mirrored_emitters | args.mirrored_gathered) != 0u;
  if (shows_base && pixels.mirrored_base_depths.at[i] > 0.0f) {
    vec3 glossy = vec3(0.0f);
    if (args.mirrored_emitters != 0u) {
      glossy += args.share * pixels.mirrored_emitter_albedo.at[i] *
                pixels.filtered_mirrored_emitters.at[i];
    }
    if (args.mirrored_gathered != 0u) {
      glossy +=
          args.share * pixels.mirrored_gather.albedo.at[i] * pixels.mirrored_gather.filtered.at[i];
    }
    layers.glossy += glossy;
    layers.all += glossy;
  }
  if (args.gathered != 0u && args.pixels.at[0].received_weight.at[i] != 0.0f) {
    vec3 irradiance = args.share * args.pixels.at[0].filtered_gathered.at[i];
    vec3 indirect = args.pixels.at[0].indirect_albedo.at[i] * irradiance;
    layers.irradiance += args.pixels.at[0].received_weight.at[i] * irradiance;
    layers.indirect += indirect;
    layers.all += indirect;
  }
  args.layers.at[k] = layers;
}
