// SPDX-License-Identifier: Apache-2.0
#include "raytracing/places/closed_regions.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "raytracing/boxes.h"
#include "raytracing/places/places.h"
#include "raytracing/world_access.h"

namespace lambent {
namespace {

// More places that are seen at once within boxes are taken to be a room, whose walls or door moved
// in one piece. Of a thing that moves, so many are seen once, where it had been.
constexpr std::size_t kPlacesOfRoom = 64;

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
    if (glm::any(glm::lessThan(high, vec3(-1.0f))) ||
        glm::any(glm::greaterThan(low, vec3(grid_.count)))) {
      return;
    }
    const ivec3 from(clamp(floor(low) - 1.0f, vec3(0.0f), vec3(last)));
    const ivec3 to(clamp(ceil(high) + 1.0f, vec3(0.0f), vec3(last)));
    for (int z = from.z; z <= to.z; ++z) {
      for (int y = from.y; y <= to.y; ++y) {
        for (int x = from.x; x <= to.x; ++x) add({x, y, z});
      }
    }
  }

  /// Opens those of the places that an open neighbour sees, and goes on with the neighbours of
  /// these. Returns whether one of them is in none of the boxes, or whether they are many.
  bool run(const RayTracer& tracer, std::span<const Bounds> boxes) {
    while (!asked_.empty()) {
      trace_neighbours(tracer);
      asked_.clear();
      for (std::size_t i = 0; i < rays_.size(); ++i) {
        if (occluded_[i] != 0 || is_open(seen_[i])) continue;
        places_.open[grid_.index(seen_[i])] = 1;
        if (++opened_ > kPlacesOfRoom) return true;
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
  bool is_open(const ivec3& at) const { return places_.open[grid_.index(at)] != 0; }
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

  /// Traces rays between the places that are asked for and their open neighbours, from the lower
  /// one to the higher one, as Places does: rays along cracks may pass in one direction alone.
  void trace_neighbours(const RayTracer& tracer) {
    rays_.clear();
    seen_.clear();
    for (const ivec3& place : asked_) {
      for_each_neighbour(place, [&](const ivec3& there) {
        if (!is_open(there)) return;
        const bool higher = grid_.index(there) > grid_.index(place);
        rays_.push_back(ray_between(grid_.position_ws(higher ? place : there),
                                    grid_.position_ws(higher ? there : place)));
        seen_.push_back(place);
      });
    }
    occluded_.assign(rays_.size(), 0);
    tracer.occlusions(rays_, occluded_);
  }

  OpenPlaces& places_;
  const PlaceGrid& grid_;
  std::vector<ivec3> asked_;  // closed places
  std::vector<Ray> rays_;     // between these and open neighbours
  std::vector<ivec3> seen_;   // of each ray, the closed place
  std::vector<std::uint8_t> occluded_;
  std::size_t opened_ = 0;
};

}  // namespace

bool opens_closed_region(const World& world, std::span<const Bounds> boxes,
                         std::vector<OpenPlaces>& open_space) {
  std::vector<OpenPlaces> found = open_space;
  for (OpenPlaces& places : found) {
    Search search(places);
    for (const Bounds& box : boxes) search.start_from(box);
    if (search.run(tracer_of(world), boxes)) return true;
  }
  open_space = std::move(found);
  return false;
}

}  // namespace lambent
