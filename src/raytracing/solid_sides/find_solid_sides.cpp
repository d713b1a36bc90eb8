// SPDX-License-Identifier: Apache-2.0
#include "raytracing/solid_sides/find_solid_sides.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "raytracing/places/places.h"
#include "raytracing/places/wall_heading.h"
#include "scene/transmission.h"

namespace lambent {
namespace {

// Fewer sightings of a triangle, or of an instance, prove nothing: rays pass through cracks.
constexpr std::uint32_t kMinSightings = 4;
// A surface that open space sees from one side in this share of the sightings or more bounds solid
// matter with its other side. The rest is due to cracks and to places that straddle a wall.
constexpr float kOneSided = 0.9f;

// Where this share of a scene's open places is enclosed, the scene is a room or a building seen
// from within, and views from outside count only if the caller says so.
constexpr float kMinRoomShare = 0.6f;
// A field extends beyond the scene if it has places this far from it [its spacing]: less may be a
// margin of rounding, or of a box that was given in round numbers.
constexpr float kLeastBeyond = 0.1f;
// Approximate number of places of the grid over the whole scene, and of the one that also covers
// its surroundings.
constexpr float kScenePlaces = 2048.0f, kPlacesAround = 512.0f;
// Limit for flat scenes, whose places would all lie along the longer axes.
constexpr int kMaxPlacesAlongAxis = 64;
// Margin of the second grid around the scene, as a share of the scene's longest side, and its least
// size [m]: objects can only be seen from outside.
constexpr float kAround = 0.1f, kLeastAround = 1e-3f;

/// Opens the regions of each grid that lead to open places of another one, over however many grids.
void open_across(std::span<Places> places) {
  // Grids are asked again as long as others have opened
  std::vector<std::uint8_t> opened(places.size(), 1);
  while (std::ranges::find(opened, 1) != opened.end()) {
    const std::vector<std::uint8_t> asked =
        std::exchange(opened, std::vector<std::uint8_t>(places.size(), 0));
    for (std::size_t i = 0; i < places.size(); ++i) {
      for (std::size_t other = 0; other < places.size(); ++other) {
        if (asked[other] == 0 || other == i) continue;
        if (places[i].open_towards(places[other])) opened[i] = 1;
      }
    }
  }
}

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

/// The grid over a whole scene, turned as its walls are: of a building that stands askew in its
/// bounds, half of the places would be outside.
PlaceGrid grid_over_scene(const Scene& scene, const Bounds& bounds) {
  const glm::mat3 axes = axes_of_walls(scene);
  if (axes == glm::mat3(1.0f)) return grid_over(bounds, kScenePlaces);
  PlaceGrid grid = grid_over(bounds_along(scene, axes), kScenePlaces);
  grid.axes = axes;
  grid.origin_ws = axes * grid.origin_ws;
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

/// The votes of places of which some are open. In a room, sightings from within decide first.
std::vector<Votes> votes_of_open(const Scene& scene, std::span<const Places> places, bool room) {
  std::vector<Votes> votes;
  votes.emplace_back(scene, places, room ? Voters::enclosed : Voters::open);
  if (room) votes.emplace_back(scene, places, Voters::exposed);
  return votes;
}

/// Whether a hit is on a wall of a room that may be dark: on the front of a single-sided triangle
/// whose back open space does not see. Solid matter is bounded by backs, or, where a mesh is wound
/// the wrong way, by fronts whose backs are seen. Triangles of fine meshes are seen too seldom;
/// what is seen of their instance then counts.
bool is_wall_of_room(const Scene& scene, const Votes& votes, const Hit& hit) {
  const Material& material =
      scene.materials[scene.meshes[scene.instances[hit.instance].mesh].material];
  if (!hit.front_face || material.double_sided) return false;
  const std::vector<Sightings>& seen = votes.triangles[hit.instance];
  const bool known = hit.triangle < seen.size() && seen[hit.triangle].all() >= kMinSightings;
  if (known) return seen[hit.triangle].back < kMinSightings;
  const Sightings& all = votes.instances[hit.instance];
  return all.all() < kMinSightings || all.solid_sides() == kSolidBack;
}

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
                            bool outside_counts, std::span<const OpenPlaces> before) {
  const Scene& scene = world.scene();
  std::vector<Places> places;
  const Bounds bounds = world_bounds(scene), wide = widened(bounds);
  // A flat scene has no volume within its bounds
  const bool flat = glm::any(glm::lessThanEqual(bounds.max, bounds.min));
  places.emplace_back(world, flat ? grid_over(wide, kScenePlaces) : grid_over_scene(scene, bounds));
  places.emplace_back(world, grid_over(wide, kPlacesAround));
  const bool room = places.front().enclosed_share() >= kMinRoomShare;
  const std::size_t of_scene = grids.empty() ? 0 : places.size();
  for (const PlaceGrid& grid : grids) places.emplace_back(world, grid);
  for (std::size_t i = 0; i < std::min(places.size(), before.size()); ++i) {
    places[i].keep_open(before[i]);
  }
  open_across(places);
  // A field in which no place is open was not put into solid matter: its lamps are off
  const std::span<const Places> asked = std::span(places).subspan(of_scene);
  const bool some_open =
      std::any_of(asked.begin(), asked.end(), [](const Places& some) { return some.any_open(); });

  // Count sightings from open space, and again if there are rooms in which no light is on
  std::vector<Votes> votes;
  if (some_open) {
    votes = votes_of_open(scene, places, room);
    bool dark_rooms = false;
    for (Places& some : places) {
      dark_rooms |= some.open_rooms(
          [&](const Hit& hit) { return is_wall_of_room(scene, votes.front(), hit); });
    }
    if (dark_rooms) {
      open_across(places);
      votes = votes_of_open(scene, places, room);
    }
  } else {
    votes.emplace_back(scene, asked, Voters::all);
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
