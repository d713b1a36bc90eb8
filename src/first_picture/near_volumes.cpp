// SPDX-License-Identifier: Apache-2.0
// Finer probes around a camera, for scenes that are larger than what it sees.
#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "first_picture/seen.h"
#include "first_picture/survey.h"
#include "lambent/field.h"
#include "lambent/first_picture.h"
#include "lambent/world.h"
#include "raytracing/boxes.h"
#include "raytracing/trace_rays.h"

namespace lambent {
namespace {

// Number of rays around the camera. Surfaces that it does not see light those that it sees.
constexpr int kSurroundRays = 256;
// Where fewer of these hit a surface, the camera stands in the open, and nothing but the ground
// bounds its surroundings.
constexpr float kMinHitShare = 0.6f;
// The box leaves out this share of the hits on either side of each axis: views through windows and
// doors. Walls of a room take more.
constexpr float kOutlierShare = 0.1f;
// In the open, finer probes are put among this share of the surfaces that the camera sees, the
// nearest ones: a house in its grounds.
constexpr float kNearbyShare = 0.75f;
// Their box leaves out this share of them on either side of each axis.
constexpr float kNearbyOutlierShare = 0.02f;
// It is enlarged by this share of its size on either side: rooms lie behind the walls and
// the windows that the camera sees.
constexpr float kNearbyMargin = 0.35f;
// It must be smaller than this along each side, before it is enlarged [cells].
constexpr float kNearbyCells = 2.0f;
// A grid with fewer cells than this along any side of the box around a camera indoors cannot show
// how light varies there.
constexpr float kMinCells = 4.0f;
// Finer probes are worth their rays where their spacing is smaller by at least this factor:
// Sponza's nave, with 3.4, has 7 % less error with them.
constexpr float kMinRatio = 2.0f;
// A volume along a camera's path has up to this many times the probes of one around a place: a lift
// of 2 m that climbs 12 m takes all of them.
constexpr float kMaxPathFactor = 4.0f;
// Spacings of volumes that enclose each other differ by about this factor, by more where the grid's
// own bounds cut a volume off: what stands beside the box, as the rooms of a house behind the
// camera's or around its yard, is far smaller than a cell of the whole grid. With 4, rooms around a
// courtyard have 1.2 times the error.
constexpr float kSpacingStep = 2.5f;

/// Places of surfaces that the camera sees.
std::vector<glm::vec3> places_seen(const World& world, const Camera& camera) {
  std::vector<glm::vec3> places;
  for (const SeenPoint& seen : sample_view(world, camera).points) {
    places.push_back(seen.point.position_ws);
  }
  return places;
}

/// Places of surfaces around the camera; empty where it stands in the open.
std::vector<glm::vec3> places_around(const World& world, const glm::vec3& eye) {
  const std::vector<Ray> rays = rays_around(eye, kSurroundRays);
  const std::vector<Hit> hits = trace(world, rays);
  std::vector<glm::vec3> places;
  for (std::size_t i = 0; i < hits.size(); ++i) {
    if (!hits[i].missed()) places.push_back(eye + hits[i].distance * rays[i].direction);
  }
  if (static_cast<float>(places.size()) < kMinHitShare * kSurroundRays) places.clear();
  return places;
}

/// The nearest of some places.
std::vector<glm::vec3> nearest(std::vector<glm::vec3> places, const glm::vec3& eye) {
  std::sort(places.begin(), places.end(), [&](const glm::vec3& a, const glm::vec3& b) {
    return glm::distance(a, eye) < glm::distance(b, eye);
  });
  places.resize(static_cast<std::size_t>(kNearbyShare * static_cast<float>(places.size())));
  return places;
}

/// A box around most of the places, without this share of them on either side of each axis.
Bounds box_around(const std::vector<glm::vec3>& places, float left_out) {
  Bounds box;
  const auto outliers = static_cast<std::size_t>(left_out * static_cast<float>(places.size()));
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

float longest(const glm::vec3& size) {
  return std::max({size.x, size.y, size.z});
}

/// A volume in a box, of about 4,096 probes times a factor; none where the box has no size.
std::optional<ProbeVolume> volume_in(const Bounds& box, const char* name, float factor = 1.0f) {
  Expected<FieldGrid> grid = fit_grid({}, box);
  if (grid && factor > 1.0f) {
    FieldSettings settings;
    settings.probe_spacing = longest(grid->spacing) / std::cbrt(factor);
    grid = fit_grid(settings, box);
  }
  if (!grid) return std::nullopt;
  ProbeVolume volume;
  volume.name = name;
  volume.probe_count = grid->count;
  volume.size = grid->spacing * glm::vec3(grid->count - 1);
  volume.centre = grid->origin + 0.5f * volume.size;
  return volume;
}

/// A volume in a box that encloses others: as fine as in the smallest of these, as far as it can.
std::optional<ProbeVolume> finest_volume(const Bounds& whole, std::span<const Bounds> parts) {
  const auto content = [](const Bounds& box) {
    const glm::vec3 size = box.max - box.min;
    return size.x * size.y * size.z;
  };
  float least = content(whole);
  for (const Bounds& part : parts) least = std::min(least, content(part));
  const float factor = least > 0.0f ? content(whole) / least : 1.0f;
  return volume_in(whole, parts.size() > 1 ? "along the camera's path" : "around the camera",
                   std::min(factor, kMaxPathFactor));
}

}  // namespace

std::optional<Bounds> near_box(const World& world, const Camera& camera, const FieldGrid& grid) {
  if (camera.orthographic) return std::nullopt;
  const glm::vec3 eye(camera.world_from_view[3]);
  const std::vector<glm::vec3> seen = places_seen(world, camera);
  std::vector<glm::vec3> places = places_around(world, eye);
  const bool in_the_open = places.empty();
  if (in_the_open) {
    places = nearest(seen, eye);
  } else {
    places.insert(places.end(), seen.begin(), seen.end());
  }
  if (places.empty()) return std::nullopt;
  Bounds box = box_around(places, in_the_open ? kNearbyOutlierShare : kOutlierShare);
  box.add(eye);
  const glm::vec3 size = box.max - box.min;
  const bool is_coarse = in_the_open ? glm::all(glm::lessThan(size, kNearbyCells * grid.spacing))
                                     : glm::any(glm::lessThan(size, kMinCells * grid.spacing));
  if (!is_coarse) return std::nullopt;
  if (in_the_open) box = {box.min - kNearbyMargin * size, box.max + kNearbyMargin * size};
  return box;
}

std::vector<ProbeVolume> near_volumes(std::span<const Bounds> boxes, const FieldGrid& grid) {
  Bounds box;
  for (const Bounds& part : boxes) box.add(part);
  const Bounds whole{grid.origin, grid.origin + grid.spacing * glm::vec3(grid.count - 1)};
  // Scenes reach up to a cell beyond their grid
  const Bounds margin{whole.min - grid.spacing, whole.max + grid.spacing};
  if (boxes.empty() || !overlap(box, margin)) return {};
  const std::optional<ProbeVolume> finest = finest_volume(box, boxes);
  if (!finest) return {};
  const glm::vec3 cells(finest->probe_count - 1);
  const float ratio = longest(grid.spacing) / longest(finest->size / cells);
  if (ratio < kMinRatio) {
    // A long path leaves fine probes for its beginning alone
    return boxes.size() > 1 ? near_volumes(boxes.first(1), grid) : std::vector<ProbeVolume>();
  }

  // Between its spacing and that of the grid
  std::vector<ProbeVolume> volumes = {*finest};
  const float steps = std::ceil(std::log(ratio) / std::log(kSpacingStep));
  for (float step = 1.0f; step < steps; ++step) {
    const glm::vec3 half = 0.5f * finest->size * std::pow(ratio, step / steps);
    const Bounds around{glm::max(finest->centre - half, glm::min(box.min, whole.min)),
                        glm::min(finest->centre + half, glm::max(box.max, whole.max))};
    if (auto volume = volume_in(around, "beside what surrounds the camera")) {
      volumes.push_back(std::move(*volume));
    }
  }
  return volumes;
}

std::vector<ProbeVolume> near_volumes(const World& world, const Camera& camera,
                                      const FieldGrid& grid) {
  const std::optional<Bounds> box = near_box(world, camera, grid);
  return box ? near_volumes(std::span(&*box, 1), grid) : std::vector<ProbeVolume>();
}

}  // namespace lambent
