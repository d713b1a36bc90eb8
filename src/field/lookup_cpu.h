// SPDX-License-Identifier: Apache-2.0
// The lookup for many points at a time, eight probes abreast. Same result as lookup.inl.h, which
// the tests hold it to.
#pragma once

#include <span>

#include "field/probe_store.h"
#include "lambent/field.h"

namespace lambent {

/// The eight probes around a point: corner k (bit 0 x, bit 1 y, bit 2 z) of the cell whose lowest
/// probe is `base` counts `weight[k]`. Weights sum to 1.
struct CornerWeights {
  int base;
  float weight[8];
};

/// Probe index of each corner relative to the cell's lowest probe.
struct CornerOffsets {
  int probe[8];
};
CornerOffsets corner_offsets(const ProbeGrid& grid);

/// Weights for each query, from the stored distances. Single-threaded. Spans have the same length.
void corner_weights(const ProbeStore& store, std::span<const FieldQuery> queries,
                    std::span<CornerWeights> result);

/// What makes up the weights of a point's corners.
struct CornerTerms {
  int base;
  float trilinear[8];
  float wrap[8];        ///< By the probe's side of the surface, 0 to 1; 0 in solid matter.
  float visibility[8];  ///< By the stored distances, 0 to 1.
};

/// The same weights in parts.
void corner_terms(const ProbeStore& store, std::span<const FieldQuery> queries,
                  std::span<CornerTerms> result);

/// Irradiance for each query, given the weights of its corners.
void weighted_irradiance(const ProbeStore& store, std::span<const FieldQuery> queries,
                         std::span<const CornerWeights> weights, std::span<vec3> result);

/// Irradiance for each query, from stored distances and irradiance. Single-threaded.
void lookup_irradiance(const ProbeStore& store, std::span<const FieldQuery> queries,
                       std::span<vec3> result);

}  // namespace lambent
