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

/// The factors of the weights of a point's corners.
struct CornerTerms {
  int base;
  std::uint32_t table;
  float trilinear[kCellCorners];
  float wrap[kCellCorners];        ///< Wrap-shading weight, 0 to 1; 0 for probes inside geometry.
  float visibility[kCellCorners];  ///< Visibility by the stored distances, 0 to 1.
};

/// Computes the factors of the weights for each query in one volume. Single-threaded.
void corner_terms(const ProbeStore& store, int volume, std::span<const FieldQuery> queries,
                  std::span<CornerTerms> result);

/// Adds the weighted irradiance of corners to the results of their queries: `weights[i]` belong to
/// query `query[i]`. Single-threaded.
void add_irradiance(const ProbeStore& store, std::span<const FieldQuery> queries,
                    std::span<const CornerWeights> weights, std::span<const std::uint32_t> query,
                    std::span<vec3> result);

}  // namespace lambent
