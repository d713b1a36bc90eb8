// SPDX-License-Identifier: Apache-2.0
#include "raytracing/find_solid_sides.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "core/parallel.h"
#include "raytracing/raytracer.h"
#include "raytracing/world_access.h"
#include "scene/transmission.h"
#include "shared/sampling.h"

namespace lambent {
namespace {

// Rays from each place. A room's lamp or window is found if one of its hundreds of places sees it.
constexpr int kRays = 32;
constexpr std::size_t kPlacesPerTask = 64;
// Neighbours of a place towards larger coordinates, one along each axis.
constexpr int kAxes = 3;
// A region of connected places is open if at least kMinLeaving of its rays leave the scene, and
// at least one in kRaysOfLeaving: single rays slip through cracks between triangles.
constexpr std::size_t kMinLeaving = 4;
constexpr std::size_t kRaysOfLeaving = 5000;
// Fewer sightings of a triangle, or of an instance, prove nothing: rays pass through cracks.
constexpr std::uint32_t kMinSightings = 4;
// A surface that open space sees from one side in this share of the sightings or more bounds solid
// matter with its other side. The rest is due to cracks and to places that straddle a wall.
constexpr float kOneSided = 0.9f;

// Greatest slope of the rays that find out whether a place has walls around it. Ceilings are
// ignored, so that courts and roofless models count.
constexpr float kMaxWallSlope = 0.5f;
// A place is enclosed where at least this share of those rays hits a surface: there may be a window
// or a door.
constexpr float kMinEnclosed = 0.75f;
// Where this share of a scene's open places is enclosed, the scene is a room or a building seen
// from within, and views from outside count only if the caller says so.
constexpr float kMinRoomShare = 0.6f;
// A field extends beyond the scene if it has places this far from it [its spacing]: less may be a
// margin of rounding, or of a box that was given in round numbers.
constexpr float kLeastBeyond = 0.1f;
// Offset of places from the grid, into its hull [places]: scenes and grids are made in round
// numbers, and a place in a wall's own plane would be on either side of it by chance.
const vec3 kOffPlanes(0.437f, 0.511f, 0.473f);
// Approximate number of places of the grid over the whole scene, and of the one that also covers
// its surroundings.
constexpr float kScenePlaces = 2048.0f, kPlacesAround = 512.0f;
// Limit for flat scenes, whose places would all lie along the longer axes.
constexpr int kMaxPlacesAlongAxis = 64;
// Margin of the second grid around the scene, as a share of the scene's longest side, and its least
// size [m]: objects can only be seen from outside.
constexpr float kAround = 0.1f, kLeastAround = 1e-3f;

/// Number of times that open space saw the front and the back of a triangle or an instance.
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

/// The places whose sightings count: all; the open ones; and of these, the enclosed ones or the
/// others.
enum class Voters { all, open, enclosed, exposed };

/// The places of a grid, the hits of their rays, and which of them are open.
class Places {
 public:
  Places(const World& world, const PlaceGrid& grid)
      : world_(world),
        grid_(grid),
        leaving_(count(), 0),
        open_(count(), 0),
        joined_(kAxes * count(), 0) {
    look_around();
    look_across();
    mark_lights();
    open_regions();
  }

  OpenPlaces take_open() && { return {grid_, std::move(open_)}; }

  bool any_open() const {
    return std::any_of(open_.begin(), open_.end(), [](std::uint8_t open) { return open != 0; });
  }

  /// The share of the open places that are enclosed; 0 where none is open.
  float enclosed_share() const {
    float open = 0.0f, enclosed = 0.0f;
    for (std::size_t place = 0; place < count(); ++place) {
      if (open_[place] == 0) continue;
      open += 1.0f;
      enclosed += is_enclosed(place) ? 1.0f : 0.0f;
    }
    return open > 0.0f ? enclosed / open : 0.0f;
  }

  /// Calls `see` with all hits of the chosen places.
  template <class See>
  void for_each_sighting(Voters voters, See see) const {
    for (std::size_t place = 0; place < count(); ++place) {
      if (voters != Voters::all && open_[place] == 0) continue;
      if (voters == Voters::enclosed && !is_enclosed(place)) continue;
      if (voters == Voters::exposed && is_enclosed(place)) continue;
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
    const vec3 cells = (coords + kOffPlanes) * vec3(grid_.count - 1) / vec3(grid_.count);
    return grid_.origin_ws + grid_.axes * (grid_.spacing * cells);
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

  bool is_enclosed(std::size_t place) const {
    float rays = 0.0f, met = 0.0f;
    for (uint i = 0; i < kRays; ++i) {
      if (std::abs(spherical_fibonacci(i, kRays).y) > kMaxWallSlope) continue;
      rays += 1.0f;
      met += hits_[place * kRays + i].missed() ? 0.0f : 1.0f;
    }
    return met >= kMinEnclosed * rays;
  }

  bool emits(const Hit& hit) const {
    const Scene& scene = world_.scene();
    const Material& material =
        scene.materials[scene.meshes[scene.instances[hit.instance].mesh].material];
    return material.emission != vec3(0.0f);
  }

  /// Traces rays from each place, and counts those that leave the scene or hit a lamp.
  void look_around() {
    hits_.resize(kRays * count());
    std::vector<vec3> directions;
    for (uint i = 0; i < kRays; ++i) directions.push_back(spherical_fibonacci(i, kRays));
    const RayTracer& tracer = tracer_of(world_);
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
      const std::span<const Hit> seen = std::span(hits_).subspan(place * kRays, kRays);
      leaving_[place] = static_cast<std::uint32_t>(std::count_if(
          seen.begin(), seen.end(), [&](const Hit& hit) { return hit.missed() || emits(hit); }));
    }
  }

  /// Tests which neighbouring places are mutually visible.
  void look_across() {
    std::vector<Ray> rays(joined_.size());
    for (std::size_t place = 0; place < count(); ++place) {
      const ivec3 here = coords(place);
      for (int axis = 0; axis < kAxes; ++axis) {
        ivec3 there = here;
        ++there[axis];
        // The last places lack neighbours: a ray of length 0 stands in
        there = min(there, grid_.count - 1);
        const vec3 from = position(here), way = position(there) - from;
        const float distance = length(way);
        rays[place * kAxes + axis] = {from, 0.0f, distance > 0.0f ? way / distance : vec3(0, 1, 0),
                                      distance, kRayOfProbe};
      }
    }
    const RayTracer& tracer = tracer_of(world_);
    parallel_chunks(
        rays.size(), batch_of(tracer, 1, kPlacesPerTask * kAxes),
        [&](std::size_t begin, std::size_t end) {
          tracer.occlusions({&rays[begin], end - begin}, {&joined_[begin], end - begin});
        });
    for (std::size_t i = 0; i < rays.size(); ++i) {
      joined_[i] = joined_[i] == 0 && rays[i].t_max > 0.0f ? 1 : 0;
    }
  }

  /// Counts all rays as leaving for places next to a point or spot light from which it is visible.
  void mark_lights() {
    for (const Light& light : world_.scene().lights) {
      if (light.type == Light::Type::directional) continue;
      for (const std::size_t place : grid_.places_around(light.position_ws)) {
        const vec3 from = position(coords(place)), way = light.position_ws - from;
        const float distance = length(way);
        const Ray ray = {from, 0.0f, way / distance, distance, kRayOfProbe};
        if (distance == 0.0f || !tracer_of(world_).occluded(ray)) leaving_[place] += kRays;
      }
    }
  }

  /// Opens the regions of connected places that enough rays leave.
  void open_regions() {
    std::vector<std::uint8_t> visited(count(), 0);
    std::vector<std::size_t> region;
    for (std::size_t first = 0; first < count(); ++first) {
      if (visited[first] != 0) continue;
      find_region(first, visited, region);
      std::size_t leaving = 0;
      for (const std::size_t place : region) leaving += leaving_[place];
      const bool open = leaving >= kMinLeaving && leaving * kRaysOfLeaving >= region.size() * kRays;
      for (const std::size_t place : region) open_[place] = open ? 1 : 0;
    }
  }

  /// Finds all places that are connected to the first one, directly or through others.
  void find_region(std::size_t first, std::vector<std::uint8_t>& visited,
                   std::vector<std::size_t>& region) const {
    region.assign(1, first);
    visited[first] = 1;
    const auto visit = [&](std::size_t place) {
      if (visited[place] != 0) return;
      visited[place] = 1;
      region.push_back(place);
    };
    for (std::size_t next = 0; next < region.size(); ++next) {
      const std::size_t place = region[next];
      const ivec3 here = coords(place);
      for (int axis = 0; axis < kAxes; ++axis) {
        if (joined_[place * kAxes + axis] != 0) visit(place + stride(axis));
        if (here[axis] == 0) continue;
        const std::size_t before = place - stride(axis);
        if (joined_[before * kAxes + axis] != 0) visit(before);
      }
    }
  }

  const World& world_;
  PlaceGrid grid_;
  std::vector<Hit> hits_;               // kRays for each place
  std::vector<std::uint32_t> leaving_;  // number of rays that leave the scene or hit a lamp
  std::vector<std::uint8_t> open_;      // 1: open
  std::vector<std::uint8_t> joined_;  // 1: sees the next place along an axis; kAxes for each place
};

/// A grid of about `places` places over a box.
PlaceGrid grid_over(const Bounds& box, float places) {
  const vec3 size = box.max - box.min;
  const float spacing = std::cbrt(size.x * size.y * size.z / places);
  PlaceGrid grid;
  grid.count = clamp(ivec3(size / spacing), ivec3(2), ivec3(kMaxPlacesAlongAxis));
  grid.spacing = size / vec3(grid.count - 1);
  grid.origin_ws = box.min;
  return grid;
}

/// A box enlarged by the margin around the scene.
Bounds widened(const Bounds& box) {
  const vec3 size = box.max - box.min;
  const float around = std::max(kAround * std::max({size.x, size.y, size.z}), kLeastAround);
  return {box.min - around, box.max + around};
}

/// Whether a grid has places outside of a box.
bool reaches_out_of(const Bounds& box, const PlaceGrid& grid) {
  const float least = kLeastBeyond * std::min({grid.spacing.x, grid.spacing.y, grid.spacing.z});
  for (int corner = 0; corner < 8; ++corner) {
    const ivec3 upper(corner & 1, corner >> 1 & 1, corner >> 2);
    const vec3 at = grid.origin_ws + grid.axes * (grid.spacing * vec3(upper * (grid.count - 1)));
    if (glm::any(glm::greaterThan(max(box.min - at, at - box.max), vec3(least)))) return true;
  }
  return false;
}

/// The sides that bound solid matter according to a surface's winding alone.
std::uint32_t sides_by_winding(const Scene& scene, const Instance& instance) {
  return scene.materials[scene.meshes[instance.mesh].material].double_sided ? 0u : kSolidBack;
}

/// Sightings of each triangle and of each instance, from the chosen places.
struct Votes {
  Votes(const Scene& scene, std::span<const Places> places, Voters voters)
      : triangles(scene.instances.size()), instances(scene.instances.size()) {
    for (const Places& some : places) {
      some.for_each_sighting(voters, [&](const Hit& hit) {
        std::vector<Sightings>& seen = triangles[hit.instance];
        seen.resize(scene.meshes[scene.instances[hit.instance].mesh].triangles.size());
        seen[hit.triangle].add(hit.front_face);
        instances[hit.instance].add(hit.front_face);
      });
    }
  }

  std::vector<std::vector<Sightings>> triangles;  // empty where an instance was never seen
  std::vector<Sightings> instances;
};

/// The sides of a triangle that bound solid matter, by the first votes with sightings of it or at
/// least of its instance; none where there are no sightings of either. Few triangles of a wall are
/// seen so seldom from within a room that sightings from outside would be better.
std::optional<std::uint32_t> judge(std::span<const Votes> votes, std::uint32_t instance,
                                   std::uint32_t triangle) {
  for (const Votes& some : votes) {
    const std::vector<Sightings>& seen = some.triangles[instance];
    if (triangle < seen.size() && seen[triangle].all() >= kMinSightings) {
      return seen[triangle].solid_sides();
    }
    if (some.instances[instance].all() >= kMinSightings) {
      return some.instances[instance].solid_sides();
    }
  }
  return std::nullopt;
}

/// The sides of a triangle that are solid by `sides` and by other votes. Where the others have
/// sightings of the instance alone, these count only if they are of one side.
std::uint32_t solid_in_both(std::uint32_t sides, const Votes& others, std::uint32_t instance,
                            std::uint32_t triangle) {
  const std::vector<Sightings>& seen = others.triangles[instance];
  const bool known = triangle < seen.size() && seen[triangle].all() >= kMinSightings;
  if (known) return sides & seen[triangle].solid_sides();
  const Sightings& all = others.instances[instance];
  const bool one_sided = all.all() >= kMinSightings && all.solid_sides() != 0u;
  return one_sided ? sides & all.solid_sides() : sides;
}

}  // namespace

bool reach_out_of_scene(const World& world, std::span<const PlaceGrid> grids) {
  const Bounds bounds = world_bounds(world.scene());
  return std::any_of(grids.begin(), grids.end(),
                     [&](const PlaceGrid& grid) { return reaches_out_of(bounds, grid); });
}

SolidSides find_solid_sides(const World& world, std::span<const PlaceGrid> grids,
                            bool outside_counts) {
  const Scene& scene = world.scene();
  std::vector<Places> places;
  const Bounds bounds = world_bounds(scene), wide = widened(bounds);
  // A flat scene has no volume within its bounds
  const bool flat = glm::any(glm::lessThanEqual(bounds.max, bounds.min));
  places.emplace_back(world, grid_over(flat ? wide : bounds, kScenePlaces));
  places.emplace_back(world, grid_over(wide, kPlacesAround));
  const bool room = places.front().enclosed_share() >= kMinRoomShare;
  const std::size_t of_scene = grids.empty() ? 0 : places.size();
  for (const PlaceGrid& grid : grids) places.emplace_back(world, grid);
  // A field in which no place is open was not put into solid matter: its lamps are off
  const std::span<const Places> asked = std::span(places).subspan(of_scene);
  const bool some_open =
      std::any_of(asked.begin(), asked.end(), [](const Places& some) { return some.any_open(); });

  // Count sightings from open space. In a room, those from within decide first
  std::vector<Votes> votes;
  if (!some_open) {
    votes.emplace_back(scene, asked, Voters::all);
  } else if (room) {
    votes.emplace_back(scene, places, Voters::enclosed);
    votes.emplace_back(scene, places, Voters::exposed);
  } else {
    votes.emplace_back(scene, places, Voters::open);
  }

  SolidSides sides = no_solid_sides(scene);
  for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
    const Instance& instance = scene.instances[i];
    // Light reaches both sides of glass
    if (is_transmissive(scene.materials[scene.meshes[instance.mesh].material])) continue;
    const auto count = static_cast<std::uint32_t>(scene.meshes[instance.mesh].triangles.size());
    for (std::uint32_t t = 0; t < count; ++t) {
      std::uint32_t solid = judge(votes, i, t).value_or(sides_by_winding(scene, instance));
      if (outside_counts && votes.size() > 1) solid = solid_in_both(solid, votes.back(), i, t);
      sides.set(i, t, solid);
    }
  }
  for (Places& some : places) sides.open_space.push_back(std::move(some).take_open());
  return sides;
}

}  // namespace lambent
