// SPDX-License-Identifier: Apache-2.0
// The record through which shaders of an engine look a field up
// (lambent/shaders/field_lookup.glsl).
#ifndef LAMBENT_FIELD_LOOKUP_FIELD_RECORD_H
#define LAMBENT_FIELD_LOOKUP_FIELD_RECORD_H

#include "field/vulkan/device_records.h"

LAMBENT_BEGIN

// How lookups find which probes they see. The numbers are those of Visibility.
const uint kVisibilityMoments = 0u;
const uint kVisibilityHybrid = 1u;
const uint kVisibilityExact = 2u;

struct FieldRecord {
  StoreArrays store;
  CorrectionArrays corrections;
  UintArray cell_visibility;  ///< Of hybrid visibility: two words a probe (all_visible).
  int volumes;
  uint visibility;  ///< kVisibilityMoments, ...: what lookups do that can trace rays.
};
LAMBENT_DEVICE_ARRAY(FieldRecordArray, FieldRecord, 8)

LAMBENT_END
#endif
