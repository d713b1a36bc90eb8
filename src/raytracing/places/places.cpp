// SPDX-License-Identifier: Apache-2.0
#include "raytracing/places/places.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "core/parallel.h"
#include "raytracing/trace_rays.h"
#include "raytracing/world_access.h"
#include "scene/light_sampling.h"
#include "shared/random.h"
#include "shared/rays.h"
#include "shared/sampling.h"

namespace lambent {
namespace {

constexpr std::size_t kPlacesPerTask = 64;
// Neighbours of a place towards larger coordinates, one along each axis.
constexpr int kAxes = 3;
// A region of connected places is open if at least kMinLeaving of its rays leave the scene, and
// at least one in kRaysOfLeaving: single rays slip through cracks between triangles.
constexpr std::size_t kMinLeaving = 4;
constexpr std::size_t kRaysOfLeaving = 5000;

// A closed region is open, too, if at least kMinSeeing of its places see open ones of another grid,
// and one in kPlacesOfSeeing of those that are within that grid: single ones see through cracks.
constexpr std::size_t kMinSeeing = 4;
constexpr std::size_t kPlacesOfSeeing = 50;

// Greatest slope of the rays that find out whether a place has walls around it. Ceilings are
// ignored, so that courts and roofless models count.
constexpr float kMaxWallSlope = 0.5f;
// A place is enclosed where at least this share of those rays hits a surface: there may be a window
// or a door.
constexpr float kMinEnclosed = 0.75f;

// Share of a closed region's hits that are on walls if it is a room, as large as what makes a
// surface one-sided (find_solid_sides.cpp). The others are seen through cracks, or are on things in
// the room that are wound the wrong way.
constexpr float kLeastWalls = 0.9f;

// Number of points on emissive surfaces, chosen by their power, that rays leave to either side, and
// of these rays: some leave a shade, however deep it is. What is halfway along a ray is lit.
constexpr int kEmitterPoints = 64, kEmitterRays = 4;
constexpr float kHalfway = 0.5f;
// Seed of their random numbers.
constexpr std::uint32_t kEmitterSeed = 5;

}  // namespace

Ray ray_between(const vec3& place_ws, const vec3& point_ws) {
  const vec3 way = point_ws - place_ws;
  const float distance = length(way);
  const vec3 direction = distance > 0.0f ? way / distance : vec3(0, 1, 0);
  return {place_ws, 0.0f, direction, distance, kRayOfProbe};
}

Places::Places(const World& world, const PlaceGrid& grid)
    : world_(world),
      grid_(grid),
      leaving_(count(), 0),
      open_(count(), 0),
      region_(count(), 0),
      joined_(kAxes * count(), 0) {
  look_around();
  look_across();
  mark_lights();
  mark_emitters();
  open_regions();
}

void Places::keep_open(const OpenPlaces& before) {
  if (before.grid != grid_) return;
  std::vector<std::size_t> all(regions_, 0), open(regions_, 0);
  for (std::size_t place = 0; place < count(); ++place) {
    ++all[region_[place]];
    open[region_[place]] += before.open[place];
  }
  for (std::size_t place = 0; place < count(); ++place) {
    if (2 * open[region_[place]] > all[region_[place]]) open_[place] = 1;
  }
}

bool Places::open_towards(const Places& other) {
  std::vector<Ray> ways;
  std::vector<std::size_t> from;  // the place of each way
  for (std::size_t place = 0; place < count(); ++place) {
    const vec3 here = grid_.position_ws(grid_.coords(place));
    if (open_[place] != 0 || !other.grid_.contains(here)) continue;
    for (const std::size_t there : other.grid_.places_around(here)) {
      if (other.open_[there] == 0) continue;
      ways.push_back(ray_between(other.grid_.position_ws(other.grid_.coords(there)), here));
      from.push_back(place);
    }
  }
  if (ways.empty()) return false;
  const std::vector<std::uint8_t> occluded = trace_occlusion(world_, ways);
  // Count the places that see an open one: the ways of each stand together
  std::vector<std::size_t> all(regions_, 0), seeing(regions_, 0);
  for (std::size_t i = 0; i < ways.size();) {
    const std::size_t place = from[i];
    bool sees = false;
    for (; i < ways.size() && from[i] == place; ++i) {
      sees |= occluded[i] == 0 || ways[i].t_max == 0.0f;
    }
    ++all[region_[place]];
    seeing[region_[place]] += sees ? 1 : 0;
  }
  bool any = false;
  for (std::size_t place = 0; place < count(); ++place) {
    const std::uint32_t region = region_[place];
    if (open_[place] != 0 || seeing[region] < kMinSeeing ||
        seeing[region] * kPlacesOfSeeing < all[region]) {
      continue;
    }
    open_[place] = 1;
    any = true;
  }
  return any;
}

bool Places::open_rooms(const std::function<bool(const Hit&)>& is_wall) {
  std::vector<std::size_t> met(regions_, 0), walls(regions_, 0);
  for (std::size_t i = 0; i < hits_.size(); ++i) {
    if (hits_[i].missed() || open_[i / kRays] != 0) continue;
    const std::uint32_t region = region_[i / kRays];
    ++met[region];
    walls[region] += is_wall(hits_[i]) ? 1 : 0;
  }
  bool any = false;
  for (std::size_t place = 0; place < count(); ++place) {
    const auto hits = static_cast<float>(met[region_[place]]);
    const auto on_walls = static_cast<float>(walls[region_[place]]);
    if (hits == 0.0f || on_walls < kLeastWalls * hits) continue;
    open_[place] = 1;
    any = true;
  }
  return any;
}

bool Places::any_open() const {
  return std::any_of(open_.begin(), open_.end(), [](std::uint8_t open) { return open != 0; });
}

float Places::enclosed_share() const {
  float open = 0.0f, enclosed = 0.0f;
  for (std::size_t place = 0; place < count(); ++place) {
    if (open_[place] == 0) continue;
    open += 1.0f;
    enclosed += is_enclosed(place) ? 1.0f : 0.0f;
  }
  return open > 0.0f ? enclosed / open : 0.0f;
}

std::size_t Places::count() const {
  return static_cast<std::size_t>(grid_.count.x) * grid_.count.y * grid_.count.z;
}

std::size_t Places::stride(int axis) const {
  const std::size_t x = grid_.count.x;
  return axis == 0 ? 1 : axis == 1 ? x : x * grid_.count.y;
}

bool Places::is_enclosed(std::size_t place) const {
  float rays = 0.0f, met = 0.0f;
  for (uint i = 0; i < kRays; ++i) {
    if (std::abs(spherical_fibonacci(i, kRays).y) > kMaxWallSlope) continue;
    rays += 1.0f;
    met += hits_[place * kRays + i].missed() ? 0.0f : 1.0f;
  }
  return met >= kMinEnclosed * rays;
}

bool Places::emits(const Hit& hit) const {
  const Scene& scene = world_.scene();
  const Material& material =
      scene.materials[scene.meshes[scene.instances[hit.instance].mesh].material];
  return material.emission != vec3(0.0f);
}

void Places::look_around() {
  hits_.resize(kRays * count());
  std::vector<vec3> directions;
  for (uint i = 0; i < kRays; ++i) directions.push_back(spherical_fibonacci(i, kRays));
  const RayTracer& tracer = tracer_of(world_);
  parallel_chunks(count(), batch_of(tracer, kRays, kPlacesPerTask),
                  [&](std::size_t begin, std::size_t end) {
                    std::vector<Ray> rays;
                    for (std::size_t place = begin; place < end; ++place) {
                      const vec3 origin = grid_.position_ws(grid_.coords(place));
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

void Places::look_across() {
  std::vector<Ray> rays(joined_.size());
  for (std::size_t place = 0; place < count(); ++place) {
    const ivec3 here = grid_.coords(place);
    for (int axis = 0; axis < kAxes; ++axis) {
      ivec3 there = here;
      ++there[axis];
      // The last places lack neighbours: a ray of length 0 stands in
      there = min(there, grid_.count - 1);
      rays[place * kAxes + axis] = ray_between(grid_.position_ws(here), grid_.position_ws(there));
    }
  }
  joined_ = trace_occlusion(world_, rays);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    joined_[i] = joined_[i] == 0 && rays[i].t_max > 0.0f ? 1 : 0;
  }
}

void Places::mark_around(std::span<const vec3> points_ws, std::uint32_t rays) {
  std::vector<Ray> ways;
  std::vector<std::size_t> places;
  for (const vec3& point : points_ws) {
    for (const std::size_t place : grid_.places_around(point)) {
      ways.push_back(ray_between(grid_.position_ws(grid_.coords(place)), point));
      places.push_back(place);
    }
  }
  const std::vector<std::uint8_t> occluded = trace_occlusion(world_, ways);
  for (std::size_t i = 0; i < ways.size(); ++i) {
    if (occluded[i] == 0 || ways[i].t_max == 0.0f) leaving_[places[i]] += rays;
  }
}

void Places::mark_lights() {
  std::vector<vec3> points;
  for (const Light& light : world_.scene().lights) {
    if (light.type != Light::Type::directional) points.push_back(light.position_ws);
  }
  mark_around(points, kRays);
}

void Places::mark_emitters() {
  mark_around(points_lit_by_emitters(world_), 1);
}

void Places::open_regions() {
  std::vector<std::uint8_t> visited(count(), 0);
  std::vector<std::size_t> region;
  for (std::size_t first = 0; first < count(); ++first) {
    if (visited[first] != 0) continue;
    find_region(first, visited, region);
    std::size_t leaving = 0;
    for (const std::size_t place : region) leaving += leaving_[place];
    const bool open = leaving >= kMinLeaving && leaving * kRaysOfLeaving >= region.size() * kRays;
    for (const std::size_t place : region) {
      open_[place] = open ? 1 : 0;
      region_[place] = static_cast<std::uint32_t>(regions_);
    }
    ++regions_;
  }
}

void Places::find_region(std::size_t first, std::vector<std::uint8_t>& visited,
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
    const ivec3 here = grid_.coords(place);
    for (int axis = 0; axis < kAxes; ++axis) {
      if (joined_[place * kAxes + axis] != 0) visit(place + stride(axis));
      if (here[axis] == 0) continue;
      const std::size_t before = place - stride(axis);
      if (joined_[before * kAxes + axis] != 0) visit(before);
    }
  }
}

std::vector<vec3> points_lit_by_emitters(const World& world) {
  const EmissiveTriangles& emissive = emissive_of(world);
  if (emissive.empty()) return {};
  std::vector<Ray> rays;
  for (uint i = 0; i < kEmitterPoints; ++i) {
    RandomStream random = make_random_stream(i, 0u, kEmitterSeed);
    const EmitterPick pick =
        emissive.pick((static_cast<float>(i) + next_uniform(random)) / kEmitterPoints);
    const EmitterRecord& emitter = emissive.entries()[pick.emitter];
    const vec2 at = sample_uniform_triangle(next_uniform2(random));
    const vec3 position_ws = emitter.corner_ws + at.x * emitter.edge1_ws + at.y * emitter.edge2_ws;
    const vec3 front = triangle_normal(emitter.edge1_ws, emitter.edge2_ws);
    for (int ray = 0; ray < 2 * kEmitterRays; ++ray) {
      const vec3 side = ray < kEmitterRays ? front : -front;
      const vec3 direction =
          to_world(make_frame(side), sample_cosine_hemisphere(next_uniform2(random)));
      rays.push_back(
          {offset_ray_origin(position_ws, side), 0.0f, direction, kInfiniteDistance, kRayOfProbe});
    }
  }
  const std::vector<Hit> hits = trace(world, rays);
  std::vector<vec3> points;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (hits[i].missed()) continue;
    points.push_back(rays[i].origin + kHalfway * hits[i].distance * rays[i].direction);
  }
  return points;
}

bool lights_closed_places(const World& world, std::span<const OpenPlaces> open_space,
                          std::span<const vec3> points_ws) {
  std::vector<Ray> ways;
  std::vector<std::uint8_t> open;
  for (const OpenPlaces& places : open_space) {
    for (const vec3& point : points_ws) {
      if (!places.grid.contains(point)) continue;
      for (const std::size_t place : places.grid.places_around(point)) {
        ways.push_back(ray_between(places.grid.position_ws(places.grid.coords(place)), point));
        open.push_back(places.open[place]);
      }
    }
  }
  const std::vector<std::uint8_t> occluded = trace_occlusion(world, ways);
  constexpr std::size_t kCorners = 8;  // places around each point
  for (std::size_t first = 0; first < ways.size(); first += kCorners) {
    bool sees_open = false, sees_closed = false;
    for (std::size_t i = first; i < first + kCorners; ++i) {
      if (occluded[i] == 0) (open[i] != 0 ? sees_open : sees_closed) = true;
    }
    if (sees_closed && !sees_open) return true;
  }
  return false;
}

std::vector<std::uint8_t> see_open_places(const World& world,
                                          std::span<const OpenPlaces> open_space,
                                          std::span<const vec3> points_ws) {
  std::vector<Ray> ways;
  std::vector<std::size_t> points;
  for (const OpenPlaces& places : open_space) {
    for (std::size_t i = 0; i < points_ws.size(); ++i) {
      for (const std::size_t place : places.grid.places_around(points_ws[i])) {
        if (places.open[place] == 0) continue;
        ways.push_back(
            ray_between(places.grid.position_ws(places.grid.coords(place)), points_ws[i]));
        points.push_back(i);
      }
    }
  }
  const std::vector<std::uint8_t> occluded = trace_occlusion(world, ways);
  std::vector<std::uint8_t> sees(points_ws.size(), 0);
  for (std::size_t r = 0; r < ways.size(); ++r) {
    if (occluded[r] == 0) sees[points[r]] = 1;
  }
  return sees;
}

}  // namespace lambent
