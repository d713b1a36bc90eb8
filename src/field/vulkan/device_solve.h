// SPDX-License-Identifier: Apache-2.0
// The solve for the light of all bounces, wholly on a device: relight() of relight.cpp.
#ifndef LAMBENT_FIELD_VULKAN_DEVICE_SOLVE_H
#define LAMBENT_FIELD_VULKAN_DEVICE_SOLVE_H

#include "field/transport/anderson_math.h"
#include "field/transport/list_sizes.h"
#include "field/vulkan/device_records.h"

LAMBENT_BEGIN

// Invocations among which sums over all texels are shared out: a fixed number, so that the sums are
// the same on every run.
const int kSumLanes = 4096;

// Sums that an iteration needs: of squares of the image, the residual, and of the changes of
// solution and image; of the residual's change times each remembered one, and of each times the
// residual.
const int kImageSquare = 0;
const int kResidualSquare = 1;
const int kChangeSquare = 2;
const int kImageChangeSquare = 3;
const int kFirstGram = 4;
const int kFirstProjection = 7;
const int kSolveSums = 10;

/// Where a solve stands. The host sets what is above the line, the device the rest.
struct SolveState {
  int max_iterations;
  float tolerance;
  float largest_blend_weight;
  float max_albedo;
  int texels;  ///< Of all its probes together.
  // Groups of the kernels of an iteration: 0 once it is done, so that those recorded to come do
  // nothing.
  GroupCounts over_texels;
  GroupCounts over_rays;
  GroupCounts over_blocks;
  GroupCounts over_sums;
  GroupCounts over_step;
  // ---
  int iterations;
  float error;
  float change;
  float observed;     ///< The strongest contraction that a step has shown.
  int steps;          ///< Remembered.
  vec3 coefficients;  ///< Of the remembered steps' image changes, to be taken back.
  StepProducts products;
};
LAMBENT_DEVICE_ARRAY(SolveStateArray, SolveState, 4)
LAMBENT_DEVICE_ARRAY(WideArray, Wide, 4)

/// Texels that a solve works on; all but `field` are of its probes x texels. Changes hold
/// kAndersonDepth steps, one after the other.
struct SolveArrays {
  IntArray probes;
  FloatArray blend_weights;
  Vec4Array field;  ///< Of all probes x texels.
  Vec4Array history;
  Vec4Array solution;
  Vec4Array image;
  Vec4Array residual;  ///< The last one.
  Vec4Array previous_image;
  Vec4Array residual_changes;
  Vec4Array image_changes;
  SolveStateArray state;
};

// What is done with a solution.
const uint kBeginSolve = 0u;     ///< The history becomes the solution and is put into the field.
const uint kNextSolution = 1u;   ///< Extrapolated, and a share of it is put into the field.
const uint kPlainSolution = 2u;  ///< The image is put into the field as it is.
const uint kEndSolve = 3u;       ///< A share of the image is put into the field, and none below 0.

struct BlendSolutionArguments {
  SolveArrays arrays;
  int probes;
  uint step;
};

struct SolveSumsArguments {
  SolveArrays arrays;
  WideArray sums;   ///< kSumLanes x kSolveSums.
  int most_texels;  ///< From one step's changes to the next's.
  uint last;        ///< 1: of the difference that the solve made, and of the image.
};

struct SolveStepArguments {
  SolveStateArray state;
  WideArray sums;
  uint last;
};

LAMBENT_END
#endif
