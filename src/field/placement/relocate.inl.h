// SPDX-License-Identifier: Apache-2.0
// Where a probe had better stand, by what it sees. The includer provides
//   int hit_count();               // sights, ...
//   FixedRayHit hit_at(int index);
//   int plane_count();               // ... and those that pass below the probe, the nearest first
//   PlaneBelow plane_at(int rank);
// All is in the frame of the probe's grid.

/// To just outside the solid matter, as near to home as rays have found a way.
LAMBENT_FN vec3 nearest_exit(vec3 position, vec3 home, vec3 spacing, float margin) {
  vec3 best = position;
  float nearest = infinity();
  for (int i = 0; i < hit_count(); ++i) {
    FixedRayHit hit = hit_at(i);
    if (hit.back_face == 0u) continue;
    vec3 outside = position + hit.distance * hit.direction - margin * hit.normal;
    float away = length(outside - home);
    if (away >= nearest || !within_reach(outside, home, spacing)) continue;
    nearest = away;
    best = outside;
  }
  return best;
}

/// How far a probe may rise over a plane: to the middle between it and what is opposite [m].
LAMBENT_FN float room_above(PlaneBelow below) {
  for (int rank = 0; rank < plane_count(); ++rank) {
    PlaneBelow plane = plane_at(rank);
    if (dot(plane.normal, below.normal) > -kMaxCornerCosine) continue;
    return max(0.0f, 0.5f * (plane.height - below.height));
  }
  return infinity();
}

/// Where a probe that belongs at `home` and sees this from `from` had better stand; `from` itself
/// where it may stay. At most kMaxProbeOffset of a cell from home.
LAMBENT_FN vec3 better_place(vec3 from, vec3 home, vec3 spacing, uint inside_geometry) {
  float smallest = min(spacing.x, min(spacing.y, spacing.z));
  float margin = kSurfaceMargin * smallest;
  if (inside_geometry != 0u) return nearest_exit(from, home, spacing, margin);

  // Step to just in front of the nearest surface, then along it to the next one that faces another
  // way, and along both to a third
  vec3 position = from;
  vec3 axes[3];
  int count = 0;
  for (int rank = 0; rank < plane_count(); ++rank) {
    PlaneBelow plane = plane_at(rank);
    if (count == 3 || plane.height > smallest) break;
    vec3 along = plane.normal;
    bool faces_another_way = true;
    for (int a = 0; a < count; ++a) {
      if (abs(dot(axes[a], plane.normal)) > kMaxCornerCosine) faces_another_way = false;
      along -= dot(axes[a], along) * axes[a];
    }
    float steepness = length(along);
    if (!faces_another_way || steepness < kMinSteepness) continue;
    along /= steepness;
    float rise = min(margin - plane.height, room_above(plane));
    vec3 there = position + along * (rise / max(dot(along, plane.normal), kMinSteepness));
    if (!within_reach(there, home, spacing)) continue;
    axes[count++] = along;
    if (abs(rise) > kMarginTolerance * margin) position = there;
  }
  return position;
}
