// SPDX-License-Identifier: Apache-2.0
// The history ratio of a probe: the ratio of its light, which averages many updates, to the light
// that its last rays alone estimate. Also, which changes by edits are visible. See
// apply_scene_edits.cpp.
#ifndef LAMBENT_FIELD_EDITS_HISTORY_RATIO_MATH_H
#define LAMBENT_FIELD_EDITS_HISTORY_RATIO_MATH_H

#include "field/edits/edited_light_math.h"
#include "field/probes/tile_light_math.h"

LAMBENT_BEGIN

// The estimate of one update's rays is raised by at most this factor. Where it is further below the
// average, the rays hit too little light for a correction to make sense.
const float kMaxHistoryRatio = 2.0f;
// It may be lowered much more: a single ray that meets a very bright spot brings hundreds of times
// the average, which holds the right share of it. If edits restored half of it, there would be a
// flash. The limit is beyond what single rays bring, and keeps the division by the ratio finite.
const float kMinHistoryRatio = 1e-5f;

// Where an edit makes direct light more than this many times as bright, most of it is taken to come
// of other sources than before, whose errors history ratios know nothing of: with a lamp that is
// switched on beside a small one, which few rays find, texels were up to kMaxHistoryRatio times too
// bright. A lamp alone that becomes much brighter loses its average, too; as totals cannot tell the
// two apart, the limit is above what flames flicker by.
const float kMaxDirectGrowth = 4.0f;
// Probes that receive hardly any direct light are lit by what others reflect, so that this share of
// the mean probe's counts as their own. In a dark room it counts less, in proportion to what they
// hold: with this share, light that an opened door let in was 5.1 times too bright there.
const float kReflectedShare = 0.1f;

// A probe whose light an edit changes by less than this fraction keeps its old light and its
// history. It is half of the smallest visible difference.
const float kChangedFraction = 0.005f;

/// The factor from the last estimate of a texel to the light that the probe holds, between
/// kMinHistoryRatio and kMaxHistoryRatio.
LAMBENT_FN vec4 history_ratio_between(vec4 last_irradiance_estimate, vec4 held) {
  vec4 history_ratio = vec4(1.0f);
  for (int c = 0; c < 3; ++c) {
    if (last_irradiance_estimate[c] > kTiniestLight) {
      history_ratio[c] =
          clamp(held[c] / last_irradiance_estimate[c], kMinHistoryRatio, kMaxHistoryRatio);
    }
  }
  return history_ratio;
}

/// How much brighter an edit makes direct light, from sums or means over probes. Their light,
/// scaled by it, is a good start for the solve.
LAMBENT_FN float direct_growth(float before, float after) {
  return before > 0.0f ? after / before : 1.0f;
}

/// Luminances that an edit finds at a probe, or at the mean one.
struct ProbeAtEdit {
  float held;           ///< Of the irradiance that it holds before the edit, a mean over texels.
  float direct_before;  ///< Of the direct light along its rays before the edit, a mean.
  float direct_after;   ///< Of that after the edit.
};

LAMBENT_FN ProbeAtEdit probe_at_edit(EditedLight sums, float held) {
  float rays = max(sums.rays, 1.0f);
  ProbeAtEdit probe = {held, sums.before / rays, sums.after / rays};
  return probe;
}

/// The share of a probe's history that holds after an edit, 0 to 1.
LAMBENT_FN float history_share(ProbeAtEdit own, ProbeAtEdit mean) {
  float reflected = own.held < kReflectedShare * mean.held ? own.held / mean.held : kReflectedShare;
  float was = own.direct_before + reflected * mean.direct_before;
  float is = own.direct_after + reflected * mean.direct_after;
  return is > kMaxDirectGrowth * was ? kMaxDirectGrowth * was / is : 1.0f;
}

LAMBENT_FN vec4 reduce_history_ratio(vec4 history_ratio, float share) {
  return vec4(1.0f) + share * (history_ratio - vec4(1.0f));
}

LAMBENT_END
#endif
