// SPDX-License-Identifier: Apache-2.0
// Which of the eight probes around a point are seen from it: by their distances, by rays, or both.
#pragma once

#include <span>

#include "field/lookup_cpu.h"
#include "field/probe_store.h"
#include "raytracing/raytracer.h"

namespace lambent {

/// Weights for each query, with visibility found as `mode` says; by distances alone where `tracer`
/// is null. Single-threaded. Returns the rays traced.
std::size_t visible_corner_weights(const ProbeStore& store, Visibility mode,
                                   const RayTracer* tracer, std::span<const FieldQuery> queries,
                                   std::span<CornerWeights> result);

/// Irradiance for each query, likewise.
void visible_irradiance(const ProbeStore& store, Visibility mode, const RayTracer* tracer,
                        std::span<const FieldQuery> queries, std::span<vec3> result);

}  // namespace lambent
