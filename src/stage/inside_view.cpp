// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <unordered_set>
#include <vector>

#include "shared/constants.h"
#include "shared/rays.h"
#include "stage/views.h"

namespace lambent {
namespace {

// Somebody who stands in a room of these heights [m] has the eyes at this height [m]; in others,
// whose unit is not the metre or which are models of rooms, at a share of theirs.
constexpr float kMinRoomHeight = 1.9f, kMaxRoomHeight = 20.0f;
constexpr float kEyeHeight = 1.6f;
constexpr float kEyeShareOfHeight = 0.45f;
// Of the height of a room of human scale, where that is less.
constexpr float kMaxEyeShareOfHeight = 0.6f;

// Places that are looked around from.
constexpr std::size_t kMaxEyes = 110;
// Rays around the horizon, and elevations of the rings of rays [rad].
constexpr int kRingRays = 40;
constexpr std::array<float, 5> kRings = {-0.42f, -0.2f, 0.0f, 0.2f, 0.42f};
// Directions in which a view may look.
constexpr int kViewDirections = 20;
// Views tilt down a little [rad]: floors show more than ceilings.
constexpr float kTilt = 0.06f;

// Distances as shares of the diagonal: an eye keeps this far from everything, what is nearer than
// that fills the view, and depth counts no more beyond that.
constexpr float kClearance = 0.015f, kNear = 0.07f, kDeep = 0.5f;
// Sky counts against a view beyond this share.
constexpr float kMaxSky = 0.1f;
// What counts of a view: median depth, and what many small triangles tell of detail, against what
// is near, sky, and backs of surfaces.
constexpr float kDepthWeight = 1.5f, kDetailWeight = 0.5f, kNearWeight = 1.5f, kSkyWeight = 1.5f,
                kBackWeight = 0.8f;
// A view that shows less depth than this share of the diagonal, or more backs, is none.
constexpr float kMinDepth = 0.06f, kMaxBacks = 0.6f;

// Surface points that is_room judges, rays from each to the outside, and their elevations [rad].
constexpr int kShellPoints = 256, kShellRays = 4;
constexpr float kMinShellElevation = 0.09f, kMaxShellElevation = 0.7f;
// A room is enclosed in this share of its box, at least;
constexpr float kMinEnclosed = 0.25f;
// and the share of its surface that shows its front to somebody outside is no larger than this,
// plus by how much more of it is enclosed.
constexpr float kMaxShown = 0.45f;

glm::vec3 eye_at(const OpenPlace& place) {
  const float height = place.ceiling - place.floor;
  float eye = kEyeShareOfHeight * height;
  if (height >= kMinRoomHeight && height <= kMaxRoomHeight) {
    eye = std::min(kEyeHeight, kMaxEyeShareOfHeight * height);
  }
  return {place.position_ws.x, place.floor + eye, place.position_ws.z};
}

/// What rays around an eye meet: kRings.size() rings of kRingRays hits.
struct Panorama {
  glm::vec3 eye{0.0f};
  const Hit* hits = nullptr;
};

/// How good a view in a direction is, by the rays of the panorama that are in its frame; the higher
/// the better. Minus infinity: it is none.
float score_view(const Panorama& panorama, int direction, float half_width, float scale) {
  std::vector<float> depths;
  std::unordered_set<std::uint64_t> triangles;
  float near = 0.0f, sky = 0.0f, backs = 0.0f, rays = 0.0f;
  const float azimuth = kTwoPi * static_cast<float>(direction) / kViewDirections;
  for (std::size_t ring = 0; ring < kRings.size(); ++ring) {
    for (int i = 0; i < kRingRays; ++i) {
      const float turn = kTwoPi * static_cast<float>(i) / kRingRays - azimuth;
      if (std::abs(std::remainder(turn, kTwoPi)) > half_width) continue;
      const Hit& hit = panorama.hits[ring * kRingRays + static_cast<std::size_t>(i)];
      rays += 1.0f;
      depths.push_back(hit.distance);
      if (hit.missed()) {
        sky += 1.0f;
        continue;
      }
      if (hit.distance < kNear * scale) near += 1.0f;
      if (!hit.front_face) backs += 1.0f;
      triangles.insert(std::uint64_t{hit.instance} << 32 | hit.triangle);
    }
  }
  if (rays == 0.0f || sky == rays || backs > kMaxBacks * rays) return -kInfiniteDistance;
  const auto middle = depths.begin() + static_cast<std::ptrdiff_t>(depths.size() / 2);
  std::nth_element(depths.begin(), middle, depths.end());
  const float depth = std::min(*middle / scale, kDeep);
  if (depth < kMinDepth) return -kInfiniteDistance;
  return kDepthWeight * depth / kDeep +
         kDetailWeight * static_cast<float>(triangles.size()) / rays - kNearWeight * near / rays -
         kSkyWeight * std::max(sky / rays - kMaxSky, 0.0f) - kBackWeight * backs / rays;
}

}  // namespace

std::optional<Camera> inside_view(const World& world, const SpaceSurvey& survey,
                                  const Bounds& bounds, float vertical_fov, float aspect) {
  const float scale = diagonal(bounds);
  const std::size_t eyes = std::min(survey.enclosed.size(), kMaxEyes);
  constexpr std::size_t kPanoramaRays = kRings.size() * kRingRays;
  std::vector<Ray> rays;
  rays.reserve(eyes * kPanoramaRays);
  for (std::size_t e = 0; e < eyes; ++e) {
    const glm::vec3 eye = eye_at(survey.enclosed[e]);
    for (const float elevation : kRings) {
      for (int i = 0; i < kRingRays; ++i) {
        const float azimuth = kTwoPi * static_cast<float>(i) / kRingRays;
        rays.push_back({eye, 0.0f, direction_from_angles(azimuth, elevation)});
      }
    }
  }
  const std::vector<Hit> hits = trace(world, rays);

  const float half_width = std::atan(std::tan(0.5f * vertical_fov) * aspect);
  float best = -kInfiniteDistance;
  std::optional<Camera> camera;
  for (std::size_t e = 0; e < eyes; ++e) {
    const Panorama panorama{rays[e * kPanoramaRays].origin, &hits[e * kPanoramaRays]};
    const float nearest =
        std::min_element(panorama.hits, panorama.hits + kPanoramaRays,
                         [](const Hit& a, const Hit& b) { return a.distance < b.distance; })
            ->distance;
    if (nearest < kClearance * scale) continue;
    for (int d = 0; d < kViewDirections; ++d) {
      const float score = score_view(panorama, d, half_width, scale);
      if (score <= best) continue;
      best = score;
      const float azimuth = kTwoPi * static_cast<float>(d) / kViewDirections;
      camera = look_at(panorama.eye, panorama.eye + direction_from_angles(azimuth, -kTilt),
                       vertical_fov);
    }
  }
  return camera;
}

bool is_room(const World& world, const Subject& subject, const SpaceSurvey& survey) {
  if (survey.enclosed_share < kMinEnclosed) return false;
  const std::vector<SurfacePoint> points =
      sample_surfaces(world.scene(), subject.instances, kShellPoints);
  if (points.empty()) return false;

  // Look from the front of each point towards where somebody outside would stand
  std::vector<Ray> rays;
  std::vector<std::size_t> point_of_ray;
  for (std::size_t p = 0; p < points.size(); ++p) {
    for (int i = 0; i < kShellRays; ++i) {
      const float share = (static_cast<float>(i) + 0.5f) / kShellRays;
      const float azimuth = kTwoPi * (share + kGoldenRatio * static_cast<float>(p));
      const float elevation = glm::mix(kMinShellElevation, kMaxShellElevation, share);
      const glm::vec3 direction = direction_from_angles(azimuth, elevation);
      if (glm::dot(direction, points[p].normal_ws) <= 0.0f) continue;
      rays.push_back(
          {offset_ray_origin(points[p].position_ws, points[p].normal_ws), 0.0f, direction});
      point_of_ray.push_back(p);
    }
  }
  const std::vector<std::uint8_t> stopped = trace_occlusion(world, rays);
  std::vector<char> shown(points.size(), 0);
  for (std::size_t r = 0; r < rays.size(); ++r) {
    if (stopped[r] == 0) shown[point_of_ray[r]] = 1;
  }
  const auto count = static_cast<float>(std::count(shown.begin(), shown.end(), 1));
  const float shown_share = count / static_cast<float>(points.size());
  return shown_share <= kMaxShown + survey.enclosed_share - kMinEnclosed;
}

}  // namespace lambent
