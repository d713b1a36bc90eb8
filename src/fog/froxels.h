// SPDX-License-Identifier: Apache-2.0
// Froxels: cells of the view frustum that hold the light which fog scatters to the camera.
// Based on: Wronski, "Volumetric Fog: Unified, Compute Shader Based Solution to Atmospheric
// Scattering", SIGGRAPH 2014 course; Hillaire, "Physically Based and Unified Volumetric Rendering
// in Frostbite", SIGGRAPH 2015 course (a cell's light is weighted by its exact transmittance).
//
// A froxel holds the source function: the radiance that fog sends to the camera, divided by its
// extinction. It varies with light, not with the fog's density. So the contribution of each slice
// is computed in closed form from the ray's own transmittance, and the boundaries of slices are not
// visible.
#ifndef LAMBENT_FOG_FROXELS_H
#define LAMBENT_FOG_FROXELS_H

#include "raytracing/camera_math.h"
#include "scene/media/medium.h"
#include "shared/random.h"
#include "shared/sampling.h"

LAMBENT_BEGIN

/// A column of froxels is a square of pixels; its slices are bounded by distances along rays.
struct FroxelGrid {
  CameraRecord camera;
  uint columns;    ///< Number of columns across the picture.
  uint rows;       ///< Number of rows of columns down the picture.
  uint first_row;  ///< First row whose froxels are stored.
  uint end_row;    ///< One past the last row whose froxels are stored.
  uint slices;     ///< Number of slices along the view.
  float pixels;    ///< Edge of a column [pixels].
  float nearest;   ///< Distance at which the first slice begins [m].
  float farthest;  ///< Distance at which the last one ends [m], above `nearest`.
};

// Slices end at distances in proportion to this power of their number: those near the camera, where
// a column is narrow, are thinner, and those far away are not so thick as to blur shafts of light.
const float kSlicePower = 1.5f;

/// Weights of froxels below this mean no fog: quotients by them would not be finite.
const float kLeastFroxelWeight = 1e-20f;

/// Transmittance below which further fog makes no visible difference.
const float kOpaque = 1e-6f;

// Makes the random numbers of froxels independent of those of other passes.
const uint kFroxelSalt = 0x464F4747u;

/// The distance at which a slice begins [m].
LAMBENT_FN float slice_begin(FroxelGrid grid, uint slice) {
  float share = pow(float(slice) / float(grid.slices), kSlicePower);
  return grid.nearest + (grid.farthest - grid.nearest) * share;
}

/// The slice at a distance, as a real number: k to k + 1 within slice k, 0 to `slices` in all.
LAMBENT_FN float slice_coordinate(FroxelGrid grid, float distance) {
  float share = clamp((distance - grid.nearest) / (grid.farthest - grid.nearest), 0.0f, 1.0f);
  return float(grid.slices) * pow(share, 1.0f / kSlicePower);
}

/// The slice that a distance is in.
LAMBENT_FN uint slice_of(FroxelGrid grid, float distance) {
  return min(uint(slice_coordinate(grid, distance)), grid.slices - 1u);
}

/// Index of a froxel among those that are stored.
LAMBENT_FN uint froxel_index(FroxelGrid grid, uint column, uint row, uint slice) {
  return ((row - grid.first_row) * grid.columns + column) * grid.slices + slice;
}

/// Point of the picture for ray `index` of a column [pixels]: spread evenly over its pixels.
LAMBENT_FN vec2 column_point(FroxelGrid grid, uint column, uint row, uint index, uint frame,
                             uint seed) {
  RandomStream random = make_random_stream(row * grid.columns + column, frame ^ kFroxelSalt, seed);
  vec2 shift = next_uniform2(random);
  vec2 corner = vec2(float(column), float(row)) * grid.pixels;
  vec2 point = corner + fract(shift + plastic_sequence(index)) * grid.pixels;
  // The last columns reach beyond the picture, where there is nothing to see
  return min(point, 2.0f * grid.camera.half_size);
}

/// A uniform number for the depth of a sample, such that all samples of a column together are
/// spread evenly.
LAMBENT_FN float depth_number(FroxelGrid grid, uint column, uint row, uint slice, uint index,
                              uint samples, uint frame, uint seed) {
  RandomStream random =
      make_random_stream(row * grid.columns + column, (frame ^ kFroxelSalt) + 1u, seed);
  float turn = fract(float(slice * samples + index) * (kGoldenRatio - 1.0f));
  return min(fract(next_uniform(random) + turn), kLargestUniform);
}

const float kNaturalLogOf2 = 0.693147180559945f;

/// The optical depth within which this share of light is extinguished: -ln(1 - share), by its
/// series where that is small.
LAMBENT_FN float drawn_depth(float share) {
  if (share < kSmallExponent) return share * (1.0f + share * (0.5f + share * (1.0f / 3.0f)));
  return -kNaturalLogOf2 * log2(1.0f - share);
}

/// A lamp is near a segment where it is within this many times its length: the light of lamps
/// farther away varies little along it.
const float kNearLamp = 4.0f;
/// From this many of its widths away from a lamp, a column's rays count as all in its middle.
const float kWideColumn = 8.0f;
/// Least width of a column, as a share of the distance to a lamp, so that heights stay above 0.
const float kLeastColumnWidth = 1e-6f;

/// A term of corner_term(): x asinh(y / |x|), which is 0 at x = 0.
LAMBENT_FN float side_term(float x, float y) {
  if (x == 0.0f) return 0.0f;
  float ratio = abs(y / x);
  float log_of_both = kNaturalLogOf2 * log2(ratio + sqrt(ratio * ratio + 1.0f));
  return y < 0.0f ? -x * log_of_both : x * log_of_both;
}

/// The integral of 1 / sqrt(x^2 + y^2) over the rectangle from (0, 0) to a corner, up to its sign:
/// [x asinh(y / |x|) + y asinh(x / |y|)].
LAMBENT_FN float corner_term(float x, float y) {
  return side_term(x, y) + side_term(y, x);
}

/// The harmonic mean, over a column's rays, of the distance r at which they pass a lamp [m]: the
/// lamp's light along a ray is in proportion to 1 / r.
LAMBENT_FN float lamp_height(FroxelGrid grid, CameraRay middle, vec2 middle_pixel, vec3 lamp_ws) {
  vec3 to_lamp = lamp_ws - middle.origin_ws;
  vec3 across = to_lamp - dot(to_lamp, middle.direction_ws) * middle.direction_ws;
  float width = max(abs(pixel_width(grid.camera, lamp_ws)) * grid.pixels,
                    kLeastColumnWidth * max(length(to_lamp), 1.0f));
  float distance = max(length(across), kLeastColumnWidth * width);
  ImagePoint lamp = image_point(grid.camera, lamp_ws);
  if (distance > kWideColumn * width || !(lamp.depth > 0.0f)) return distance;
  // Position of the column's corners relative to the lamp, in widths of a column
  vec2 low = (middle_pixel - lamp.pixel) / grid.pixels - vec2(0.5f);
  vec2 high = low + vec2(1.0f);
  float sum = corner_term(high.x, high.y) - corner_term(low.x, high.y) -
              corner_term(high.x, low.y) + corner_term(low.x, low.y);
  return sum > 0.0f ? width / sum : distance;
}

/// Lower bound of the cosines of a lamp's angles, which only rounding could take below it.
const float kLeastLampCosine = 1e-6f;

/// A part of a ray.
struct FroxelSegment {
  float begin;  ///< [m]
  float end;    ///< [m]; not above `begin`: the segment is empty.
  float depth;  ///< Optical depth of the fog in it.
};

/// A point of a froxel at which light is sampled, and its weight.
struct FroxelPoint {
  float distance;  ///< Distance along the ray [m].
  float weight;    ///< Share of light that fog there extinguishes; 0: there is no fog.
};

LAMBENT_END
#endif
