// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <vector>

#include "core/parallel.h"
#include "first_picture/views.h"
#include "raytracing/trace_rays.h"
#include "shared/rays.h"

namespace lambent {
namespace {

// Share of the frame's width and height into which the whole object must fit.
constexpr float kFilledShare = 0.84f;
// Distance of the camera from a scene that is a single point [m].
constexpr float kDistanceToPoint = 1e-3f;

// Number of surface points by which candidates are judged.
constexpr int kJudgedPoints = 384;
// Points whose surface is seen with a smaller cosine count less, in proportion: a camera that is
// hardly above a laid table or the face of a watch shows little of it.
constexpr float kGrazingCosine = 0.4f;
// Number of rays across and up the frame by which candidates are judged.
constexpr int kRaysAcross = 20, kRaysUp = 14;

// Positions of candidates [degrees]: azimuth from the front (+Z) towards the right, and elevation.
// A candidate's handicap is subtracted from its score: it grows with the distance from the
// customary three-quarter view.
struct Stand {
  float azimuth, elevation, handicap;
};
constexpr std::array kStands = {
    Stand{30, 18, 0.00f},  Stand{-30, 18, 0.05f},  Stand{60, 18, 0.10f},  Stand{-60, 18, 0.12f},
    Stand{120, 18, 0.25f}, Stand{-120, 18, 0.27f}, Stand{150, 18, 0.20f}, Stand{-150, 18, 0.22f},
    Stand{12, 12, 0.05f},  Stand{168, 12, 0.24f},  Stand{30, 40, 0.20f},  Stand{-30, 40, 0.23f},
    Stand{30, 62, 0.34f},  Stand{-30, 62, 0.36f},  Stand{150, 40, 0.30f}, Stand{-150, 40, 0.32f},
    Stand{30, -20, 0.40f}, Stand{150, -20, 0.50f}, Stand{90, 12, 0.20f},  Stand{-90, 12, 0.22f}};
// Least elevation of views from above [degrees]: lower down, a wall hides what is within a housing.
constexpr float kMinSteep = 30.0f;
// Weights of a candidate's score: the share of the surface that it shows, the share of the frame
// that the subject covers, and the share of that which shows backs.
constexpr float kSeenWeight = 0.6f, kCoverWeight = 0.4f, kShownBackWeight = 0.25f;

/// Extents of points along a view's axes, widened by perspective. They determine the distance of
/// the camera.
struct Extents {
  float right = -kInfiniteDistance, left = -kInfiniteDistance;
  float up = -kInfiniteDistance, down = -kInfiniteDistance;

  void add(const Extents& other) {
    right = std::max(right, other.right);
    left = std::max(left, other.left);
    up = std::max(up, other.up);
    down = std::max(down, other.down);
  }
};

/// A view direction, with the tangents of the part of its frame that is to be filled.
struct Framing {
  glm::mat3 view_from_world;  // rotation alone
  float tan_x, tan_y;
};

Framing make_framing(const glm::vec3& toward_eye, float vertical_fov, float aspect) {
  const glm::mat3 world_from_view(look_at(toward_eye, glm::vec3(0.0f), 1.0f).world_from_view);
  const float tan_y = kFilledShare * std::tan(0.5f * vertical_fov);
  return {glm::transpose(world_from_view), tan_y * aspect, tan_y};
}

/// A point p in view axes is in the frame of an eye e where |p.x - e.x| <= tan_x (e.z - p.z), and
/// similarly for y: e.x + tan_x e.z must reach p.x + tan_x p.z, and so on.
void add_point(const Framing& framing, const glm::vec3& offset_ws, Extents& extents) {
  const glm::vec3 p = framing.view_from_world * offset_ws;
  extents.right = std::max(extents.right, p.x + framing.tan_x * p.z);
  extents.left = std::max(extents.left, -p.x + framing.tan_x * p.z);
  extents.up = std::max(extents.up, p.y + framing.tan_y * p.z);
  extents.down = std::max(extents.down, -p.y + framing.tan_y * p.z);
}

/// The nearest camera that has all points in its frame, centred across and up.
Camera fit(const Framing& framing, const Extents& extents, const glm::vec3& center,
           float vertical_fov) {
  const float across = (extents.right + extents.left) / (2.0f * framing.tan_x);
  const float up = (extents.up + extents.down) / (2.0f * framing.tan_y);
  const glm::vec3 eye(0.5f * (extents.right - extents.left), 0.5f * (extents.up - extents.down),
                      std::max(across, up));
  const glm::mat3 world_from_view = glm::transpose(framing.view_from_world);
  Camera camera;
  camera.vertical_fov = vertical_fov;
  camera.world_from_view = glm::mat4(world_from_view);
  camera.world_from_view[3] = glm::vec4(center + world_from_view * eye, 1.0f);
  return camera;
}

/// Fits a sample of points, which is fast and may cut off a corner.
Camera fit_points(const Framing& framing, const std::vector<SurfaceSample>& points,
                  const glm::vec3& center, float vertical_fov) {
  Extents extents;
  for (const SurfaceSample& point : points) add_point(framing, point.position_ws - center, extents);
  return fit(framing, extents, center, vertical_fov);
}

/// Fits every vertex of the subject.
Camera fit_vertices(const Framing& framing, const Scene& scene, const Subject& subject,
                    const glm::vec3& center, float vertical_fov) {
  std::vector<Extents> each(subject.instances.size());
  parallel_chunks(each.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Instance& instance = scene.instances[subject.instances[i]];
      for (const glm::vec3& position : scene.meshes[instance.mesh].positions) {
        const glm::vec3 world(instance.world_from_object * glm::vec4(position, 1.0f));
        add_point(framing, world - center, each[i]);
      }
    }
  });
  Extents extents;
  for (const Extents& e : each) extents.add(e);
  return fit(framing, extents, center, vertical_fov);
}

/// Statistics of a candidate's picture.
struct Judgement {
  float seen = 0.0f;   ///< Share of the surface points that are visible; grazing ones count less.
  float cover = 0.0f;  ///< Share of the frame that is not sky.
  float back = 0.0f;   ///< Share of that which shows backs of surfaces.
};

Judgement judge(const World& world, const Camera& camera, const std::vector<SurfaceSample>& points,
                float aspect) {
  const glm::vec3 eye(camera.world_from_view[3]);
  std::vector<Ray> rays;
  std::vector<float> weights;
  for (const SurfaceSample& point : points) {
    const glm::vec3 offset = eye - point.position_ws;
    const float distance = glm::length(offset);
    if (!(distance > 0.0f)) continue;
    const glm::vec3 to_eye = offset / distance;
    const glm::vec3 side =
        glm::dot(to_eye, point.normal_ws) < 0.0f ? -point.normal_ws : point.normal_ws;
    rays.push_back({offset_ray_origin(point.position_ws, side), 0.0f, to_eye, distance});
    weights.push_back(std::min(glm::dot(to_eye, side) / kGrazingCosine, 1.0f));
  }
  Judgement judgement;
  const std::vector<std::uint8_t> hidden = trace_occlusion(world, rays);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (hidden[i] == 0) judgement.seen += weights[i];
  }
  if (!points.empty()) judgement.seen /= static_cast<float>(points.size());

  float met = 0.0f, backs = 0.0f;
  for (const Hit& hit : trace(world, frame_rays(camera, aspect, kRaysAcross, kRaysUp))) {
    if (hit.missed()) continue;
    met += 1.0f;
    if (shows_back(world.scene(), hit)) backs += 1.0f;
  }
  judgement.cover = met / (kRaysAcross * kRaysUp);
  judgement.back = met > 0.0f ? backs / met : 0.0f;
  return judgement;
}

}  // namespace

Camera outside_view(const World& world, const Subject& subject, ViewedFrom from, float vertical_fov,
                    float aspect) {
  const Scene& scene = world.scene();
  const glm::vec3 center = 0.5f * (subject.bounds.min + subject.bounds.max);
  if (diagonal(subject.bounds) == 0.0f) {
    const glm::vec3 toward_eye =
        direction_from_angles(glm::radians(kStands[0].azimuth), glm::radians(kStands[0].elevation));
    return look_at(center + kDistanceToPoint * toward_eye, center, vertical_fov);
  }

  // Judge all candidates, each relative to the best of them
  const std::vector<SurfaceSample> points =
      sample_surfaces(scene, subject.instances, kJudgedPoints);
  std::array<Judgement, kStands.size()> judgements;
  float most_seen = 0.0f, most_cover = 0.0f;
  for (std::size_t i = 0; i < kStands.size(); ++i) {
    const glm::vec3 toward_eye =
        direction_from_angles(glm::radians(kStands[i].azimuth), glm::radians(kStands[i].elevation));
    const Framing framing = make_framing(toward_eye, vertical_fov, aspect);
    judgements[i] = judge(world, fit_points(framing, points, center, vertical_fov), points, aspect);
    most_seen = std::max(most_seen, judgements[i].seen);
    most_cover = std::max(most_cover, judgements[i].cover);
  }
  std::size_t best = 0;
  float best_score = -kInfiniteDistance;
  for (std::size_t i = 0; i < kStands.size(); ++i) {
    if (from == ViewedFrom::above && kStands[i].elevation < kMinSteep) continue;
    const float seen = most_seen > 0.0f ? judgements[i].seen / most_seen : 0.0f;
    const float cover = most_cover > 0.0f ? judgements[i].cover / most_cover : 0.0f;
    const float score = kSeenWeight * seen + kCoverWeight * cover -
                        kShownBackWeight * judgements[i].back - kStands[i].handicap;
    if (score <= best_score) continue;
    best_score = score;
    best = i;
  }
  const glm::vec3 toward_eye = direction_from_angles(glm::radians(kStands[best].azimuth),
                                                     glm::radians(kStands[best].elevation));
  return fit_vertices(make_framing(toward_eye, vertical_fov, aspect), scene, subject, center,
                      vertical_fov);
}

}  // namespace lambent
