// SPDX-License-Identifier: Apache-2.0
// The lookup over all volumes of a field, in order: each volume takes volume_share() of the weight
// that the volumes before it have left. This is a partition of unity for any number of volumes that
// overlap in any way.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "field/lookup/lookup_cpu.h"
#include "field/lookup/visibility.h"

namespace lambent {

/// The weights of probes in the lookups of some queries: `corners[i]` belong to query `query[i]`. A
/// query has an entry for each volume in which it has a weight. Before corrections, its weights
/// over all volumes sum to 1, or to 0 where all probes around it are inside geometry.
struct QueryWeights {
  std::vector<CornerWeights> corners;
  std::vector<std::uint32_t> query;
};

/// Finds the weights of queries, volume after volume. Single-threaded. Returns the number of rays
/// traced.
std::uint64_t find_weights(const ProbeStore& store, const VisibilityRays& by,
                           std::span<const FieldQuery> queries, QueryWeights& result);

/// Computes the irradiance for each query [W/m^2]. Single-threaded. Returns the number of rays
/// traced.
std::uint64_t lookup_irradiance(const ProbeStore& store, const VisibilityRays& by,
                                std::span<const FieldQuery> queries, std::span<vec3> result);

}  // namespace lambent
