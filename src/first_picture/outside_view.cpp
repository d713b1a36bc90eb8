// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
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

/// Measures the world in each pose, and in the first one last.
Expected<void> in_each(const Poses& poses, const std::function<void()>& measure) {
  for (int i = poses.count - 1; i >= 0; --i) {
    if (poses.count > 1) {
      if (const Expected<void> taken = poses.take(i); !taken) return taken;
    }
    measure();
  }
  return {};
}

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
  const float away = std::max(across, up);
  const glm::vec3 eye(0.5f * (extents.right - extents.left), 0.5f * (extents.up - extents.down),
                      away > 0.0f ? away : kDistanceToPoint);
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

/// Extents of every vertex of the subject.
Extents vertex_extents(const Framing& framing, const Scene& scene, const Subject& subject,
                       const glm::vec3& center) {
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
  return extents;
}

/// Statistics of a candidate's picture.
struct Judgement {
  float seen = 0.0f;   ///< Share of the surface points that are visible; grazing ones count less.
  float cover = 0.0f;  ///< Share of the frame that is not sky.
  float back = 0.0f;   ///< Share of that which shows backs of surfaces.

  void add(const Judgement& other) {
    seen += other.seen;
    cover += other.cover;
    back += other.back;
  }
};
/// One for each of kStands; sums over poses.
using StandJudgements = std::array<Judgement, kStands.size()>;

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

/// The direction to a candidate; unit.
glm::vec3 toward(const Stand& stand) {
  return direction_from_angles(glm::radians(stand.azimuth), glm::radians(stand.elevation));
}

/// What each candidate shows of the subject in the world's pose.
StandJudgements judge_stands(const World& world, const Subject& subject, float vertical_fov,
                             float aspect) {
  const std::vector<SurfaceSample> points =
      sample_surfaces(world.scene(), subject.instances, kJudgedPoints);
  const glm::vec3 center = 0.5f * (subject.bounds.min + subject.bounds.max);
  StandJudgements judgements{};
  if (points.empty()) return judgements;  // nothing has an area
  for (std::size_t i = 0; i < kStands.size(); ++i) {
    const Framing framing = make_framing(toward(kStands[i]), vertical_fov, aspect);
    judgements[i] = judge(world, fit_points(framing, points, center, vertical_fov), points, aspect);
  }
  return judgements;
}

/// The best candidate, each being judged relative to the most that any shows. `poses`: number of
/// judgements in each sum.
const Stand& best_stand(const StandJudgements& sums, ViewedFrom from, int poses) {
  float most_seen = 0.0f, most_cover = 0.0f;
  for (const Judgement& sum : sums) {
    most_seen = std::max(most_seen, sum.seen);
    most_cover = std::max(most_cover, sum.cover);
  }
  std::size_t best = 0;
  float best_score = -kInfiniteDistance;
  for (std::size_t i = 0; i < kStands.size(); ++i) {
    if (from == ViewedFrom::above && kStands[i].elevation < kMinSteep) continue;
    const float seen = most_seen > 0.0f ? sums[i].seen / most_seen : 0.0f;
    const float cover = most_cover > 0.0f ? sums[i].cover / most_cover : 0.0f;
    const float back = sums[i].back / static_cast<float>(poses);
    const float score =
        kSeenWeight * seen + kCoverWeight * cover - kShownBackWeight * back - kStands[i].handicap;
    if (score <= best_score) continue;
    best_score = score;
    best = i;
  }
  return kStands[best];
}

}  // namespace

Expected<Camera> outside_view(const World& world, const Subject& subject, ViewedFrom from,
                              const Poses& poses, float vertical_fov, float aspect) {
  const glm::vec3 center = 0.5f * (subject.bounds.min + subject.bounds.max);
  // Judge all candidates in each pose, and choose the direction that suits all of them
  StandJudgements sums{};
  const Expected<void> judged = in_each(poses, [&] {
    const StandJudgements here = judge_stands(world, subject, vertical_fov, aspect);
    for (std::size_t i = 0; i < kStands.size(); ++i) sums[i].add(here[i]);
  });
  if (!judged) return tl::unexpected(judged.error());

  // Fit what all poses show into the frame
  const Framing framing =
      make_framing(toward(best_stand(sums, from, poses.count)), vertical_fov, aspect);
  Extents extents;
  const Expected<void> measured =
      in_each(poses, [&] { extents.add(vertex_extents(framing, world.scene(), subject, center)); });
  if (!measured) return tl::unexpected(measured.error());
  return fit(framing, extents, center, vertical_fov);
}

}  // namespace lambent
