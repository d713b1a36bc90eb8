// SPDX-License-Identifier: Apache-2.0
// The table of corrections in a device's memory, as field/correction/correction.inl.h reads it.
#ifndef LAMBENT_FIELD_CORRECTION_SHADERS_CORRECTIONS_GLSL
#define LAMBENT_FIELD_CORRECTION_SHADERS_CORRECTIONS_GLSL

#include "field/vulkan/device_records.h"

#define CorrectionsRef CorrectionArrays

uint bucket_count(CorrectionArrays table) {
  return table.buckets;
}

CorrectionKey fetch_key(CorrectionArrays table, uint slot) {
  return table.keys.at[slot];
}

uint fetch_refined(CorrectionArrays table, uint slot, int cell) {
  return table.refined.at[slot * uint(kCellCorners) + uint(cell)];
}

#include "field/correction/search_block.inl.h"

#define find_block search_block

#include "field/correction/correction.inl.h"

/// The fetch_correction() that field/lookup/lookup.inl.h requires, for this table.
float correction_of(CorrectionArrays table, ProbeGrid grid, int volume, vec3 position_ws,
                    vec3 normal_ws) {
  if (table.buckets == 0u) return 1.0;
  if (table.picked != 0u) {
    return picked_correction(table, grid, uint(volume), position_ws, normal_ws);
  }
  return correction_at(table, grid, uint(volume), position_ws, normal_ws);
}

#endif
