// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "field/blend.h"
#include "field/probe_store.h"
#include "raytracing/raytracer.h"

namespace lambent {

/// Exponent of the cosine with which rays count for a distance texel: sharp enough that what blocks
/// one direction does not blur into the next. JCGT 8(2) 2019, sec. 4.3.
inline constexpr float kDistanceExponent = 50.0f;

/// Blends the distances of an update's rays into the store: mean and mean square along each texel's
/// direction. `hits` has an entry a ray, probe after probe; `share` is the part of the new values,
/// 0 to 1.
void blend_distances(const Scene& scene, const BlendMatrix& blend, std::span<const Hit> hits,
                     float share, uint salt, ProbeStore& store);

}  // namespace lambent
