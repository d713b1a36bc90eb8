// SPDX-License-Identifier: Apache-2.0
// A file of queries at a store, and of the CPU's answers: words in this order, all of 4 bytes.
//   how many volumes, probes, words of irradiance tiles, words of distance tiles, queries
//   of each volume a ProbeGrid; offsets; tiles of irradiance; tiles of distances
//   of each query a FieldQuery; of each query its irradiance
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "field/probes/probe_grid.h"
#include "lambent/field.h"

namespace lambent::ports {

struct CaseCounts {
  std::uint32_t volumes, probes, irradiance_words, distance_words, queries;
};
static_assert(sizeof(ProbeGrid) == 31 * 4 && sizeof(FieldQuery) == 9 * 4);

}  // namespace lambent::ports
