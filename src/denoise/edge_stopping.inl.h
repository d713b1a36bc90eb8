// SPDX-License-Identifier: Apache-2.0
// The edge-stopping functions of the filter, in the common subset of C++ and GLSL: how far a
// neighbour differs from a pixel by its surface and by its light. What its lobe shows is in
// lobe_weight.inl.h, which has falloff(), the weight that follows from the sum of the differences.
//
// The includer provides, besides atrous_pass.h,
//   Real, Real3              float and vec3, or lanes of them with the same operators
//   LAMBENT_REAL_FN          before a function
//   Real dot(Real3, Real3)
//   Real zero_unless_positive(Real condition, Real value)
// In C++ it is included in the body of a struct that has these as members.

/// A pixel's position and normal.
struct AtrousGuide {
  Real3 position_ws;
  Real3 normal_ws;
};

/// Exponent of a neighbour's weight by its surface alone, without regard to its light.
LAMBENT_REAL_FN Real difference_of_surfaces(AtrousPass by, AtrousGuide here, Real plane_scale,
                                            AtrousGuide there, Real cosine) {
  Real off_plane = dot(here.normal_ws, there.position_ws - here.position_ws) * plane_scale;
  return by.normal_sharpness * (1.0f - cosine) + off_plane * off_plane;
}

/// Exponent of a neighbour's weight by the step (a discontinuity of depth), if any, between it and
/// the pixel `before` it, which is next to it on the way to the filtered pixel, or is that pixel. A
/// strip that stands out less than the plane's tolerance has some weight for pixels beyond it, but
/// not enough to share its light with all of those between: each pass would show it once more, as
/// lines 4, 8 and 16 pixels away.
LAMBENT_REAL_FN Real step_before(AtrousGuide neighbour, AtrousGuide before) {
  Real3 way = before.position_ws - neighbour.position_ws;
  Real height = dot(neighbour.normal_ws, way);
  // Pixels without a surface have no normal, and their position means nothing
  return zero_unless_positive(
      dot(before.normal_ws, before.normal_ws),
      kStepSharpness * height * height / (dot(way, way) + kLeastSquaredDistance));
}

/// The variance that the difference of two pixels' luminance is compared with. The variance of the
/// difference is the sum. Twice the harmonic mean is less where one pixel's light is known better,
/// and keeps noisy light out of pixels known to be dark.
LAMBENT_REAL_FN Real variance_between(AtrousPass by, Real a, Real b) {
  if (by.harmonic == 0u) return a + b;
  return 4.0f * a * b / (a + b + kLeastContrast);
}

/// Exponent of a neighbour's weight by its light: the squared contrast, which is the difference of
/// the two luminances, over its variance. `own` and `other`: the variances of the two.
LAMBENT_REAL_FN Real difference_of_light(AtrousPass by, Real contrast, Real own, Real other) {
  return contrast * contrast * by.contrast_scale /
         (variance_between(by, own, other) + kLeastContrast);
}
