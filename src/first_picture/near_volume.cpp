// SPDX-License-Identifier: Apache-2.0
// Finer probes around a camera, for scenes that are far larger than what it sees.
#include <algorithm>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "first_picture/seen.h"
#include "first_picture/survey.h"
#include "lambent/field.h"
#include "lambent/first_picture.h"
#include "lambent/world.h"

namespace lambent {
namespace {

// Number of rays around the camera. Surfaces that it does not see light those that it sees.
constexpr int kSurroundRays = 256;
// Where fewer of these hit a surface, the camera stands in the open, and nothing bounds its
// surroundings.
constexpr float kMinHitShare = 0.25f;
// The box leaves out this share of the hits on either side of each axis: views through windows and
// doors. Walls of a room take more.
constexpr float kOutlierShare = 0.1f;
// A grid with fewer cells than this along each side of the box cannot show how light varies there.
constexpr float kMinCells = 4.0f;

/// Places of surfaces around the camera; empty where it stands in the open.
std::vector<glm::vec3> places_around(const World& world, const Camera& camera) {
  const glm::vec3 eye(camera.world_from_view[3]);
  const std::vector<Ray> rays = rays_around(eye, kSurroundRays);
  const std::vector<Hit> hits = trace(world, rays);
  std::vector<glm::vec3> places;
  for (std::size_t i = 0; i < hits.size(); ++i) {
    if (!hits[i].missed()) places.push_back(eye + hits[i].distance * rays[i].direction);
  }
  if (static_cast<float>(places.size()) < kMinHitShare * kSurroundRays) return {};
  for (const SeenPoint& seen : sample_view(world, camera).points) {
    places.push_back(seen.point.position_ws);
  }
  return places;
}

/// A box around most of the places.
Bounds box_around(const std::vector<glm::vec3>& places) {
  Bounds box;
  const auto outliers = static_cast<std::size_t>(kOutlierShare * static_cast<float>(places.size()));
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<float> along;
    along.reserve(places.size());
    for (const glm::vec3& place : places) along.push_back(place[axis]);
    std::sort(along.begin(), along.end());
    box.min[axis] = along[outliers];
    box.max[axis] = along[along.size() - 1 - outliers];
  }
  return box;
}

}  // namespace

std::optional<ProbeVolume> near_volume(const World& world, const Camera& camera,
                                       const glm::vec3& spacing) {
  if (camera.orthographic) return std::nullopt;
  const std::vector<glm::vec3> places = places_around(world, camera);
  if (places.empty()) return std::nullopt;
  Bounds box = box_around(places);
  const glm::vec3 eye(camera.world_from_view[3]);
  box.min = glm::min(box.min, eye);
  box.max = glm::max(box.max, eye);
  if (glm::any(glm::greaterThanEqual(box.max - box.min, kMinCells * spacing))) return std::nullopt;

  const Expected<FieldGrid> grid = fit_grid({}, box);
  if (!grid) return std::nullopt;
  ProbeVolume volume;
  volume.name = "around the camera";
  volume.probe_count = grid->count;
  volume.size = grid->spacing * glm::vec3(grid->count - 1);
  volume.centre = grid->origin + 0.5f * volume.size;
  return volume;
}

}  // namespace lambent
