// SPDX-License-Identifier: Apache-2.0
// How paths through glass choose between reflection and crossing, and between their branches.
#ifndef LAMBENT_GLOSSY_GLASS_CHOICE_H
#define LAMBENT_GLOSSY_GLASS_CHOICE_H

#include "glossy/coat_path.h"
#include "scene/coverage.h"
#include "shared/color.h"
#include "shared/owen.h"
#include "shared/reservoir.h"

LAMBENT_BEGIN

// Least chance with which a branch (kForkBranch) that came through glass alone is reflected by
// smooth glass that it hits on its first bounce, and with which it crosses it. Of four samples one
// then shows the reflection, faint as it is: with a chance in proportion, hardly any pixel of a
// pane would show it, and those all too bright. The chance halves with each bounce: if it stayed,
// one path in ten would cross the eight surfaces of a wine glass before a bottle, with seven times
// its light.
const float kLeastGlassChance = 0.25f;
// Least number of a pixel's samples for that: of fewer, each would show one of the two alone.
const uint kLeastStratifiedSamples = 4u;

/// By which number a path chooses at glass, and how rarely one of its ways may be taken.
struct GlassChoice {
  float number;        ///< [0, 1); those of a pixel's successive samples lie in equal parts.
  float least_chance;  ///< See kLeastGlassChance; 0: chances are in proportion to light.
};

/// A step of the paths of a pixel's sample: the bounce that they are on, below 256, and which of
/// how many samples of its round it is (the index modulo 2^23). In one word, as kernels have no
/// room for more.
LAMBENT_FN uint pack_path_step(uint bounce, uint sample_index, uint samples) {
  uint stratified = samples >= kLeastStratifiedSamples ? 1u : 0u;
  return bounce | (stratified << 8u) | (sample_index << 9u);
}
LAMBENT_FN uint bounce_of_step(uint path_step) {
  return path_step & 255u;
}
/// Whether the pixel has kLeastStratifiedSamples.
LAMBENT_FN bool is_stratified(uint path_step) {
  return (path_step & 256u) != 0u;
}

/// See kLeastGlassChance. `bounce` is that of the branch's hit, from kFirstBounceOfForks.
LAMBENT_FN float least_glass_chance(uint bounce) {
  return kLeastGlassChance * exp2(float(kFirstBounceOfForks) - float(bounce));
}

/// The choice of a pixel's path at a step, see pack_path_step().
LAMBENT_FN GlassChoice glass_choice(uint pixel, uint path_step, uint seed) {
  uvec3 order = hash_pcg3d(uvec3(pixel, bounce_of_step(path_step) + kGlassSalt, seed));
  // Shuffled first, lest the choices of two bounces go together at all samples of a pixel
  uint index = bitfieldReverse(scramble_reversed(bitfieldReverse(path_step >> 9u), order.x));
  float least = is_stratified(path_step) ? least_glass_chance(bounce_of_step(path_step)) : 0.0f;
  GlassChoice choice = {uniform_from_bits(bitfieldReverse(scramble_reversed(index, order.y))),
                        least};
  return choice;
}

/// The bounce whose numbers draw branches: none of a path, as these count from 1.
const uint kBounceOfBranches = 0u;

/// The number by which a pixel's sample draws one of its branches, see CoatPath::branches.
LAMBENT_FN float branch_number(uint pixel, uint sample_index, uint seed) {
  return glass_choice(pixel, pack_path_step(kBounceOfBranches, sample_index, 1u), seed).number;
}

/// Least weight with which a branch competes; less is not visible, and its share of a sum might be
/// no number.
const float kLeastBranchWeight = 1e-20f;

/// The weight with which a branch competes: how much of the light of its next hit it carries; 0:
/// not at all.
LAMBENT_FN float branch_weight(CoatPath branch) {
  float weight = luminance(branch.throughput);
  bool competes = branch.pdf > 0.0f && weight >= kLeastBranchWeight && weight < infinity();
  return competes ? weight : 0.0f;
}

/// Offers a branch of this weight, above 0, to the draw of its path: whether the pixel keeps it in
/// place of the one that it has. `factor`: of the throughput of the one that is kept then.
///
/// Each branch is kept with a probability in proportion to its weight, and stands for all.
LAMBENT_FN bool keeps_branch(float weight, LAMBENT_INOUT(Reservoir) branches,
                             LAMBENT_INOUT(float) factor) {
  bool is_kept = accepts(branches, weight);
  factor = branches.sum / (is_kept ? weight : branches.sum - weight);
  return is_kept;
}

/// A chance that is neither 0 nor 1, moved away from both.
LAMBENT_FN float moderate_chance(float chance, float least) {
  return chance > 0.0f && chance < 1.0f ? clamp(chance, least, 1.0f - least) : chance;
}

LAMBENT_END
#endif
