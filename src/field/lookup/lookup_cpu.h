// SPDX-License-Identifier: Apache-2.0
// Vectorised kernels of the lookup, for many points at a time and the eight probes of a cell at
// once. The results equal those of lookup.inl.h; tests compare them.
#pragma once

#include <cstdint>
#include <span>

#include "field/lookup/lookup_records.h"
#include "field/probes/probe_store.h"
#include "lambent/field.h"

namespace lambent {

/// Computes the weights for each query in one volume from the stored distances. Single-threaded.
/// Both spans have the same length.
void corner_weights(const ProbeStore& store, int volume, std::span<const FieldQuery> queries,
                    std::span<CornerWeights> result);

/// Adds the weighted irradiance of corners to the results of their queries: `weights[i]` belong to
/// query `query[i]`. Single-threaded.
void add_irradiance(const ProbeStore& store, std::span<const FieldQuery> queries,
                    std::span<const CornerWeights> weights, std::span<const std::uint32_t> query,
                    std::span<vec3> result);

}  // namespace lambent
