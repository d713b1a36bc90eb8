// SPDX-License-Identifier: Apache-2.0
// How far the light that one pixel's lobe reflects may stand for another's, in the common subset of
// C++ and GLSL.
//
// The includer provides, besides atrous_pass.h,
//   Real, Real3              float and vec3, or lanes of them with the same operators
//   LAMBENT_REAL_FN          before a function
//   Real larger(Real a, Real b), Real max(Real, float), Real dot(Real3, Real3)
// In C++ it is included in the body of a struct that has these as members.

/// exp(-x) for x >= 0, within a few hundredths; exactly 0 from 4 on.
LAMBENT_REAL_FN Real falloff(Real x) {
  Real root = max(1.0f - 0.25f * x, 0.0f);
  Real square = root * root;
  return square * square;
}

/// The lobe that reflects a pixel's light; for the members see LobeGuide.
struct PixelLobe {
  Real3 mirror_ws;
  Real sharpness;
  Real inverse_distance;
};

/// Exponent of a neighbour's weight by the width of its lobe: lobes of different widths show
/// different parts of the scene.
LAMBENT_REAL_FN Real difference_of_widths(PixelLobe here, PixelLobe there) {
  Real widths =
      (here.sharpness - there.sharpness) / (here.sharpness + there.sharpness + kLeastLobeSharpness);
  return kWidthSharpness * (widths * widths);
}

/// Exponent of a neighbour's weight by what its lobe shows. A point that one pixel's lobe shows
/// lies, as seen from the other pixel, in another direction than the one in which that pixel's lobe
/// points. The smaller of the two distances and the sharper of the two lobes count, so that the
/// weight is the same in both directions.
LAMBENT_REAL_FN Real difference_of_lobes(float lobe_scale, PixelLobe here, PixelLobe there,
                                         Real3 to_neighbour, Real3 across_ws) {
  Real3 apart = to_neighbour * larger(here.inverse_distance, there.inverse_distance) +
                (there.mirror_ws - here.mirror_ws);
  Real sideways = dot(apart, across_ws);
  Real sharpness = larger(here.sharpness, there.sharpness) * lobe_scale;
  return (dot(apart, apart) + sideways * sideways) * sharpness + difference_of_widths(here, there);
}

/// Exponent of a neighbour's weight by what its lobe shows if that is infinitely far away.
LAMBENT_REAL_FN Real difference_of_far_lobes(float lobe_scale, PixelLobe here, PixelLobe there) {
  Real3 apart = there.mirror_ws - here.mirror_ws;
  Real sharpness = larger(here.sharpness, there.sharpness) * lobe_scale;
  return dot(apart, apart) * sharpness + difference_of_widths(here, there);
}
