// SPDX-License-Identifier: Apache-2.0
// The lookup over all volumes of a field. A point asks them in order; each answers for its share of
// what those before left, and the last for the rest: a partition of unity over any number of
// volumes that overlap in any way.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "field/lookup/lookup_cpu.h"
#include "field/lookup/visibility.h"

namespace lambent {

/// What probes weigh in the answers to some queries: `corners[i]` are of query `query[i]`. A query
/// is there once for each volume that has something to say about it. Its weights over all volumes
/// sum to 1, or to 0 where no probe around it knows anything.
struct QueryWeights {
  std::vector<CornerWeights> corners;
  std::vector<std::uint32_t> query;
};

/// Finds the weights of queries, volume after volume. Single-threaded. Returns the rays traced.
std::uint64_t find_weights(const ProbeStore& store, const VisibilityRays& by,
                           std::span<const FieldQuery> queries, QueryWeights& result);

/// Irradiance for each query [W/m^2], likewise.
std::uint64_t lookup_irradiance(const ProbeStore& store, const VisibilityRays& by,
                                std::span<const FieldQuery> queries, std::span<vec3> result);

}  // namespace lambent
