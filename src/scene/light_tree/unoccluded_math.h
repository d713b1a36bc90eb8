// SPDX-License-Identifier: Apache-2.0
// The unoccluded light of lights and of clusters of lights at a point, in closed form.
#ifndef LAMBENT_SCENE_LIGHT_TREE_UNOCCLUDED_MATH_H
#define LAMBENT_SCENE_LIGHT_TREE_UNOCCLUDED_MATH_H

#include "scene/emissive_sample.h"
#include "scene/light_tree/light_tree_math.h"
#include "shared/constants.h"

LAMBENT_BEGIN

// A cluster whose half diagonal is at most this share of its distance counts as one small light.
// Half of this takes up to three times as long, and pictures are no better (docs/math.md, "The last
// metre").
const float kSmallCluster = 0.4f;
// From this share on, the parts of a cluster count one by one. Between the two shares both results
// are blended, since steps from one point to the next would be visible.
const float kLargeCluster = 0.8f;

/// Blend weight with which a cluster's parts count one by one.
LAMBENT_FN float opened_share(LightTreeNode node, vec3 position_ws) {
  vec3 offset = node.center_ws - position_ws;
  float size = length(node.half_size);
  float reach = length(offset);
  float t =
      clamp((size - kSmallCluster * reach) / ((kLargeCluster - kSmallCluster) * reach + 1e-30f),
            0.0f, 1.0f);
  return t * t * (3.0f - 2.0f * t);
}

/// Angle between two unit vectors over its sine, from its cosine. Abramowitz and Stegun, "Handbook
/// of Mathematical Functions", 1964, 4.4.45: within 0.01 %.
LAMBENT_FN float angle_over_sine(float cosine) {
  float x = min(abs(cosine), 1.0f);
  float angle = 1.5707288f + x * (-0.2121144f + x * (0.0742610f - x * 0.0187293f));
  float acute = angle * inversesqrt(1.0f + x);
  if (cosine >= 0.0f) return acute;
  return kPi * inversesqrt(max(1.0f - x * x, 1e-12f)) - acute;
}

/// Contribution of an edge between two directions to a polygon's form factor, times 2 pi.
LAMBENT_FN float edge_form_factor(vec3 a, vec3 b, vec3 normal) {
  float scale = inversesqrt(max(dot(a, a) * dot(b, b), 1e-37f));
  return dot(cross(a, b), normal) * scale * angle_over_sine(dot(a, b) * scale);
}

/// The point where an edge crosses the horizon; the heights of its ends have different signs.
LAMBENT_FN vec3 on_horizon(vec3 a, float height_a, vec3 b, float height_b) {
  return (a * height_b - b * height_a) / (height_b - height_a);
}

/// The share of the cosine-weighted hemisphere about `normal` that a triangle covers, given by its
/// corners relative to the point. Lambert, "Photometria", 1760; Baum, Rushmeier and Winget,
/// "Improving Radiosity Solutions through the Use of Analytically Determined Form-Factors",
/// SIGGRAPH 1989.
LAMBENT_FN float triangle_form_factor(vec3 corner, vec3 edge1, vec3 edge2, vec3 normal) {
  vec3 a = corner;
  vec3 b = corner + edge1;
  vec3 c = corner + edge2;
  vec3 d = a;
  vec3 heights = vec3(dot(a, normal), dot(b, normal), dot(c, normal));
  int above = (heights.x > 0.0f ? 1 : 0) + (heights.y > 0.0f ? 1 : 0) + (heights.z > 0.0f ? 1 : 0);
  if (above == 0) return 0.0f;
  if (above < 3) {
    // Rotate the corners so that the first one is alone on its side of the horizon, and clip there
    bool alone = above == 1;
    if ((heights.y > 0.0f) == alone && (heights.x > 0.0f) != alone && (heights.z > 0.0f) != alone) {
      vec3 first = a;
      a = b, b = c, c = first;
      heights = vec3(heights.y, heights.z, heights.x);
    } else if ((heights.z > 0.0f) == alone && (heights.x > 0.0f) != alone) {
      vec3 first = a;
      a = c, c = b, b = first;
      heights = vec3(heights.z, heights.x, heights.y);
    }
    vec3 ab = on_horizon(a, heights.x, b, heights.y);
    vec3 ac = on_horizon(a, heights.x, c, heights.z);
    if (alone) {
      b = ab;
      c = ac;
      d = a;
    } else {
      a = ab;
      d = ac;
    }
  }
  float sum = edge_form_factor(a, b, normal) + edge_form_factor(b, c, normal);
  sum += above == 2 ? edge_form_factor(c, d, normal) + edge_form_factor(d, a, normal)
                    : edge_form_factor(c, a, normal);
  return 0.5f * kInvPi * abs(sum);
}

/// Mean of the cosine, clamped to 0 below the horizon, over the interval of `size` to both sides of
/// `cosine`.
LAMBENT_FN float cosine_above_horizon(float cosine, float size) {
  if (cosine >= size) return cosine;
  float part = max(cosine + size, 0.0f);
  return part * part / (4.0f * max(size, 1e-20f));
}

/// Intensity of a cluster in a direction, over the sum of its lights' intensities along their axes:
/// from its cone if that is narrow, otherwise the mean over all directions.
LAMBENT_FN float sent_by_cluster(LightTreeNode node, vec3 from_light) {
  float along = dot(node.axis_ws, from_light);
  float sent = abs(along);
  if (node.both_sides == 0u) {
    // Spot lights emit evenly within their cones, and nothing beyond
    float sin_emission = sqrt(max(1.0f - node.cos_emission * node.cos_emission, 0.0f));
    float last = node.cos_emission * node.cos_spread - sin_emission * node.sin_spread;
    sent = clamp((along - last) / max(1.0f - last, 1e-3f), 0.0f, 1.0f);
  }
  return mix(node.mean_relative_intensity, sent, 0.5f + 0.5f * node.cos_spread);
}

/// Luminance of a white Lambert surface with this unit normal under a cluster that counts as one
/// small light [W/(m^2 sr)].
LAMBENT_FN float light_of_cluster(LightTreeNode node, vec3 position_ws, vec3 normal_ws) {
  vec3 offset = node.center_ws - position_ws;
  float squared = max(dot(offset, offset) + kSizeShare * dot(node.half_size, node.half_size),
                      kMinSquaredClusterDistance);
  float inverse = inversesqrt(squared);
  float received = cosine_above_horizon(dot(normal_ws, offset) * inverse,
                                        dot(abs(normal_ws), node.half_size) * inverse);
  float sent = sent_by_cluster(node, -offset * inverse);
  return min(node.intensity * kInvPi * received * sent / squared, kMaxImportance);
}

LAMBENT_END
#endif
