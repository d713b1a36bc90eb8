// SPDX-License-Identifier: Apache-2.0
// A file of queries at a store, and of the CPU's answers: words in this order, all of 4 bytes.
//   how many volumes, probes, words of irradiance tiles, words of distance tiles, queries
//   of each volume a ProbeGrid; offsets; tiles of irradiance; tiles of distances
//   of each query a SeenPoint; of each query its irradiance
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "field/probes/probe_grid.h"

namespace lambent::ports {

struct CaseCounts {
  std::uint32_t volumes, probes, irradiance_words, distance_words, queries;
};
static_assert(sizeof(ProbeGrid) == 31 * 4);

/// A FieldQuery as ports take it: seen by a camera, which is further off than the bias reaches.
struct SeenPoint {
  glm::vec3 position_ws, normal_ws, to_viewer_ws;
};
static_assert(sizeof(SeenPoint) == 9 * 4);

}  // namespace lambent::ports
