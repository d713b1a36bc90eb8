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
  int width = 0, height = 0;  ///< Of the pilot's picture [pixels]; 0: there is no pilot.
  std::vector<GuidePoint> points;
  /// kBrightPlaces for each point [m]; undefined where its share is 0.
  std::vector<glm::vec3> places;

  /// For the rays of a picture of this size [pixels].
  GuideSize size(int picture_width, int picture_height) const {
    return {picture_width, picture_height, width, height};
  }
};

/// What the pilot's picture sees.
struct PilotView {
  int width = 0, height = 0;           ///< [pixels]
  std::span<const Surface> surfaces;   ///< Undefined where `seen` is 0.
  std::span<const std::uint8_t> seen;  ///< 1 where a pixel shows a surface.
};

/// Where a ray of the pilot ended.
struct PilotHit {
  glm::vec3 position_ws;
  float luminance;  ///< Of the light that it brings [W/(m^2 sr)].
};

/// Gathers the pilot's light. Returns the number of rays traced, including shadow rays.
std::uint64_t make_guide(const World& world, const IrradianceField& field, const PilotView& view,
                         std::uint32_t seed, GatherGuide& guide);

/// Chooses bright places for the guide's points among the hits of the pilot's rays, the same number
/// for each point. The guide's sizes and the points' normals and positions are given.
void place_guide(std::span<const PilotHit> hits, std::span<const glm::vec3> positions_ws,
                 std::uint32_t seed, GatherGuide& guide);

}  // namespace lambent
