// SPDX-License-Identifier: Apache-2.0
// Conversion of maps between the public interface and records.
#pragma once

#include <bit>
#include <cstddef>

#include "lambent/rsm.h"
#include "rsm/records.h"

namespace lambent {

static_assert(sizeof(RsmTexel) == sizeof(RsmTexelRecord) &&
              offsetof(RsmTexel, normal_ws) == offsetof(RsmTexelRecord, normal_ws) &&
              offsetof(RsmTexel, flux) == offsetof(RsmTexelRecord, flux));

inline RsmTexelRecord to_record(const RsmTexel& texel) {
  return std::bit_cast<RsmTexelRecord>(texel);
}

inline RsmTexel to_texel(const RsmTexelRecord& record) {
  return std::bit_cast<RsmTexel>(record);
}

inline MapProjection to_record(const RsmProjection& p) {
  using Kind = RsmProjection::Kind;
  const uint kind = p.kind == Kind::orthographic  ? kOrthographicMap
                    : p.kind == Kind::perspective ? kPerspectiveMap
                                                  : kOctahedralMap;
  return {kind, p.origin_ws, p.world_from_light, p.half_extent};
}

}  // namespace lambent
