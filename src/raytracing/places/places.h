// SPDX-License-Identifier: Apache-2.0
// Sample places of a scene's air, what their rays hit, and which of them are in open space.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "lambent/world.h"
#include "raytracing/raytracer.h"
#include "raytracing/solid_sides/solid_sides.h"

namespace lambent {

/// The places whose sightings count: all; the open ones; and of these, the enclosed ones or the
/// others.
enum class Voters { all, open, enclosed, exposed };

/// The places of a grid, the hits of their rays, and which of them are open. Places are open where
/// rays leave the scene or hit emissive surfaces, where a lamp shines, and where a chain of
/// neighbouring, mutually visible places leads to such a place.
class Places {
 public:
  Places(const World& world, const PlaceGrid& grid);

  OpenPlaces take_open() && { return {grid_, std::move(open_)}; }
  bool any_open() const;
  /// The share of the open places that are enclosed; 0 where none is open.
  float enclosed_share() const;

  /// Opens the regions most of which were open before, with the same scene but for its lights: a
  /// room whose lamp is off is still a room.
  void keep_open(const OpenPlaces& before);
  /// Opens the regions of which some places see open places of another grid: a tunnel may lead to
  /// open space beyond the box of its grid. Returns whether there are any.
  bool open_towards(const Places& other);
  /// Opens the regions of which nearly all rays hit walls, `is_wall(hit)`: dark rooms. Returns
  /// whether there are any.
  bool open_rooms(const std::function<bool(const Hit&)>& is_wall);

  /// Calls `see` with all hits of the chosen places.
  template <class See>
  void for_each_sighting(Voters voters, See see) const {
    for (std::size_t place = 0; place < count(); ++place) {
      if (voters != Voters::all && open_[place] == 0) continue;
      if (voters == Voters::enclosed && !is_enclosed(place)) continue;
      if (voters == Voters::exposed && is_enclosed(place)) continue;
      for (std::size_t i = 0; i < kRays; ++i) {
        const Hit& hit = hits_[place * kRays + i];
        if (!hit.missed()) see(hit);
      }
    }
  }

 private:
  // Rays from each place.
  static constexpr std::size_t kRays = 32;

  std::size_t count() const;
  std::size_t stride(int axis) const;
  bool is_enclosed(std::size_t place) const;
  bool emits(const Hit& hit) const;

  /// Traces rays from each place, and counts those that leave the scene or hit a lamp.
  void look_around();
  /// Tests which neighbouring places are mutually visible.
  void look_across();
  /// Counts so many rays as leaving for the places next to each of some points in open space, from
  /// which the point is visible.
  void mark_around(std::span<const vec3> points_ws, std::uint32_t rays);
  /// Marks the places around point and spot lights.
  void mark_lights();
  /// Marks the places around points_lit_by_emitters(). Small lamps in shades are hit by none of the
  /// places' rays.
  void mark_emitters();
  /// Opens the regions of connected places that enough rays leave.
  void open_regions();
  /// Finds all places that are connected to the first one, directly or through others.
  void find_region(std::size_t first, std::vector<std::uint8_t>& visited,
                   std::vector<std::size_t>& region) const;

  const World& world_;
  PlaceGrid grid_;
  std::vector<Hit> hits_;               // kRays for each place
  std::vector<std::uint32_t> leaving_;  // number of rays that leave the scene or hit a lamp
  std::vector<std::uint8_t> open_;      // 1: open
  std::vector<std::uint32_t> region_;   // the region of connected places to which each belongs
  std::size_t regions_ = 0;             // their number
  std::vector<std::uint8_t> joined_;  // 1: sees the next place along an axis; kAxes for each place
};

/// A ray from a place to a point; of length 0 where both are the same.
Ray ray_between(const vec3& place_ws, const vec3& point_ws);

/// Points in the light of emissive surfaces, in front of some that are chosen by their power.
std::vector<vec3> points_lit_by_emitters(const World& world);

/// Whether one of some points, at which lights shine, is in a closed region: of the places around
/// it, it sees closed ones alone.
bool lights_closed_places(const World& world, std::span<const OpenPlaces> open_space,
                          std::span<const vec3> points_ws);

/// For each point, 1 where it sees one of the open places around it, so that light can reach it.
std::vector<std::uint8_t> see_open_places(const World& world,
                                          std::span<const OpenPlaces> open_space,
                                          std::span<const vec3> points_ws);

}  // namespace lambent
