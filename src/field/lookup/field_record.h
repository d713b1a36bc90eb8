// SPDX-License-Identifier: Apache-2.0
// The record through which shaders of an engine look a field up
// (lambent/shaders/field_lookup.glsl).
#ifndef LAMBENT_FIELD_LOOKUP_FIELD_RECORD_H
#define LAMBENT_FIELD_LOOKUP_FIELD_RECORD_H

#include "field/vulkan/device_records.h"

LAMBENT_BEGIN

struct FieldRecord {
  StoreArrays store;
  CorrectionArrays corrections;
  int volumes;
  int unused;
};
LAMBENT_DEVICE_ARRAY(FieldRecordArray, FieldRecord, 8)

LAMBENT_END
#endif
