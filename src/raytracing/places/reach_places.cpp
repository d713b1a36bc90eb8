// SPDX-License-Identifier: Apache-2.0
#include "raytracing/places/reach_places.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "raytracing/places/places.h"
#include "raytracing/world_access.h"

namespace lambent {
namespace {

bool contains(const Bounds& box, const vec3& point) {
  return glm::all(glm::lessThanEqual(box.min, point)) &&
         glm::all(glm::lessThanEqual(point, box.max));
}

/// The places of a grid, and a search for closed ones.
class Search {
 public:
  explicit Search(OpenPlaces& places) : places_(places), grid_(places.grid) {}

  /// Adds the closed places in a box and around it.
  void start_from(const Bounds& box) {
    vec3 low(infinity()), high(-infinity());
    for (int corner = 0; corner < 8; ++corner) {
      const vec3 cells = grid_.cells_at({(corner & 1) != 0 ? box.max.x : box.min.x,
                                         (corner & 2) != 0 ? box.max.y : box.min.y,
                                         (corner & 4) != 0 ? box.max.z : box.min.z});
      low = min(low, cells);
      high = max(high, cells);
    }
    const ivec3 last = grid_.count - 1;
    const ivec3 from(clamp(floor(low) - 1.0f, vec3(0.0f), vec3(last)));
    const ivec3 to(clamp(ceil(high) + 1.0f, vec3(0.0f), vec3(last)));
    for (int z = from.z; z <= to.z; ++z) {
      for (int y = from.y; y <= to.y; ++y) {
        for (int x = from.x; x <= to.x; ++x) add({x, y, z});
      }
    }
  }

  /// Opens those of the places that an open neighbour sees, and goes on with the neighbours of
  /// these. Returns whether one of them is in none of the boxes.
  bool run(const RayTracer& tracer, std::span<const Bounds> boxes) {
    while (!asked_.empty()) {
      trace_neighbours(tracer);
      asked_.clear();
      for (std::size_t i = 0; i < ways_.size(); ++i) {
        if (occluded_[i] != 0 || is_open(seen_[i])) continue;
        places_.open[index(seen_[i])] = 1;
        const vec3 position_ws = grid_.position_ws(seen_[i]);
        if (std::none_of(boxes.begin(), boxes.end(),
                         [&](const Bounds& box) { return contains(box, position_ws); })) {
          return true;
        }
        for_each_neighbour(seen_[i], [&](const ivec3& there) { add(there); });
      }
    }
    return false;
  }

 private:
  std::size_t index(const ivec3& at) const {
    return (static_cast<std::size_t>(at.z) * grid_.count.y + at.y) * grid_.count.x + at.x;
  }
  bool is_open(const ivec3& at) const { return places_.open[index(at)] != 0; }
  void add(const ivec3& at) {
    if (!is_open(at)) asked_.push_back(at);
  }

  template <class Visit>
  void for_each_neighbour(const ivec3& at, Visit visit) const {
    for (int axis = 0; axis < 3; ++axis) {
      for (const int step : {-1, 1}) {
        ivec3 there = at;
        there[axis] += step;
        if (there[axis] >= 0 && there[axis] < grid_.count[axis]) visit(there);
      }
    }
  }

  /// Traces rays from the open neighbours of the places that are asked for.
  void trace_neighbours(const RayTracer& tracer) {
    ways_.clear();
    seen_.clear();
    for (const ivec3& place : asked_) {
      for_each_neighbour(place, [&](const ivec3& there) {
        if (!is_open(there)) return;
        ways_.push_back(ray_between(grid_.position_ws(there), grid_.position_ws(place)));
        seen_.push_back(place);
      });
    }
    occluded_.assign(ways_.size(), 0);
    tracer.occlusions(ways_, occluded_);
  }

  OpenPlaces& places_;
  const PlaceGrid& grid_;
  std::vector<ivec3> asked_;  // closed places
  std::vector<Ray> ways_;     // from open neighbours to these
  std::vector<ivec3> seen_;   // where the ways lead
  std::vector<std::uint8_t> occluded_;
};

}  // namespace

bool reach_closed_places(const World& world, std::span<const Bounds> boxes,
                         std::span<OpenPlaces> open_space) {
  for (OpenPlaces& places : open_space) {
    Search search(places);
    for (const Bounds& box : boxes) search.start_from(box);
    if (search.run(tracer_of(world), boxes)) return true;
  }
  return false;
}

}  // namespace lambent
