// SPDX-License-Identifier: Apache-2.0
// Computes a better position of a probe from the hits of its fixed rays. The includer provides
//   int hit_count();                 // how many hits the fixed rays have
//   FixedRayHit hit_at(int index);
//   int plane_count();               // how many planes of hits pass below the probe
//   PlaneBelow plane_at(int rank);   // one of these planes; rank 0 is the nearest
// Everything is in the frame of the probe's grid.

/// The place outside geometry, just behind one of the back faces that rays hit, that is nearest to
/// the probe's place on the grid. Returns `position` where none is within reach.
LAMBENT_FN vec3 nearest_exit(vec3 position, vec3 grid_position, vec3 spacing, float margin) {
  vec3 best = position;
  float nearest = infinity();
  for (int i = 0; i < hit_count(); ++i) {
    FixedRayHit hit = hit_at(i);
    if (hit.from_inside == 0u) continue;
    vec3 outside = position + hit.distance * hit.direction - margin * hit.normal;
    float away = length(outside - grid_position);
    if (away >= nearest || !within_reach(outside, grid_position, spacing)) continue;
    nearest = away;
    best = outside;
  }
  return best;
}

/// How far a probe may move away from a plane: to the middle between it and an opposite plane [m].
/// One that leaves no room, closer than `least_room` [m], is passed.
LAMBENT_FN float room_above(PlaneBelow below, float least_room) {
  for (int rank = 0; rank < plane_count(); ++rank) {
    PlaneBelow plane = plane_at(rank);
    if (dot(plane.normal, below.normal) > -kMaxCornerCosine) continue;
    if (plane.height + below.height < least_room) continue;
    return max(0.0f, 0.5f * (plane.height - below.height));
  }
  return infinity();
}

/// Whether a probe is in a sheet: there is no room between a plane below it and an opposite one.
LAMBENT_FN bool is_in_sheet(PlaneBelow below, float least_room) {
  for (int rank = 0; rank < plane_count(); ++rank) {
    PlaneBelow plane = plane_at(rank);
    if (plane.height + below.height >= least_room) return false;
    if (dot(plane.normal, below.normal) <= -kMaxCornerCosine) return true;
  }
  return false;
}

/// A better position for a probe at `from`, or `from` itself where it should stay. It is at most
/// kMaxProbeOffset of a cell from the probe's place on the grid, `grid_position`. For `odd` see
/// side_of_sheet().
LAMBENT_FN vec3 better_place(vec3 from, vec3 grid_position, vec3 spacing, uint inside_geometry,
                             uint odd) {
  float smallest = min(spacing.x, min(spacing.y, spacing.z));
  float margin = kSurfaceMargin * smallest;
  if (inside_geometry != 0u) return nearest_exit(from, grid_position, spacing, margin);

  // Move to just in front of the nearest surface, then along it to just in front of the nearest one
  // that faces another way, and along both of them to a third
  vec3 position = from;
  vec3 axes[3];
  int count = 0;
  for (int rank = 0; rank < plane_count(); ++rank) {
    PlaneBelow plane = plane_at(rank);
    if (count == 3 || plane.height > smallest) break;
    if (is_in_sheet(plane, kLeastRoom * smallest)) plane = side_of_sheet(plane, odd);
    vec3 along = plane.normal;
    bool faces_another_way = true;
    for (int a = 0; a < count; ++a) {
      if (abs(dot(axes[a], plane.normal)) > kMaxCornerCosine) faces_another_way = false;
      along -= dot(axes[a], along) * axes[a];
    }
    float steepness = length(along);
    if (!faces_another_way || steepness < kMinSteepness) continue;
    along /= steepness;
    float rise = min(margin - plane.height, room_above(plane, kLeastRoom * smallest));
    vec3 there = position + along * (rise / max(dot(along, plane.normal), kMinSteepness));
    if (!within_reach(there, grid_position, spacing)) continue;
    axes[count++] = along;
    if (abs(rise) > kMarginTolerance * margin) position = there;
  }
  return position;
}

/// Takes one step of a probe's relocation from its `offset` [cells]. Returns the next offset. `odd`
/// comes from is_odd_probe().
LAMBENT_FN vec3 relocate(LAMBENT_INOUT(RelocationState) relocation, vec3 offset, vec3 spacing,
                         uint inside_geometry, uint odd) {
  // Work along the axes of the grid, relative to the probe's place on it
  vec3 position = offset * spacing;
  vec3 better = better_place(position, vec3(0.0f), spacing, inside_geometry, odd);
  float margin = kSurfaceMargin * min(spacing.x, min(spacing.y, spacing.z));
  float cost = placement_cost(position, better, margin, inside_geometry);
  return relocation_step(relocation, offset, better == position ? offset : better / spacing, cost);
}
