// SPDX-License-Identifier: Apache-2.0
// The kernels of the lookup, for many points at a time, eight probes abreast. Same result as
// lookup.inl.h, which the tests hold it to.
#pragma once

#include <cstdint>
#include <span>

#include "field/lookup/lookup_records.h"
#include "field/probes/probe_store.h"
#include "lambent/field.h"

namespace lambent {

/// Weights for each query in one volume, from the stored distances. Single-threaded. Spans have the
/// same length.
void corner_weights(const ProbeStore& store, int volume, std::span<const FieldQuery> queries,
                    std::span<CornerWeights> result);

/// What makes up the weights of a point's corners.
struct CornerTerms {
  int base;
  std::uint32_t table;
  float trilinear[kCellCorners];
  float wrap[kCellCorners];  ///< By the probe's side of the surface, 0 to 1; 0 in solid matter.
  float visibility[kCellCorners];  ///< By the stored distances, 0 to 1.
};

/// The same weights in parts.
void corner_terms(const ProbeStore& store, int volume, std::span<const FieldQuery> queries,
                  std::span<CornerTerms> result);

/// Adds to the result of each query what its corners hold: `weights[i]` are of query `query[i]`.
/// Single-threaded.
void add_irradiance(const ProbeStore& store, std::span<const FieldQuery> queries,
                    std::span<const CornerWeights> weights, std::span<const std::uint32_t> query,
                    std::span<vec3> result);

}  // namespace lambent
