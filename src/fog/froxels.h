// SPDX-License-Identifier: Apache-2.0
// Froxels: cells of the view that hold the light which fog scatters to the camera.
// Based on: Wronski, "Volumetric Fog: Unified, Compute Shader Based Solution to Atmospheric
// Scattering", SIGGRAPH 2014 course; Hillaire, "Physically Based and Unified Volumetric Rendering
// in Frostbite", SIGGRAPH 2015 course (a cell's light is weighted by its exact transmittance).
//
// A froxel holds the source function: the radiance that fog sends to the camera over what it
// extinguishes. It varies as light does, not as fog does. So a ray's share of each slice is
// computed by closed form from the ray's own transmittance, and no picture shows where slices end.
#ifndef LAMBENT_FOG_FROXELS_H
#define LAMBENT_FOG_FROXELS_H

#include "raytracing/camera_math.h"
#include "scene/media/medium.h"
#include "shared/random.h"
#include "shared/sampling.h"

LAMBENT_BEGIN

/// A column of froxels is a square of pixels; its slices are cut by distance along rays.
struct FroxelGrid {
  CameraRecord camera;
  uint columns;    ///< Across the picture.
  uint rows;       ///< Down the picture.
  uint first_row;  ///< The first row of which froxels are held, ...
  uint end_row;    ///< ... and the row after the last one.
  uint slices;     ///< Along the view.
  float pixels;    ///< Edge of a column [pixels].
  float nearest;   ///< Where the first slice begins [m].
  float farthest;  ///< Where the last one ends [m], above `nearest`.
};

// Slices end at distances in proportion to this power of their number: those near the camera, which
// are seen with a small base, are thinner, and those far away are not so thick as to blur shafts.
const float kSlicePower = 1.5f;

/// Weights of froxels below this stand for no fog: quotients of them would not be finite.
const float kLeastFroxelWeight = 1e-20f;

/// Share of light that is left where more fog changes nothing that shows.
const float kOpaque = 1e-6f;

// Keeps the random numbers of froxels apart from those of other passes.
const uint kFroxelSalt = 0x464F4747u;

/// The distance at which a slice begins [m].
LAMBENT_FN float slice_begin(FroxelGrid grid, uint slice) {
  float share = pow(float(slice) / float(grid.slices), kSlicePower);
  return grid.nearest + (grid.farthest - grid.nearest) * share;
}

/// The slice of a distance, as a real number: from k to k + 1 within slice k, 0 to `slices`.
LAMBENT_FN float slice_coordinate(FroxelGrid grid, float distance) {
  float share = clamp((distance - grid.nearest) / (grid.farthest - grid.nearest), 0.0f, 1.0f);
  return float(grid.slices) * pow(share, 1.0f / kSlicePower);
}

/// The slice that a distance is in.
LAMBENT_FN uint slice_of(FroxelGrid grid, float distance) {
  return min(uint(slice_coordinate(grid, distance)), grid.slices - 1u);
}

/// The place of a froxel among those that are held.
LAMBENT_FN uint froxel_index(FroxelGrid grid, uint column, uint row, uint slice) {
  return ((row - grid.first_row) * grid.columns + column) * grid.slices + slice;
}

/// Where in the picture ray `index` of a column runs [pixels]: spread evenly over its pixels.
LAMBENT_FN vec2 column_point(FroxelGrid grid, uint column, uint row, uint index, uint frame,
                             uint seed) {
  RandomStream random = make_random_stream(row * grid.columns + column, frame ^ kFroxelSalt, seed);
  vec2 shift = next_uniform2(random);
  vec2 corner = vec2(float(column), float(row)) * grid.pixels;
  vec2 point = corner + fract(shift + plastic_sequence(index)) * grid.pixels;
  // The last columns reach beyond the picture, where nothing is seen
  return min(point, 2.0f * grid.camera.half_size);
}

/// A uniform number for the depth of a sample: along a column all samples together are spread
/// evenly.
LAMBENT_FN float depth_number(FroxelGrid grid, uint column, uint row, uint slice, uint index,
                              uint samples, uint frame, uint seed) {
  RandomStream random =
      make_random_stream(row * grid.columns + column, (frame ^ kFroxelSalt) + 1u, seed);
  float turn = fract(float(slice * samples + index) * (kGoldenRatio - 1.0f));
  return min(fract(next_uniform(random) + turn), kLargestUniform);
}

const float kNaturalLogOf2 = 0.693147180559945f;

/// The optical depth before which this share of light is extinguished: -ln(1 - share), by its
/// series where that is small.
LAMBENT_FN float drawn_depth(float share) {
  if (share < kSmallExponent) return share * (1.0f + share * (0.5f + share * (1.0f / 3.0f)));
  return -kNaturalLogOf2 * log2(1.0f - share);
}

/// A lamp is near a segment where it is within so many times its length: farther away, its light
/// varies little along it.
const float kNearLamp = 4.0f;
/// Columns that are farther from a lamp than so many of their widths see it as from their middle.
const float kWideColumn = 8.0f;
/// No column is narrower than this share of the distance to a lamp: heights stay above 0.
const float kLeastColumnWidth = 1e-6f;

/// Part of corner_term(): x asinh(y / |x|), which is 0 at x = 0.
LAMBENT_FN float side_term(float x, float y) {
  if (x == 0.0f) return 0.0f;
  float ratio = abs(y / x);
  float log_of_both = kNaturalLogOf2 * log2(ratio + sqrt(ratio * ratio + 1.0f));
  return y < 0.0f ? -x * log_of_both : x * log_of_both;
}

/// The integral of 1 / sqrt(x^2 + y^2) over the rectangle from (0, 0) to a corner, but for its
/// sign: [x asinh(y / |x|) + y asinh(x / |y|)].
LAMBENT_FN float corner_term(float x, float y) {
  return side_term(x, y) + side_term(y, x);
}

/// One over the mean of 1 / r over a column's rays, where r is how far they pass from a lamp [m]: a
/// ray's light from the lamp is in proportion to 1 / r.
LAMBENT_FN float lamp_height(FroxelGrid grid, CameraRay middle, vec2 middle_pixel, vec3 lamp_ws) {
  vec3 to_lamp = lamp_ws - middle.origin_ws;
  vec3 across = to_lamp - dot(to_lamp, middle.direction_ws) * middle.direction_ws;
  float width = max(abs(pixel_width(grid.camera, lamp_ws)) * grid.pixels,
                    kLeastColumnWidth * max(length(to_lamp), 1.0f));
  float distance = max(length(across), kLeastColumnWidth * width);
  ImagePoint lamp = image_point(grid.camera, lamp_ws);
  if (distance > kWideColumn * width || !(lamp.depth > 0.0f)) return distance;
  // The lamp from the column's corners, in widths of a column
  vec2 low = (middle_pixel - lamp.pixel) / grid.pixels - vec2(0.5f);
  vec2 high = low + vec2(1.0f);
  float sum = corner_term(high.x, high.y) - corner_term(low.x, high.y) -
              corner_term(high.x, low.y) + corner_term(low.x, low.y);
  return sum > 0.0f ? width / sum : distance;
}

/// Cosines of these angles are above it, but for rounding.
const float kLeastLampCosine = 1e-6f;

/// A part of a ray.
struct FroxelSegment {
  float begin;  ///< [m]
  float end;    ///< Not above `begin`: it is empty.
  float depth;  ///< Optical depth of its fog.
};

/// A point of a froxel at which light is found, and how much it counts.
struct FroxelPoint {
  float distance;  ///< Along the ray [m].
  float weight;    ///< Share of light that fog there extinguishes; 0: there is none.
};

LAMBENT_END
#endif
