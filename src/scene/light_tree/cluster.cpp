// SPDX-License-Identifier: Apache-2.0
#include "scene/light_tree/cluster.h"

#include <algorithm>
#include <cmath>

#include "shared/color.h"
#include "shared/constants.h"

namespace lambent {
namespace {

// Cones are widened by this [rad], far more than the rounding of their axes: a light just outside
// its cone could otherwise count as facing away.
constexpr float kConeMargin = 1e-3f;

float angle_of(float cosine) {
  return std::acos(std::clamp(cosine, -1.0f, 1.0f));
}

/// Mean of cone_attenuation over all directions: 1 within the inner cone; from there to the outer
/// one, the square of a linear function of the cosine, whose mean is a third.
double mean_cone_attenuation(const LightRecord& light) {
  if (light.type != kLightSpot) return 1.0;
  const double cos_inner = std::min(light.cos_outer + 1.0 / light.cone_scale, 1.0);
  return 0.5 * ((1.0 - cos_inner) + (cos_inner - light.cos_outer) / 3.0);
}

}  // namespace

FacingCone join(const FacingCone& a, const FacingCone& b) {
  const FacingCone& wide = a.cos_spread <= b.cos_spread ? a : b;
  const FacingCone& narrow = a.cos_spread <= b.cos_spread ? b : a;
  FacingCone joined = wide;
  joined.cos_emission = std::min(a.cos_emission, b.cos_emission);
  joined.both_sides = a.both_sides || b.both_sides;

  // Reverse the axis of the narrow one if it has two sides, or else that of the wide one
  glm::vec3 other = narrow.axis;
  if (glm::dot(wide.axis, other) < 0.0f) {
    if (narrow.both_sides) {
      other = -other;
    } else if (wide.both_sides) {
      joined.axis = -joined.axis;
    }
  }
  const float wide_angle = angle_of(wide.cos_spread), narrow_angle = angle_of(narrow.cos_spread);
  const float between = angle_of(glm::dot(joined.axis, other));
  if (between + narrow_angle <= wide_angle) return joined;
  const float spread = 0.5f * (wide_angle + between + narrow_angle) + kConeMargin;
  const glm::vec3 across = other - glm::dot(other, joined.axis) * joined.axis;
  const float length = glm::length(across);
  if (spread >= kPi || length <= 0.0f) {
    joined.cos_spread = -1.0f;
    return joined;
  }
  const float turn = spread - wide_angle;
  joined.axis = glm::normalize(std::cos(turn) * joined.axis + std::sin(turn) * (across / length));
  joined.cos_spread = std::cos(spread);
  return joined;
}

void LightCluster::add(const LightCluster& other) {
  if (other.empty) return;
  if (empty) {
    *this = other;
    return;
  }
  box.add(other.box);
  cone = join(cone, other.cone);
  intensity += other.intensity;
  intensity_rgb += other.intensity_rgb;
  mean += other.mean;
}

double LightCluster::cost() const {
  if (empty) return 0.0;
  // The measure of directions is between pi, for a flat cluster, and 4 pi; approximate it as linear
  // in the cosine
  const double directions = kPi * (1.0 + 1.5 * (1.0 - cone.cos_spread));
  const glm::dvec3 size(box.max - box.min);
  const double area = 2.0 * (size.x * size.y + size.y * size.z + size.z * size.x);
  // Boxes without an area, such as those of lights in a row, differ by their length
  constexpr double kLengthShare = 1e-3;
  const double longest = std::max({size.x, size.y, size.z});
  return intensity * directions * (area + kLengthShare * longest * longest);
}

LightCluster cluster_of(const EmitterRecord& emitter, float intensity, const glm::vec3& tint) {
  LightCluster cluster;
  cluster.box.add(emitter.corner_ws);
  cluster.box.add(emitter.corner_ws + emitter.edge1_ws);
  cluster.box.add(emitter.corner_ws + emitter.edge2_ws);
  cluster.cone.axis = triangle_normal(emitter.edge1_ws, emitter.edge2_ws);
  cluster.cone.cos_emission = 0.0f;
  cluster.cone.both_sides = true;
  // The normal of a thin triangle is unreliable
  if (!(std::abs(glm::dot(cluster.cone.axis, cluster.cone.axis) - 1.0f) < 1e-3f)) {
    cluster.cone.axis = glm::vec3(0.0f, 0.0f, 1.0f);
    cluster.cone.cos_spread = -1.0f;
  }
  cluster.intensity = intensity;
  cluster.intensity_rgb = cluster.intensity * glm::dvec3(tint);
  cluster.mean = 0.5 * intensity;  // the mean of the cosine on both sides
  cluster.empty = false;
  return cluster;
}

LightCluster cluster_of(const LightRecord& light) {
  LightCluster cluster;
  cluster.box.add(light.position_ws);
  if (light.type == kLightSpot) {
    cluster.cone.axis = light.direction_ws;
    cluster.cone.cos_emission = light.cos_outer;
  } else {
    cluster.cone.cos_spread = -1.0f;
    cluster.cone.cos_emission = 0.0f;
  }
  cluster.intensity = luminance(light.intensity);
  cluster.intensity_rgb = light.intensity;
  cluster.mean = cluster.intensity * mean_cone_attenuation(light);
  cluster.empty = false;
  return cluster;
}

LightTreeNode node_of(const LightCluster& cluster) {
  LightTreeNode node{};
  node.center_ws = 0.5f * cluster.box.min + 0.5f * cluster.box.max;
  // Rounding of the centre must not exclude a corner
  constexpr float kRounding = 1e-6f;
  const glm::vec3 reach = glm::max(glm::abs(cluster.box.min), glm::abs(cluster.box.max));
  const glm::vec3 size = cluster.box.max - cluster.box.min;
  node.half_size = 0.5f * size + (size != glm::vec3(0.0f) ? kRounding * reach : glm::vec3(0.0f));
  node.axis_ws = cluster.cone.axis;
  const float spread = angle_of(cluster.cone.cos_spread);
  node.cos_spread = std::cos(spread);
  node.sin_spread = cluster.cone.cos_spread <= -1.0f ? 0.0f : std::sin(spread);
  // Importance requires a cosine above this bound, but a spot light's cone includes its edge
  node.cos_emission = cluster.cone.cos_emission - (cluster.cone.cos_emission > 0.0f ? 1e-5f : 0.0f);
  node.intensity = static_cast<float>(cluster.intensity);
  node.mean_relative_intensity =
      cluster.intensity > 0.0 ? static_cast<float>(cluster.mean / cluster.intensity) : 0.0f;
  node.both_sides = cluster.cone.both_sides ? 1u : 0u;
  node.tint = cluster.intensity > 0.0 ? glm::vec3(cluster.intensity_rgb / cluster.intensity)
                                      : glm::vec3(1.0f);
  return node;
}

}  // namespace lambent
