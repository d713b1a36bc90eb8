// SPDX-License-Identifier: Apache-2.0
#include "gather/guide.h"

#include <algorithm>
#include <array>
#include <atomic>

#include "core/parallel.h"
#include "field/probes/volumes.h"
#include "field/secondary/gathering_rays.h"
#include "gather/field_lighting.h"
#include "gather/gather_math.h"
#include "raytracing/world_access.h"
#include "shared/rays.h"

namespace lambent {
namespace {

// Fewest and most rays of a point: one for each pixel of the picture that it stands for. The 400
// rays of pools of 25 points find what is a hundredth of the hemisphere, up to 3,136 of pools of 49
// what is a thousandth. Where some pools find it and others do not, squares are seen.
constexpr uint kMinPilotRays = 16, kMaxPilotRays = 64;
// Points of a task on the processor, and rays of one whose rays a device traces, which waits for
// each task: in about 15 MB.
constexpr std::size_t kPointsPerTask = 128, kRaysPerDeviceTask = 65536;

// The pilot's rays with what they meet, and the places drawn from that, have random numbers of
// their own by these salts.
constexpr uint kPilotSalt = 0xC2B2AE35u;
constexpr uint kPlacesSalt = 0x9E3779B1u;

// Points pool the rays of those up to this far away along both axes of the pilot's picture, and of
// as many others that are this far apart. Points of pilots that are hardly smaller than their
// picture, and have the fewest rays, leave these out, which are far away there: with them, a hall
// lit by tubes below their housings has 4 % less light after the filter, at 48x27.
constexpr int kPoolReach = 2, kFarApart = 4;
// Pooled points face about the same way, within 26 degrees: a pool stands for one hemisphere.
constexpr float kPoolCosine = 0.9f;
// Rays this many times as bright as the mean of the pool are bright. 1.5 leaves a little more
// noise, 4 as little.
constexpr double kBrightOverMean = 2.5;
// Shares of guided rays of which the best is chosen, up to kMaxGuidedShare.
constexpr int kShareSteps = 8;
// Cones have the solid angle of so many hemispheres, parted among the pool's rays: neighbouring
// rays' cones overlap, and leave no gaps within what is bright. With 4 or 12 there is more noise.
constexpr float kConeOverRay = 6.0f;
// Of small pools, so that cones stay cones.
constexpr float kMaxSolidAngle = 1.0f;  // [sr]

/// A ray that left the scene ends this far away [m], far beyond any picture's parallax.
constexpr float kSkyDistance = 1e6f;

/// How far a pilot's ray goes straight on.
float straight_distance(const ShadedHit& hit) {
  if (hit.surface.mirror_distance > 0.0f) return hit.surface.mirror_distance;
  const bool sky = (hit.surface.flags & kSurfaceMissed) != 0u;
  return sky ? kSkyDistance : hit.point.viewer_distance;
}

/// The number of rays of each of a pilot's points.
uint pilot_rays(const GuideSize& size) {
  const auto of = [](int width, int height) { return static_cast<float>(width) * height; };
  const float pixels = of(size.picture_width, size.picture_height) / of(size.width, size.height);
  return std::clamp(static_cast<uint>(pixels), kMinPilotRays, kMaxPilotRays);
}

/// Adds this many rays of a point of a pilot of this width [pixels].
void add_rays(const PilotView& view, int pilot_width, std::size_t point, uint count,
              std::uint32_t seed, GatheringRays& rays) {
  const Surface& surface = view.surfaces[point];
  const Frame frame = make_frame(surface.normal_ws);
  const vec3 origin_ws = offset_ray_origin(surface.position_ws, surface.geometric_normal_ws);
  const auto width = static_cast<std::size_t>(pilot_width);
  const auto x = static_cast<uint>(point % width), y = static_cast<uint>(point / width);
  for (uint ray = 0; ray < count; ++ray) {
    const vec2 drawn = pixel_point(x, y, ray, count, kPilotSalt, seed);
    rays.add(origin_ws, gather_direction(frame, drawn), point * count + ray);
  }
}

// Pooled points along each axis, near ones or farther ones.
constexpr int kPoolSide = 2 * kPoolReach + 1;

/// From a point to those that it pools, in the pilot's picture: those around it, itself among them,
/// and farther ones.
constexpr auto kPoolOffsets = [] {
  std::array<glm::ivec2, 2 * kPoolSide * kPoolSide - 1> offsets{};
  std::size_t count = 0;
  for (const int apart : {1, kFarApart}) {
    for (int place = 0; place < kPoolSide * kPoolSide; ++place) {
      const int x = place % kPoolSide - kPoolReach, y = place / kPoolSide - kPoolReach;
      if (apart == 1 || x != 0 || y != 0) offsets[count++] = {apart * x, apart * y};
    }
  }
  return offsets;
}();

/// Rays of a point and those that it pools.
struct Pool {
  std::vector<PilotHit> hits;
  std::vector<std::size_t> bright;  // of these
  double bright_light = 0.0;        // sum of their luminances
};

Pool pool_around(std::span<const PilotHit> hits, const GatherGuide& guide, int x, int y) {
  const int width = guide.size.width, height = guide.size.height;
  const std::size_t per_point = hits.size() / guide.points.size();
  const vec3 normal_ws = guide.points[static_cast<std::size_t>(y) * width + x].normal_ws;
  Pool pool;
  double light = 0.0;
  const std::size_t pooled =
      per_point > kMinPilotRays ? kPoolOffsets.size() : std::size_t{kPoolSide * kPoolSide};
  for (const glm::ivec2& offset : std::span(kPoolOffsets).first(pooled)) {
    const int a = x + offset.x, b = y + offset.y;
    if (a < 0 || b < 0 || a >= width || b >= height) continue;
    const std::size_t i = static_cast<std::size_t>(b) * width + a;
    if (dot(guide.points[i].normal_ws, normal_ws) < kPoolCosine) continue;
    for (const PilotHit& hit : hits.subspan(i * per_point, per_point)) {
      light += hit.luminance;
      pool.hits.push_back(hit);
    }
  }
  const double least = kBrightOverMean * light / static_cast<double>(pool.hits.size());
  for (std::size_t i = 0; i < pool.hits.size(); ++i) {
    if (!(pool.hits[i].luminance > least)) continue;
    pool.bright.push_back(i);
    pool.bright_light += pool.hits[i].luminance;
  }
  return pool;
}

/// Draws places among bright hits in proportion to their light, by systematic resampling.
void draw_places(const Pool& pool, float drawn, std::span<vec3> places) {
  const double step = pool.bright_light / static_cast<double>(places.size());
  double below = 0.0;
  std::size_t placed = 0;
  for (const std::size_t bright : pool.bright) {
    below += pool.hits[bright].luminance;
    while (placed < places.size() && (static_cast<double>(placed) + drawn) * step < below) {
      places[placed++] = pool.hits[bright].position_ws;
    }
  }
  // What rounding has left
  std::fill(places.begin() + static_cast<std::ptrdiff_t>(placed), places.end(),
            pool.hits[pool.bright.back()].position_ws);
}

/// The number of cones that a hit is in. Cones around places that are the hit itself say nothing of
/// what another ray would meet there, and count as a part of one each: the share of all places that
/// are this hit. One of many bright hits then counts by its neighbours, and the only bright one,
/// which may well be a small patch of sun, in full. Without these cones noise is larger.
float cones_around(const PilotHit& hit, vec3 position_ws, vec3 direction_ws,
                   std::span<const vec3> places, float least_cosine) {
  int own = 0, others = 0;
  for (const vec3& place : places) {
    if (place == hit.position_ws) {
      ++own;
    } else if (is_in_cone(direction_ws, place - position_ws, least_cosine)) {
      ++others;
    }
  }
  const auto of_own = static_cast<float>(own);
  return static_cast<float>(others) + of_own * of_own / static_cast<float>(places.size());
}

/// The share of guided rays with which rays have the least variance, judged by the pool's: the mean
/// square of what a ray brings is that of rays drawn by the cosine, each times its weight.
float best_share(const Pool& pool, vec3 position_ws, const GuidePoint& point,
                 std::span<const vec3> places) {
  std::array<double, kShareSteps + 1> squares{};
  const auto share_of = [](std::size_t step) {
    return kMaxGuidedShare * static_cast<float>(step) / kShareSteps;
  };
  for (const PilotHit& hit : pool.hits) {
    const vec3 to_hit = hit.position_ws - position_ws;
    if (!(hit.luminance > 0.0f) || to_hit == vec3(0.0f)) continue;
    const vec3 direction_ws = normalize(to_hit);
    const float cones = cones_around(hit, position_ws, direction_ws, places, point.least_cosine);
    const float density = guided_density(cones, point.least_cosine);
    const float cosine = dot(direction_ws, point.normal_ws);
    const double square = static_cast<double>(hit.luminance) * hit.luminance;
    for (std::size_t step = 0; step < squares.size(); ++step) {
      squares[step] += square * guided_weight(cosine, density, share_of(step));
    }
  }
  return share_of(static_cast<std::size_t>(std::ranges::min_element(squares) - squares.begin()));
}

void place_point(std::span<const PilotHit> hits, vec3 position_ws, std::uint32_t seed,
                 std::size_t index, GatherGuide& guide) {
  GuidePoint& point = guide.points[index];
  point.share = 0.0f;
  if (point.normal_ws == vec3(0.0f)) return;
  const auto width = static_cast<std::size_t>(guide.size.width);
  const Pool pool =
      pool_around(hits, guide, static_cast<int>(index % width), static_cast<int>(index / width));
  if (pool.bright.empty()) return;
  const float solid_angle =
      min(kConeOverRay * kTwoPi / static_cast<float>(pool.hits.size()), kMaxSolidAngle);
  point.least_cosine = 1.0f - solid_angle / kTwoPi;
  RandomStream random = make_random_stream(static_cast<uint>(index), kPlacesSalt, seed);
  const auto places = std::span(guide.places).subspan(index * kBrightPlaces, kBrightPlaces);
  draw_places(pool, next_uniform(random), places);
  point.share = best_share(pool, position_ws, point, places);
}

}  // namespace

std::uint64_t make_guide(const World& world, const IrradianceField& field, const PilotView& view,
                         std::uint32_t seed, GatherGuide& guide) {
  guide.points.assign(view.seen.size(), GuidePoint{vec3(0.0f), 1.0f, 0.0f});
  std::vector<vec3> positions_ws(view.seen.size());
  const uint count = pilot_rays(guide.size);
  std::vector<PilotHit> hits(view.seen.size() * count, PilotHit{vec3(0.0f), 0.0f});
  const std::vector<ProbeGrid> grids = still_grids(field.grids());
  // Lookups light all hits: that nooks are lit in detail matters little for where bright places are
  const HitLighting by = lit_by_field(
      world, field, grids,
      gathering_shading(static_cast<int>(count), field.settings().max_albedo, kPilotSalt, seed), 0);
  std::atomic<std::uint64_t> traced = 0;
  const std::size_t at_a_time =
      device_world_of(world) != nullptr ? kRaysPerDeviceTask / count : kPointsPerTask;
  parallel_chunks(view.seen.size(), at_a_time, [&](std::size_t begin, std::size_t end) {
    GatheringRays rays;
    ShadeHitsScratch scratch;
    for (std::size_t i = begin; i < end; ++i) {
      if (view.seen[i] == 0) continue;
      positions_ws[i] = view.surfaces[i].position_ws;
      guide.points[i].normal_ws = view.surfaces[i].normal_ws;
      add_rays(view, guide.size.width, i, count, seed, rays);
    }
    traced += rays.light(by, scratch);
    for (std::size_t i = 0; i < rays.rays.size(); ++i) {
      const ShadedHit& hit = rays.shaded[i];
      const vec3 brought = gathered_radiance(hit.surface, hit.direct_irradiance, rays.arrives[i]);
      hits[rays.indices[i]] = {
          rays.rays[i].origin + straight_distance(hit) * rays.rays[i].direction,
          luminance(brought)};
    }
  });
  place_guide(hits, positions_ws, seed, guide);
  return traced;
}

void place_guide(std::span<const PilotHit> hits, std::span<const vec3> positions_ws,
                 std::uint32_t seed, GatherGuide& guide) {
  guide.places.resize(guide.points.size() * kBrightPlaces);
  parallel_chunks(guide.points.size(), kPointsPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) place_point(hits, positions_ws[i], seed, i, guide);
  });
}

}  // namespace lambent
