// SPDX-License-Identifier: Apache-2.0
#include "raytracing/find_solid_sides.h"

#include <algorithm>
#include <cstdint>
#include <vector>

#include "core/parallel.h"
#include "raytracing/raytracer.h"
#include "shared/sampling.h"

namespace lambent {
namespace {

// Rays from each place. A room's place sees its window, or its lamp, if one place in hundreds does.
constexpr int kRays = 32;
constexpr std::size_t kPlacesPerTask = 64;
// Neighbours of a place towards larger coordinates: one along each axis.
constexpr int kAxes = 3;
// Places around a light: the corners of its cell.
constexpr int kCorners = 8;
// Fewer sightings of a triangle, or of an instance, prove nothing: rays pass through cracks.
constexpr std::uint32_t kMinSightings = 4;
// A surface that open space sees from one side in this share of the sightings or more bounds
// solid matter with its other one. The rest is cracks and places that straddle a wall.
constexpr float kOneSided = 0.9f;

/// How often open space saw the front and the back of something.
struct Sightings {
  std::uint32_t front = 0, back = 0;

  void add(bool is_front) { ++(is_front ? front : back); }
  std::uint32_t all() const { return front + back; }
  /// The sides that bound solid matter, as bits.
  std::uint32_t solid_sides() const {
    const float least = kOneSided * static_cast<float>(all());
    if (static_cast<float>(front) >= least) return kSolidBack;
    return static_cast<float>(back) >= least ? kSolidFront : 0u;
  }
};

/// The places of a grid's probes, what they see, and which of them are open.
class Places {
 public:
  Places(const World& world, const PlaceGrid& grid)
      : world_(world), grid_(grid), open_(count(), 0), joined_(kAxes * count(), 0) {
    look_around();
    look_across();
    mark_lights();
    spread();
  }

  bool any_open() const {
    return std::any_of(open_.begin(), open_.end(), [](std::uint8_t open) { return open != 0; });
  }

  /// Calls `see` with all hits of the places that are open, or of all of them.
  template <class See>
  void for_each_sighting(bool all, See see) const {
    for (std::size_t place = 0; place < count(); ++place) {
      if (!all && open_[place] == 0) continue;
      for (int i = 0; i < kRays; ++i) {
        const Hit& hit = hits_[place * kRays + i];
        if (!hit.missed()) see(hit);
      }
    }
  }

 private:
  std::size_t count() const {
    return static_cast<std::size_t>(grid_.count.x) * grid_.count.y * grid_.count.z;
  }
  vec3 position(const vec3& coords) const {
    return grid_.origin_ws + grid_.axes * (grid_.spacing * coords);
  }
  ivec3 coords(std::size_t place) const {
    const int i = static_cast<int>(place);
    return {i % grid_.count.x, i / grid_.count.x % grid_.count.y,
            i / (grid_.count.x * grid_.count.y)};
  }
  std::size_t stride(int axis) const {
    const std::size_t x = grid_.count.x;
    return axis == 0 ? 1 : axis == 1 ? x : x * grid_.count.y;
  }

  bool emits(const Hit& hit) const {
    const Scene& scene = world_.scene();
    const Material& material =
        scene.materials[scene.meshes[scene.instances[hit.instance].mesh].material];
    return material.emission != vec3(0.0f);
  }

  /// Traces rays from each place, and opens the places that see out of the scene or a lamp.
  void look_around() {
    hits_.resize(kRays * count());
    std::vector<vec3> directions;
    for (uint i = 0; i < kRays; ++i) directions.push_back(spherical_fibonacci(i, kRays));
    const RayTracer& tracer = world_.tracer();
    parallel_chunks(count(), batch_of(tracer, kRays, kPlacesPerTask),
                    [&](std::size_t begin, std::size_t end) {
                      std::vector<Ray> rays;
                      for (std::size_t place = begin; place < end; ++place) {
                        const vec3 origin = position(coords(place));
                        for (const vec3& direction : directions) {
                          rays.push_back({origin, 0.0f, direction, kInfiniteDistance, kRayOfProbe});
                        }
                      }
                      tracer.closest_hits(rays, {&hits_[begin * kRays], rays.size()});
                    });
    for (std::size_t place = 0; place < count(); ++place) {
      const auto first = hits_.begin() + static_cast<std::ptrdiff_t>(place * kRays);
      open_[place] = std::any_of(first, first + kRays,
                                 [&](const Hit& hit) { return hit.missed() || emits(hit); });
    }
  }

  /// Finds which neighbours see each other.
  void look_across() {
    std::vector<Ray> rays(joined_.size());
    for (std::size_t place = 0; place < count(); ++place) {
      const ivec3 here = coords(place);
      for (int axis = 0; axis < kAxes; ++axis) {
        ivec3 there = here;
        ++there[axis];
        // A ray without length stands in for the neighbours that the last places do not have
        there = min(there, grid_.count - 1);
        const vec3 from = position(here), way = position(there) - from;
        const float distance = length(way);
        rays[place * kAxes + axis] = {from, 0.0f, distance > 0.0f ? way / distance : vec3(0, 1, 0),
                                      distance, kRayOfProbe};
      }
    }
    const RayTracer& tracer = world_.tracer();
    parallel_chunks(
        rays.size(), batch_of(tracer, 1, kPlacesPerTask * kAxes),
        [&](std::size_t begin, std::size_t end) {
          tracer.occlusions({&rays[begin], end - begin}, {&joined_[begin], end - begin});
        });
    for (std::size_t i = 0; i < rays.size(); ++i) {
      joined_[i] = joined_[i] == 0 && rays[i].t_max > 0.0f ? 1 : 0;
    }
  }

  /// Opens the places around each point and spot light that see it.
  void mark_lights() {
    for (const Light& light : world_.scene().lights) {
      if (light.type == Light::Type::directional) continue;
      const vec3 cells = ((light.position_ws - grid_.origin_ws) * grid_.axes) / grid_.spacing;
      const ivec3 base = clamp(ivec3(floor(cells)), ivec3(0), grid_.count - 2);
      for (int corner = 0; corner < kCorners; ++corner) {
        const ivec3 at = base + ivec3(corner & 1, corner >> 1 & 1, corner >> 2);
        const vec3 from = position(at), way = light.position_ws - from;
        const float distance = length(way);
        const bool seen = distance == 0.0f || !world_.tracer().occluded({from, 0.0f, way / distance,
                                                                         distance, kRayOfProbe});
        if (seen) open_[at.x * stride(0) + at.y * stride(1) + at.z * stride(2)] = 1;
      }
    }
  }

  /// Opens all places that are joined to an open one.
  void spread() {
    std::vector<std::size_t> front;
    for (std::size_t place = 0; place < count(); ++place) {
      if (open_[place] != 0) front.push_back(place);
    }
    const auto open = [&](std::size_t place) {
      if (open_[place] != 0) return;
      open_[place] = 1;
      front.push_back(place);
    };
    while (!front.empty()) {
      const std::size_t place = front.back();
      front.pop_back();
      const ivec3 here = coords(place);
      for (int axis = 0; axis < kAxes; ++axis) {
        if (joined_[place * kAxes + axis] != 0) open(place + stride(axis));
        if (here[axis] == 0) continue;
        const std::size_t before = place - stride(axis);
        if (joined_[before * kAxes + axis] != 0) open(before);
      }
    }
  }

  const World& world_;
  const PlaceGrid& grid_;
  std::vector<Hit> hits_;             // kRays a place
  std::vector<std::uint8_t> open_;    // 1: open
  std::vector<std::uint8_t> joined_;  // 1: sees the next place along an axis; kAxes a place
};

/// The sides that bound solid matter if nothing but a surface's winding is known.
std::uint32_t sides_by_winding(const Scene& scene, const Instance& instance) {
  return scene.materials[scene.meshes[instance.mesh].material].double_sided ? 0u : kSolidBack;
}

}  // namespace

SolidSides find_solid_sides(const World& world, std::span<const PlaceGrid> grids) {
  const Scene& scene = world.scene();
  std::vector<Places> places;
  for (const PlaceGrid& grid : grids) places.emplace_back(world, grid);
  const bool all = std::none_of(places.begin(), places.end(),
                                [](const Places& some) { return some.any_open(); });

  // Count what open space sees of each triangle
  std::vector<std::vector<Sightings>> triangles(scene.instances.size());
  std::vector<Sightings> instances(scene.instances.size());
  for (const Places& some : places) {
    some.for_each_sighting(all, [&](const Hit& hit) {
      std::vector<Sightings>& seen = triangles[hit.instance];
      seen.resize(scene.meshes[scene.instances[hit.instance].mesh].triangles.size());
      seen[hit.triangle].add(hit.front_face);
      instances[hit.instance].add(hit.front_face);
    });
  }

  SolidSides sides = no_solid_sides(scene);
  for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
    const Instance& instance = scene.instances[i];
    const std::uint32_t otherwise = instances[i].all() >= kMinSightings
                                        ? instances[i].solid_sides()
                                        : sides_by_winding(scene, instance);
    const auto count = static_cast<std::uint32_t>(scene.meshes[instance.mesh].triangles.size());
    for (std::uint32_t t = 0; t < count; ++t) {
      const bool known = t < triangles[i].size() && triangles[i][t].all() >= kMinSightings;
      sides.set(i, t, known ? triangles[i][t].solid_sides() : otherwise);
    }
  }
  return sides;
}

}  // namespace lambent
