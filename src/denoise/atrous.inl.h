// SPDX-License-Identifier: Apache-2.0
// One pass of the filter at one pixel (in C++, at several: the lanes of a vector), in the common
// subset of C++ and GLSL.
//
// Based on: Dammertz et al., "Edge-Avoiding A-Trous Wavelet Transform for fast Global Illumination
// Filtering", HPG 2010; Schied et al., "Spatiotemporal Variance-Guided Filtering", HPG 2017.
//
// The includer provides
//   Real, Real3              float and vec3, or lanes of them with the same operators
//   LAMBENT_REAL_FN          before a function
//   LAMBENT_UNROLL_TAPS      before the loop over neighbours
//   Real zero_unless_positive(Real condition, Real value)
//   Real larger(Real a, Real b), Real smaller(Real a, Real b)
//   Real fetch_guide(int plane, int x, int y)
//       a plane of the guide (atrous_pass.h) at the pixel that is offset from this one by (x, y)
//   Real fetch_light(int plane, int x, int y)   the same for the planes of light (atrous_pass.h)
//   Real fetch_lobe(int plane, int x, int y)    the same for LobeGuide; used where there are lobes
// In C++ it is included in the body of a struct that has these as members.

#include "denoise/edge_stopping.inl.h"
#include "denoise/lobe_weight.inl.h"

/// A pixel's light, or the weighted sums of its neighbours'.
struct AtrousLight {
  Real3 light;
  Real3 base;
  /// Variance of an unfiltered pixel's luminance, estimated from the pixels filtered so far. Where
  /// variances are unknown: the mean of squares, until the geometric passes end.
  Real spread;
  /// Variance of this pixel's luminance as a share of that of an unfiltered one.
  Real share;
};

LAMBENT_REAL_FN Real3 guide_vector(int plane, int x, int y) {
  return Real3(fetch_guide(plane, x, y), fetch_guide(plane + 1, x, y),
               fetch_guide(plane + 2, x, y));
}

LAMBENT_REAL_FN Real3 light_vector(int plane, int x, int y) {
  return Real3(fetch_light(plane, x, y), fetch_light(plane + 1, x, y),
               fetch_light(plane + 2, x, y));
}

LAMBENT_REAL_FN Real3 lobe_vector(int plane, int x, int y) {
  return Real3(fetch_lobe(plane, x, y), fetch_lobe(plane + 1, x, y), fetch_lobe(plane + 2, x, y));
}

LAMBENT_REAL_FN AtrousGuide guide_at(int x, int y) {
  AtrousGuide at;
  at.position_ws = guide_vector(kPositionPlane, x, y);
  at.normal_ws = guide_vector(kNormalPlane, x, y);
  return at;
}

LAMBENT_REAL_FN AtrousLight light_at(AtrousPass by, int x, int y) {
  AtrousLight at;
  at.light = light_vector(kLightPlane, x, y);
  at.spread = fetch_light(kSpreadPlane, x, y);
  at.share = fetch_light(kSharePlane, x, y);
  at.base = by.has_base != 0u ? light_vector(kBasePlane, x, y) : at.light;
  return at;
}

/// Luminance of the light that is filtered: of its difference from the base, if any.
LAMBENT_REAL_FN Real filtered_luminance(AtrousPass by, AtrousLight of) {
  Real3 rest = of.light;
  if (by.has_base != 0u) rest = rest - of.base;
  return rest.x * kRedLuminance + rest.y * kGreenLuminance + rest.z * kBlueLuminance;
}

LAMBENT_REAL_FN PixelLobe lobe_at(int x, int y) {
  PixelLobe lobe;
  lobe.mirror_ws = lobe_vector(kMirrorPlane, x, y);
  lobe.sharpness = fetch_lobe(kLobeSharpnessPlane, x, y);
  lobe.inverse_distance = fetch_lobe(kInverseHitDistancePlane, x, y);
  return lobe;
}

/// Exponent of a neighbour's weight by what its lobe shows: the smaller one of what is near and,
/// where the pass has far lobes, of what is far. `of_light`: difference_of_light() of the two.
LAMBENT_REAL_FN Real difference_of_reflections(AtrousPass by, PixelLobe here, PixelLobe there,
                                               Real3 to_neighbour, Real3 across_ws, Real of_light) {
  Real as_near = difference_of_lobes(by.lobe_scale, here, there, to_neighbour, across_ws);
  if (by.far_lobes == kNoFarLobes) return as_near;
  Real as_far = difference_of_far_lobes(by.far_lobe_scale, here, there);
  if (by.far_lobes == kFarLobesWithinNoise) as_far += of_light;
  return smaller(as_near, as_far);
}

/// The pixel's light from the weighted sums over its neighbours.
LAMBENT_REAL_FN AtrousLight divided_sums(AtrousPass by, AtrousLight own, AtrousLight sum,
                                         Real weights) {
  // Neglect noise that neighbours share after earlier passes (Schied et al. 2017, Eq. 7)
  Real scale = 1.0f / weights;
  if (by.only_spread != 0u) {
    own.spread = sum.spread * scale;
    return own;
  }
  sum.light = sum.light * scale;
  if (by.has_base != 0u) sum.base = sum.base * scale;
  sum.spread = sum.spread * scale;
  sum.share = sum.share * (scale * scale);
  if (by.ends_estimate != 0u) {
    // Compute the unbiased estimate of a variance from several pixels
    Real level = filtered_luminance(by, sum);
    Real square = level * level;
    sum.spread = larger(sum.spread - square, kLeastVariance * square) /
                 (1.0f - min(sum.share, kMostKnownShare));
  }
  return sum;
}

/// The pixel's light after the pass.
LAMBENT_REAL_FN AtrousLight filtered_pixel(AtrousPass by) {
  AtrousGuide here = guide_at(0, 0);
  Real plane_scale = fetch_guide(kInverseDepthPlane, 0, 0) * by.plane_scale;
  Real inverse_level = plane_scale * 0.0f + 1.0f;
  if (by.has_levels != 0u) {
    inverse_level = 1.0f / max(fetch_guide(kLevelPlane, 0, 0), kLeastFilteredLevel);
  }
  PixelLobe lobe;
  Real3 across_ws = here.normal_ws;
  if (by.has_lobes != 0u) {
    lobe = lobe_at(0, 0);
    across_ws = lobe_vector(kAcrossPlane, 0, 0);
  }
  AtrousLight own = light_at(by, 0, 0);
  Real own_luminance = filtered_luminance(by, own);

  // Sum over the 3 x 3 neighbours, with binomial weights over 4, so that the pixel itself has 1
  AtrousLight sum = own;
  Real weights = own.spread * 0.0f + 1.0f;
  LAMBENT_UNROLL_TAPS
  for (int k = 0; k < 9; ++k) {
    int x = k % 3 - 1;
    int y = k / 3 - 1;
    if (x == 0 && y == 0) continue;
    AtrousGuide there = guide_at(x * by.apart, y * by.apart);
    AtrousLight neighbour = light_at(by, x * by.apart, y * by.apart);
    Real cosine = dot(here.normal_ws, there.normal_ws);
    Real difference = difference_of_surfaces(by, here, plane_scale, there, cosine);
    Real of_light = own.spread * 0.0f;
    if (by.geometric == 0u || by.far_lobes == kFarLobesWithinNoise) {
      of_light = difference_of_light(by, own_luminance - filtered_luminance(by, neighbour),
                                     own.spread * own.share, neighbour.spread * neighbour.share);
    }
    if (by.has_lobes != 0u) {
      difference +=
          difference_of_reflections(by, lobe, lobe_at(x * by.apart, y * by.apart),
                                    there.position_ws - here.position_ws, across_ws, of_light);
    }
    if (by.checks_steps != 0u) {
      difference += step_before(there, guide_at(x * (by.apart - 1), y * (by.apart - 1)));
    }
    if (by.geometric == 0u) difference += of_light;
    Real weight = falloff(difference) * (x == 0 || y == 0 ? 0.5f : 0.25f);
    weight = zero_unless_positive(cosine, weight);
    if (by.has_levels != 0u) {
      // Light over a far lower level is far noisier relative to this pixel's level
      Real level = fetch_guide(kLevelPlane, x * by.apart, y * by.apart);
      weight *= min(level * inverse_level, 1.0f);
    }
    weights += weight;
    sum.light += neighbour.light * weight;
    if (by.has_base != 0u) sum.base += neighbour.base * weight;
    sum.spread += neighbour.spread * weight;
    sum.share += neighbour.share * (weight * weight);
  }

  return divided_sums(by, own, sum, weights);
}
