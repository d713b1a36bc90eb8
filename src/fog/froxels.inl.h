// SPDX-License-Identifier: Apache-2.0
// Froxels along rays, in the common subset of C++ and GLSL. The includer provides what media.inl.h
// requires, the type
//   FroxelsRef  the froxels of a grid, each its source function times its weight, and the weight
// and
//   vec4 fetch_froxel(FroxelsRef froxels, uint index)

/// The part in a froxel and in fog of a ray that ends at `ray_end` [m].
LAMBENT_FN FroxelSegment froxel_segment(FroxelGrid grid, MediaRef media, vec3 origin_ws,
                                        vec3 direction_ws, float ray_end, uint slice) {
  vec2 fog = fog_range(media, origin_ws, direction_ws, ray_end);
  float begin = max(slice_begin(grid, slice), fog.x);
  float end = min(slice_begin(grid, slice + 1u), fog.y);
  FroxelSegment segment = {begin, end, 0.0f};
  if (end > begin) segment.depth = optical_depth(media, origin_ws, direction_ws, begin, end);
  return segment;
}

/// Share of the light at the segment's begin that fog at this distance extinguishes per metre
/// [1/m].
LAMBENT_FN float extinction_at(MediaRef media, vec3 origin_ws, vec3 direction_ws,
                               FroxelSegment segment, float distance) {
  float passed = optical_depth(media, origin_ws, direction_ws, segment.begin, distance);
  return fog_density(media, origin_ws + distance * direction_ws) * exp(-passed);
}

/// Samples a point of a segment in proportion to the light extinguished there, from a uniform
/// number. The density of points is that of constant fog of the same optical depth; the weight
/// corrects for the difference.
LAMBENT_FN FroxelPoint froxel_point(MediaRef media, vec3 origin_ws, vec3 direction_ws,
                                    FroxelSegment segment, float u) {
  FroxelPoint point = {0.0f, 0.0f};
  float mean_density = segment.depth / (segment.end - segment.begin);
  if (!(mean_density > 0.0f)) return point;
  float share = segment.depth * mean_of_decay(segment.depth);
  float drawn = drawn_depth(u * share);
  point.distance = min(segment.begin + drawn / mean_density, segment.end);
  float passed = optical_depth(media, origin_ws, direction_ws, segment.begin, point.distance);
  float density = fog_density(media, origin_ws + point.distance * direction_ws);
  point.weight = share * (density / mean_density) * exp(min(drawn - passed, 0.0f));
  return point;
}

/// Samples a point of a segment for the light of a lamp: where the lamp is near, by the inverse
/// square of the distance to it (Kulla and Fajardo, "Importance Sampling Techniques for Path
/// Tracing in Participating Media", EGSR 2012, sec. 4.1). The distance at which the ray passes the
/// lamp is replaced by `height`, see lamp_height(), so that light does not depend on where in the
/// column the ray happens to run: rays that nearly hit the lamp would be single bright froxels.
/// Where the lamp is not near, returns `otherwise`.
LAMBENT_FN FroxelPoint lamp_point(MediaRef media, CameraRay ray, FroxelSegment segment,
                                  FroxelPoint otherwise, vec3 lamp_ws, float height, float u) {
  vec3 to_lamp = lamp_ws - ray.origin_ws;
  float nearest = dot(to_lamp, ray.direction_ws);
  float edge = segment.end - segment.begin;
  float beyond = max(max(segment.begin - nearest, nearest - segment.end), 0.0f);
  if (length(vec2(height, beyond)) > kNearLamp * edge) return otherwise;
  float first = atan((segment.begin - nearest) / height);
  float angles = atan((segment.end - nearest) / height) - first;
  float angle = first + u * angles;
  float along = height * (sin(angle) / max(cos(angle), kLeastLampCosine));
  FroxelPoint point = {clamp(nearest + along, segment.begin, segment.end), 0.0f};
  vec3 way = to_lamp - point.distance * ray.direction_ws;
  point.weight = extinction_at(media, ray.origin_ws, ray.direction_ws, segment, point.distance) *
                 angles * (dot(way, way) / height);
  return point;
}

/// A froxel's value, filtered with those of the froxels around it.
LAMBENT_FN vec4 smoothed_froxel(FroxelGrid grid, FroxelsRef froxels, uint column, uint row,
                                uint slice) {
  vec4 sum = vec4(0.0f);
  for (int y = -1; y <= 1; ++y) {
    for (int x = -1; x <= 1; ++x) {
      int at_x = int(column) + x;
      int at_y = int(row) + y;
      if (at_x < 0 || at_x >= int(grid.columns)) continue;
      if (at_y < int(grid.first_row) || at_y >= int(grid.end_row)) continue;
      for (int z = -1; z <= 1; ++z) {
        int at_z = int(slice) + z;
        if (at_z < 0 || at_z >= int(grid.slices)) continue;
        // Weight by the binomial filter of three along each axis
        float weight = (x == 0 ? 2.0f : 1.0f) * (y == 0 ? 2.0f : 1.0f) * (z == 0 ? 2.0f : 1.0f);
        sum +=
            weight * fetch_froxel(froxels, froxel_index(grid, uint(at_x), uint(at_y), uint(at_z)));
      }
    }
  }
  return sum * (1.0f / 64.0f);
}

/// The four columns around a point of the picture.
struct FroxelTaps {
  uint columns[4];   ///< Index of each column's first froxel.
  float weights[4];  ///< Bilinear weights; they sum to 1.
};

LAMBENT_FN FroxelTaps froxel_taps(FroxelGrid grid, vec2 pixel) {
  vec2 at = pixel / grid.pixels - vec2(0.5f);
  vec2 last = vec2(float(grid.columns - 1u), float(grid.rows - 1u));
  at = clamp(at, vec2(0.0f), last);
  vec2 corner = floor(at);
  vec2 fraction = at - corner;
  FroxelTaps taps;
  for (int k = 0; k < 4; ++k) {
    vec2 way = vec2(float(k & 1), float(k >> 1));
    vec2 tap = min(corner + way, last);
    taps.columns[k] = froxel_index(grid, uint(tap.x), uint(tap.y), 0u);
    taps.weights[k] = (k & 1) != 0 ? fraction.x : 1.0f - fraction.x;
    taps.weights[k] *= (k >> 1) != 0 ? fraction.y : 1.0f - fraction.y;
  }
  return taps;
}

/// Bilinear interpolation of a slice's froxels between columns.
LAMBENT_FN vec4 froxel_between(FroxelsRef froxels, FroxelTaps taps, uint slice) {
  vec4 sum = vec4(0.0f);
  for (int k = 0; k < 4; ++k) {
    if (taps.weights[k] > 0.0f) {
      sum += taps.weights[k] * fetch_froxel(froxels, taps.columns[k] + slice);
    }
  }
  return sum;
}

/// The effect of fog on light along a ray that ends at `ray_end` [m]: the radiance that it scatters
/// to the camera (RGB), and its transmittance (A). The radiance is the sum over slices of
/// [source function * (transmittance to the slice's begin - to its end)].
LAMBENT_FN vec4 fog_along(FroxelGrid grid, MediaRef media, FroxelsRef froxels, vec2 pixel,
                          vec3 origin_ws, vec3 direction_ws, float ray_end) {
  vec2 fog = fog_range(media, origin_ws, direction_ws, ray_end);
  if (!(fog.y > fog.x)) return vec4(0.0f, 0.0f, 0.0f, 1.0f);
  FroxelTaps taps = froxel_taps(grid, pixel);
  vec3 scattered = vec3(0.0f);
  vec3 source = vec3(0.0f);
  float depth = 0.0f;
  float passed = 1.0f;
  float begin = fog.x;
  uint last = slice_of(grid, fog.y);
  for (uint slice = slice_of(grid, begin); slice <= last; ++slice) {
    float end = slice == last ? fog.y : clamp(slice_begin(grid, slice + 1u), begin, fog.y);
    depth += optical_depth(media, origin_ws, direction_ws, begin, end);
    float left = exp(-depth);
    // Where froxels have no light, as none of their rays came so far, use the previous slice's
    vec4 held = froxel_between(froxels, taps, slice);
    if (held.w > kLeastFroxelWeight) source = vec3(held) / held.w;
    scattered += source * (passed - left);
    passed = left;
    begin = end;
    if (passed < kOpaque) break;
  }
  // The remainder behind opaque fog is as bright as the last slice
  if (passed < kOpaque) return vec4(scattered + source * passed, 0.0f);
  return vec4(scattered, passed);
}

/// A froxel's value in the previous frame, at the place of its middle; all 0 outside that view.
LAMBENT_FN vec4 froxel_before(FroxelGrid before, FroxelsRef froxels, vec3 middle_ws) {
  ImagePoint seen = image_point(before.camera, middle_ws);
  vec2 at = seen.pixel / before.pixels;
  // Written so that NaN is outside
  bool inside = seen.depth > 0.0f && at.x >= 0.0f && at.y >= 0.0f &&
                at.x <= float(before.columns) && at.y <= float(before.rows);
  if (!inside) return vec4(0.0f);
  float distance =
      before.camera.orthographic != 0u ? seen.depth : length(middle_ws - before.camera.position_ws);
  if (distance < before.nearest || distance > before.farthest) return vec4(0.0f);
  FroxelTaps taps = froxel_taps(before, seen.pixel);
  float slice = clamp(slice_coordinate(before, distance) - 0.5f, 0.0f, float(before.slices - 1u));
  uint first = uint(slice);
  uint second = min(first + 1u, before.slices - 1u);
  return mix(froxel_between(froxels, taps, first), froxel_between(froxels, taps, second),
             slice - float(first));
}
