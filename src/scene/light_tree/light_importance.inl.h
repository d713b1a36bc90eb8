// SPDX-License-Identifier: Apache-2.0
// The importance of a cluster of lights for a point (in C++ also of several clusters, in the lanes
// of a vector), in the common subset of C++ and GLSL. Without an include guard. The includer
// provides
//   Real             float, or lanes of them with the same operators
//   LAMBENT_REAL_FN  before a function
//   Real root(Real), Real max(Real, float), Real abs(Real)

/// The numbers of a LightTreeNode on which its importance depends.
struct ClusterNumbers {
  Real center_x, center_y, center_z;
  Real half_x, half_y, half_z;
  Real axis_x, axis_y, axis_z;
  Real cos_spread, sin_spread;
  Real intensity, cos_emission;
  Real both_sides;  ///< 1 or 0.
};

/// Bound of a PickLobe at a cluster whose centre is at (x, y, z) from the point: the lobe's maximum
/// over the directions to the cluster, times the share of these that the lobe covers. Where a
/// direction to light turns, the half vector turns by half the angle within the plane of light and
/// viewer, and across this plane by the angle over the length of their sum: far more towards
/// grazing angles.
LAMBENT_REAL_FN Real lobe_at(PickLobe lobe, vec3 normal_ws, ClusterNumbers node, Real x, Real y,
                             Real z, Real middle) {
  Real one = x * 0.0f + 1.0f;
  Real inverse = 1.0f / max(middle, kMinClusterDistance);
  vec3 v = lobe.to_viewer_ws;
  Real l_dot_v = (x * v.x + y * v.y + z * v.z) * inverse;
  Real n_dot_l = (x * normal_ws.x + y * normal_ws.y + z * normal_ws.z) * inverse;
  Real sum = n_dot_l + dot(normal_ws, v);
  Real squared_length = max(2.0f * l_dot_v + 2.0f, kMinSquaredHalfVector);
  Real sine = root(max(one - sum * sum / squared_length, 0.0f));

  // Extent along the line of sight subtends no angle
  Real across_x = node.half_x * node.half_x * (one - x * x * inverse * inverse);
  Real across_y = node.half_y * node.half_y * (one - y * y * inverse * inverse);
  Real across_z = node.half_z * node.half_z * (one - z * z * inverse * inverse);
  Real subtended = max((across_x + across_y + across_z) * inverse * inverse, 0.0f);
  Real turned = subtended / squared_length;

  Real nearest_sine = max(sine - root(turned), 0.0f);
  Real width = one * lobe.squared_alpha;
  Real falloff = width + nearest_sine * nearest_sine * (one - width);
  Real filled = root(width / (width + turned)) * root(width / (width + 0.25f * subtended));
  return lobe.specular * width * filled / (falloff * falloff);
}

/// See light_importance.
LAMBENT_REAL_FN Real importance_of(ClusterNumbers node, vec3 position_ws, vec3 normal_ws,
                                   PickLobe lobe) {
  Real x = node.center_x - position_ws.x;
  Real y = node.center_y - position_ws.y;
  Real z = node.center_z - position_ws.z;
  Real outside_x = max(abs(x) - node.half_x, 0.0f);
  Real outside_y = max(abs(y) - node.half_y, 0.0f);
  Real outside_z = max(abs(z) - node.half_z, 0.0f);
  Real nearest = root(outside_x * outside_x + outside_y * outside_y + outside_z * outside_z);
  Real middle = root(x * x + y * y + z * z);
  Real squared_size =
      node.half_x * node.half_x + node.half_y * node.half_y + node.half_z * node.half_z;

  // Compute the largest cosine at the point: the height of the box above the horizon, over the
  // distance to the box
  vec3 steep = abs(normal_ws);
  Real height = x * normal_ws.x + y * normal_ws.y + z * normal_ws.z +
                (node.half_x * steep.x + node.half_y * steep.y + node.half_z * steep.z);
  // A point in the air has no horizon
  if (normal_ws == vec3(0.0f)) height = nearest + 1.0f;
  Real one = x * 0.0f + 1.0f;
  Real received = height < nearest ? height / nearest : one;
  received *= lobe.diffuse;
  if (lobe.specular > 0.0f) {
    received += lobe_at(lobe, normal_ws, node, x, y, z, middle);
  }

  // Compute the largest cosine at the lights: the angle to the axis less the spread of their
  // orientations
  Real along = -(node.axis_x * x + node.axis_y * y + node.axis_z * z);
  along = node.both_sides > 0.0f ? abs(along) : along;
  along += abs(node.axis_x) * node.half_x + abs(node.axis_y) * node.half_y +
           abs(node.axis_z) * node.half_z;
  Real reach = along >= 0.0f ? nearest : middle + root(squared_size);
  Real cos_light = along < reach ? along / reach : one;
  Real sin_light = root(max(one - cos_light * cos_light, 0.0f));
  Real emitted = cos_light >= node.cos_spread
                     ? one
                     : cos_light * node.cos_spread + sin_light * node.sin_spread;

  Real squared_reach =
      max(nearest * middle + squared_size * kSizeShare, kMinSquaredClusterDistance);
  Real importance = node.intensity * received * emitted / squared_reach;
  importance = importance < kMaxImportance ? importance : one * kMaxImportance;
  Real none = x * 0.0f;
  importance = height > 0.0f ? importance : none;
  return emitted > node.cos_emission ? importance : none;
}
