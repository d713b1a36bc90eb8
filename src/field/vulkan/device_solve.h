// SPDX-License-Identifier: Apache-2.0
// The data of a solve for the light of all bounces that runs entirely on a device: the twin of
// solve_bounces() in solve_bounces.cpp.
#ifndef LAMBENT_FIELD_VULKAN_DEVICE_SOLVE_H
#define LAMBENT_FIELD_VULKAN_DEVICE_SOLVE_H

#include "field/transport/anderson_math.h"
#include "field/transport/list_sizes.h"
#include "field/vulkan/device_records.h"

LAMBENT_BEGIN

// The number of invocations among which sums over all texels are divided. It is fixed, so that the
// sums are the same on every run.
const int kSumLanes = 4096;

// The sums that an iteration needs: the squares of the image, of the residual, and of the changes
// of solution and image; the products of the residual's change with each stored change (Gram
// matrix), and of each stored change with the residual (projection).
const int kImageSquare = 0;
const int kResidualSquare = 1;
const int kChangeSquare = 2;
const int kImageChangeSquare = 3;
const int kFirstGram = 4;
const int kFirstProjection = 7;
const int kSolveSums = 10;

/// The state of a solve. The host sets the members above the line of dashes, and the device those
/// below it.
struct SolveState {
  int max_iterations;
  float tolerance;
  float largest_blend_weight;
  float max_albedo;
  int texels;  ///< Irradiance texels of all probes of the solve.
  // Workgroups of an iteration's kernels. They become 0 once the solve is done, so that the
  // iterations that are still recorded do nothing.
  GroupCounts over_texels;
  GroupCounts over_rays;
  GroupCounts over_blocks;
  GroupCounts over_sums;
  GroupCounts over_step;
  // ---
  int iterations;
  float error;
  float change;
  float observed;     ///< The largest contraction factor that a step has shown.
  int steps;          ///< Number of stored steps.
  vec3 coefficients;  ///< step_coefficients() of the stored steps.
  StepProducts products;
};
LAMBENT_DEVICE_ARRAY(SolveStateArray, SolveState, 4)
LAMBENT_DEVICE_ARRAY(WideArray, Wide, 4)

/// The arrays that a solve works on. All but `field` have the texels of the list. The arrays of
/// changes hold kAndersonDepth steps, one after the other.
struct SolveArrays {
  IntArray probes;
  FloatArray blend_weights;
  Vec4Array field;  ///< The texels of all probes.
  Vec4Array history;
  Vec4Array solution;
  Vec4Array image;
  Vec4Array residual;  ///< The residual of the last step.
  Vec4Array previous_image;
  Vec4Array residual_changes;
  Vec4Array image_changes;
  SolveStateArray state;
};

// The steps of blend_solution.
const uint kBeginSolve = 0u;     ///< Copies the field into the history and the solution.
const uint kNextSolution = 1u;   ///< Extrapolates the solution and blends it into the field.
const uint kPlainSolution = 2u;  ///< Replaces the field by the image.
const uint kEndSolve = 3u;       ///< Blends the image into the field, without negative light.

/// Arguments of blend_solution.
struct BlendSolutionArguments {
  SolveArrays arrays;
  int probes;
  uint step;
};

/// Arguments of solve_sums.
struct SolveSumsArguments {
  SolveArrays arrays;
  WideArray sums;   ///< kSumLanes x kSolveSums.
  int most_texels;  ///< Stride between the changes of two steps.
  uint last;        ///< 1: only sums squares of the image and of the light's change by the solve.
};

/// Arguments of solve_step.
struct SolveStepArguments {
  SolveStateArray state;
  WideArray sums;
  uint last;
};

LAMBENT_END
#endif
