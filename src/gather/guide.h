// SPDX-License-Identifier: Apache-2.0
// The pilot of a picture: where the light comes from, for the points of a small one.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "gather/guide_math.h"
#include "lambent/field.h"
#include "lambent/world.h"
#include "raytracing/surface.h"

namespace lambent {

/// Where the rays of a picture's pixels should go.
struct GatherGuide {
  GuideSize size{};
  std::vector<GuidePoint> points;  ///< One a pixel of the pilot's picture.
  /// kBrightPlaces for each point [m]; undefined where its share is 0.
  std::vector<glm::vec3> places;
};

/// What the pilot's picture sees, one element a pixel.
struct PilotView {
  std::span<const Surface> surfaces;   ///< Undefined where `seen` is 0.
  std::span<const std::uint8_t> seen;  ///< 1 where a pixel shows a surface.
};

/// Where a ray of the pilot ended.
struct PilotHit {
  glm::vec3 position_ws;
  float luminance;  ///< Of the light that it brings [W/(m^2 sr)].
};

/// Gathers the light of a pilot whose size the guide has. Returns the number of rays traced,
/// including shadow rays.
std::uint64_t make_guide(const World& world, const IrradianceField& field, const PilotView& view,
                         std::uint32_t seed, GatherGuide& guide);

/// Chooses bright places for the guide's points among the hits of the pilot's rays, the same number
/// for each point. The guide's size and the points' normals and positions are given.
void place_guide(std::span<const PilotHit> hits, std::span<const glm::vec3> positions_ws,
                 std::uint32_t seed, GatherGuide& guide);

}  // namespace lambent
