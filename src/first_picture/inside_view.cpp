// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <iterator>
#include <span>
#include <unordered_set>
#include <vector>

#include "first_picture/seen.h"
#include "first_picture/views.h"
#include "raytracing/places/places.h"
#include "raytracing/solid_sides/find_solid_sides.h"
#include "raytracing/trace_rays.h"
#include "shared/constants.h"

namespace lambent {
namespace {

// In rooms for people, eyes are at the height of a standing person; in others, at this share of the
// room's height. Streets and courts may be deeper [m] than rooms are high.
constexpr float kMaxStreetDepth = 100.0f;
constexpr float kEyeShareOfHeight = 0.45f;
// Highest eye in a room of human scale, as a share of its height.
constexpr float kMaxEyeShareOfHeight = 0.6f;

// Where there are streets, the scene covers at least this much ground each way [m]. A smaller one
// is a thing, such as a rack of lamps.
constexpr float kMinStreetGround = 10.0f;

// Streets are looked for in the lower part of a scene first, up to this share of its height: higher
// up are roofs of houses between taller ones. On hills, streets are higher than that, too, and
// below a tower, roofs are lower.
constexpr float kMaxStreetFloor = 0.5f;

// An observer stands on the floor, not on a worktop, under a table or between shelves: where there
// is at least this share of the median height of all places. In rooms whose heights look like
// metres, kMinRoomHeight is enough: aisles and galleries beside a high hall are places, too.
constexpr float kStandingShare = 0.75f;

// An observer on furniture, such as a pew or a bed, sees the floor drop by more than this share of
// the eye's height, at one of these shares of it away, in more directions than on a stair, where it
// is three of eight.
constexpr float kStepDown = 0.15f;
constexpr std::array kStepsAway = {0.25f, 0.5f, 0.75f};
constexpr int kStepsAround = 8, kMaxStepsDown = 3;
constexpr std::size_t kStepsOfPlace = kStepsAround * kStepsAway.size();

// Where light of the sky or of lamps reaches at least this share of the places where an observer
// could stand, nobody stands in the others, which are within closed blocks: the houses along a
// street often are.
constexpr float kMinOpenShare = 0.1f;
// Number of rays around a place, half of which go up and look for the sky: one finds a window that
// fills a thirtieth of that.
constexpr int kRaysToSky = 64;

// Most places from which panoramas are traced.
constexpr std::size_t kMaxEyes = 110;
// Number of rays around the horizon, and elevations of the rings of rays [rad].
constexpr int kRingRays = 40;
constexpr std::array<float, 5> kRings = {-0.42f, -0.2f, 0.0f, 0.2f, 0.42f};
// Number of directions in which a view may look.
constexpr int kViewDirections = 20;
// Rays reach beyond the box of the room by this share of its diagonal, to walls on its sides.
constexpr float kBeyondBox = 0.01f;
// Views tilt down a little [rad]: floors show more than ceilings.
constexpr float kTilt = 0.06f;

// Distances as shares of the diagonal: the least from an eye to any surface; the one below which a
// surface counts as near; and the one beyond which depth counts no more.
constexpr float kClearance = 0.015f, kNear = 0.07f, kDeep = 0.5f;
// A larger share of sky than this counts against a view.
constexpr float kMaxSky = 0.1f;
// Weights of a view's score: mean depth of what is not sky, detail by the number of different
// triangles, and the share that the scene's own lights reach over the largest of any view, against
// what is near, sky, and backs of surfaces.
constexpr float kDepthWeight = 2.0f, kDetailWeight = 0.8f, kLitWeight = 0.6f, kNearWeight = 1.5f,
                kSkyWeight = 1.5f, kBackWeight = 0.8f;
// Shares of rays that lights reach are divided by at least this, which is five rays of a view of
// 16:9: single ones would decide in rooms that are darker.
constexpr float kMinLargestLit = 0.1f;
// A view with less depth than this share of the diagonal, or with more backs, is rejected.
constexpr float kMinDepth = 0.06f, kMaxBacks = 0.6f;
// Where the unit is the metre, this clearance and this depth [m] are enough, however large the
// scene is: in a town the ground before one's feet and the houses across the street are near.
constexpr float kEnoughClearance = 1.0f, kEnoughDepth = 5.0f;

/// Whether a place is as high as a room or, below the open sky, as houses along a street, in
/// metres.
bool has_human_scale(const OpenPlace& place) {
  const float most = place.open_above ? kMaxStreetDepth : kMaxRoomHeight;
  return height_of(place) >= kMinRoomHeight && height_of(place) <= most;
}

/// The first places, at most `most`, where an observer could stand.
std::vector<OpenPlace> standing_places(std::span<const OpenPlace> sheltered, std::size_t most) {
  if (sheltered.empty()) return {};
  const float median = median_height(sheltered);
  float least = kStandingShare * median;
  if (is_room_height(median)) least = std::min(least, kMinRoomHeight);
  std::vector<OpenPlace> standing;
  for (const OpenPlace& place : sheltered) {
    if (standing.size() == most) break;
    if (height_of(place) >= least) standing.push_back(place);
  }
  return standing;
}

glm::vec3 eye_at(const OpenPlace& place) {
  const float height = height_of(place);
  float eye = kEyeShareOfHeight * height;
  if (has_human_scale(place)) {
    eye = std::min(kEyeHeight, kMaxEyeShareOfHeight * height);
  }
  return {place.position_ws.x, place.floor + eye, place.position_ws.z};
}

/// The places that are not on top of furniture, if there are any; otherwise all.
std::vector<OpenPlace> places_on_floors(const World& world, const std::vector<OpenPlace>& places) {
  std::vector<Ray> rays;
  for (const OpenPlace& place : places) {
    const glm::vec3 eye = eye_at(place);
    const float height = eye.y - place.floor;
    for (int i = 0; i < kStepsAround; ++i) {
      const glm::vec3 way = direction_from_angles(kTwoPi * static_cast<float>(i) / kStepsAround, 0);
      for (const float away : kStepsAway) {
        rays.push_back(
            {eye + away * height * way, 0.0f, {0.0f, -1.0f, 0.0f}, (1.0f + kStepDown) * height});
      }
    }
  }
  // A wall hides what is behind it
  std::vector<Ray> ways;
  for (const Ray& ray : rays) {
    const glm::vec3 eye = eye_at(places[ways.size() / kStepsOfPlace]);
    const glm::vec3 way = ray.origin - eye;
    ways.push_back({eye, 0.0f, glm::normalize(way), glm::length(way)});
  }
  const std::vector<std::uint8_t> met = trace_occlusion(world, rays);
  const std::vector<std::uint8_t> hidden = trace_occlusion(world, ways);
  std::vector<OpenPlace> on_floors;
  std::size_t ray = 0;
  for (const OpenPlace& place : places) {
    int down = 0;
    for (int i = 0; i < kStepsAround; ++i) {
      bool drops = false;
      for (std::size_t step = 0; step < kStepsAway.size(); ++step, ++ray) {
        drops = drops || (met[ray] == 0 && hidden[ray] == 0);
      }
      if (drops) ++down;
    }
    if (down <= kMaxStepsDown) on_floors.push_back(place);
  }
  return on_floors.empty() ? places : on_floors;
}

/// Whether the sky is visible from a point, through glass or not. see_open_places() tests a coarse
/// grid, which misses small rooms of large scenes, and takes panes for walls.
bool sees_sky(const World& world, const glm::vec3& eye) {
  const std::vector<Ray> rays = rays_around(eye, kRaysToSky);
  const std::vector<std::uint8_t> met = trace_occlusion(world, rays);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (rays[i].direction.y > 0.0f && (met[i] == 0 || leads_to_sky(world, rays[i]))) return true;
  }
  return false;
}

/// The places that light reaches, if these are enough; otherwise all.
std::vector<OpenPlace> lit_places(const World& world, const std::vector<OpenPlace>& places) {
  std::vector<glm::vec3> eyes(places.size());
  std::transform(places.begin(), places.end(), eyes.begin(), eye_at);
  const SolidSides sides = find_solid_sides(world, {});
  std::vector<std::uint8_t> is_lit = see_open_places(world, sides.open_space, eyes);
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (is_lit[i] == 0 && sees_sky(world, eyes[i])) is_lit[i] = 1;
  }
  std::vector<OpenPlace> lit;
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (is_lit[i] != 0) lit.push_back(places[i]);
  }
  const float needed = kMinOpenShare * static_cast<float>(places.size());
  return static_cast<float>(lit.size()) >= needed && !lit.empty() ? lit : places;
}

/// A least distance, a share of the scene's diagonal, at a place where `enough` is enough [m].
float least_distance(float share, float enough, const OpenPlace& place, float scale) {
  return has_human_scale(place) ? std::min(share * scale, enough) : share * scale;
}

/// How far a ray goes until it leaves a box, and a little beyond, for what is in its sides [m].
float distance_to_leave(Bounds box, const glm::vec3& origin, const glm::vec3& direction) {
  // Floors may be below the box, and eyes, too
  box.add({origin, origin});
  float distance = kInfiniteDistance;
  for (int axis = 0; axis < 3; ++axis) {
    if (direction[axis] == 0.0f) continue;
    const float side = direction[axis] > 0.0f ? box.max[axis] : box.min[axis];
    distance = std::min(distance, (side - origin[axis]) / direction[axis]);
  }
  return distance + kBeyondBox * diagonal(box);
}

/// The hits of rays around an eye: kRings.size() rings of kRingRays hits.
struct Panorama {
  glm::vec3 eye{0.0f};
  float least_depth = 0.0f;  ///< Of views [m].
  const Hit* hits = nullptr;
  const std::uint8_t* lit = nullptr;  ///< 1 for each hit that one of the lights reaches.
};

/// A view in a direction, judged by the rays of the panorama that are in its frame.
struct JudgedView {
  glm::vec3 eye{0.0f};
  float azimuth = 0.0f;              ///< [rad]
  float score = -kInfiniteDistance;  ///< Without light; minus infinity: the view is rejected.
  float lit = 0.0f;                  ///< Share of the rays that end where lights reach.
};

/// Judges the view in one of kViewDirections. `half_width`: of the view [rad]; `scale`: diagonal of
/// the scene [m].
JudgedView judge_view(const Scene& scene, const Panorama& panorama, int direction, float half_width,
                      float scale) {
  JudgedView view;
  std::unordered_set<std::uint64_t> triangles;
  float depths = 0.0f, near = 0.0f, sky = 0.0f, backs = 0.0f, lit = 0.0f, rays = 0.0f;
  view.eye = panorama.eye;
  view.azimuth = kTwoPi * static_cast<float>(direction) / kViewDirections;
  for (std::size_t ring = 0; ring < kRings.size(); ++ring) {
    for (int i = 0; i < kRingRays; ++i) {
      const float turn = kTwoPi * static_cast<float>(i) / kRingRays - view.azimuth;
      if (std::abs(std::remainder(turn, kTwoPi)) > half_width) continue;
      const std::size_t at = ring * kRingRays + static_cast<std::size_t>(i);
      const Hit& hit = panorama.hits[at];
      rays += 1.0f;
      if (hit.missed()) {
        sky += 1.0f;
        continue;
      }
      depths += std::min(hit.distance / scale, kDeep);
      if (hit.distance < kNear * scale) near += 1.0f;
      if (shows_back(scene, hit)) backs += 1.0f;
      if (panorama.lit[at] != 0) lit += 1.0f;
      triangles.insert(std::uint64_t{hit.instance} << 32 | hit.triangle);
    }
  }
  if (sky == rays || backs > kMaxBacks * rays) return view;
  const float depth = depths / (rays - sky);
  if (depth * scale < panorama.least_depth) return view;
  // Count triangles logarithmically: a window in a wall matters more than one more leaf in a wood
  const float detail = std::log1p(static_cast<float>(triangles.size())) / std::log1p(rays);
  view.score = kDepthWeight * depth / kDeep + kDetailWeight * detail - kNearWeight * near / rays -
               kSkyWeight * std::max(sky / rays - kMaxSky, 0.0f) - kBackWeight * backs / rays;
  view.lit = lit / rays;
  return view;
}

/// The best of some views by score and light; null where all are rejected.
const JudgedView* best_of(std::span<const JudgedView> views) {
  float largest_lit = kMinLargestLit;
  for (const JudgedView& view : views) largest_lit = std::max(largest_lit, view.lit);
  float best_score = -kInfiniteDistance;
  const JudgedView* best = nullptr;
  for (const JudgedView& view : views) {
    const float score = view.score + kLitWeight * view.lit / largest_lit;
    if (score <= best_score) continue;
    best_score = score;
    best = &view;
  }
  return best;
}

}  // namespace

std::optional<Camera> inside_view(const World& world, const SpaceSurvey& survey,
                                  const Bounds& bounds, float vertical_fov, float aspect) {
  const float scale = diagonal(bounds);
  const std::vector<OpenPlace> places =
      lit_places(world, places_on_floors(world, standing_places(survey.sheltered, kMaxEyes)));
  const std::size_t eyes = places.size();
  constexpr std::size_t kPanoramaRays = kRings.size() * kRingRays;
  std::vector<Ray> rays;
  rays.reserve(eyes * kPanoramaRays);
  for (std::size_t e = 0; e < eyes; ++e) {
    const glm::vec3 eye = eye_at(places[e]);
    for (const float elevation : kRings) {
      for (int i = 0; i < kRingRays; ++i) {
        const float azimuth = kTwoPi * static_cast<float>(i) / kRingRays;
        const glm::vec3 way = direction_from_angles(azimuth, elevation);
        // What is outdoors counts as sky
        rays.push_back({eye, 0.0f, way, distance_to_leave(bounds, eye, way)});
      }
    }
  }
  const std::vector<Hit> hits = trace(world, rays);
  const std::vector<std::uint8_t> lit = find_lit(world, rays, hits);

  const float half_width = std::atan(std::tan(0.5f * vertical_fov) * aspect);
  std::vector<JudgedView> views;
  views.reserve(eyes * kViewDirections);
  for (std::size_t e = 0; e < eyes; ++e) {
    const Panorama panorama{rays[e * kPanoramaRays].origin,
                            least_distance(kMinDepth, kEnoughDepth, places[e], scale),
                            &hits[e * kPanoramaRays], &lit[e * kPanoramaRays]};
    const float nearest =
        std::min_element(panorama.hits, panorama.hits + kPanoramaRays,
                         [](const Hit& a, const Hit& b) { return a.distance < b.distance; })
            ->distance;
    if (nearest < least_distance(kClearance, kEnoughClearance, places[e], scale)) continue;
    for (int d = 0; d < kViewDirections; ++d) {
      views.push_back(judge_view(world.scene(), panorama, d, half_width, scale));
    }
  }
  const JudgedView* best = best_of(views);
  if (best == nullptr) return std::nullopt;
  return look_at(best->eye, best->eye + direction_from_angles(best->azimuth, -kTilt), vertical_fov);
}

std::optional<Camera> street_view(const World& world, const SpaceSurvey& survey,
                                  const Bounds& bounds, float vertical_fov, float aspect) {
  const glm::vec3 size = bounds.max - bounds.min;
  if (std::min(size.x, size.z) < kMinStreetGround) return std::nullopt;
  SpaceSurvey streets, low;
  std::ranges::copy_if(
      survey.sheltered, std::back_inserter(streets.sheltered),
      [](const OpenPlace& place) { return place.open_above && has_human_scale(place); });
  std::ranges::copy_if(streets.sheltered, std::back_inserter(low.sheltered),
                       [&](const OpenPlace& place) {
                         return place.floor <= bounds.min.y + kMaxStreetFloor * size.y;
                       });
  const auto view = inside_view(world, low, bounds, vertical_fov, aspect);
  return view ? view : inside_view(world, streets, bounds, vertical_fov, aspect);
}

}  // namespace lambent
