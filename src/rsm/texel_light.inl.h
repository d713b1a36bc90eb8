// SPDX-License-Identifier: Apache-2.0
// The light of a texel at a point (in C++ also at several points, in the lanes of a vector), in the
// common subset of C++ and GLSL. texel_light.h derives it. Without an include guard. The includer
// provides
//   Real             float, or lanes of them with the same operators: a number of the point
//   TexelReal        float or Real: a number of the texel
//   PointNumbers     a struct with the members x, y, z (position [m]) and nx, ny, nz (unit normal)
//   LAMBENT_REAL_FN  before a function
//   Real min(Real, Real)

/// What a gather reads of a texel: position [m], unit normal, softening [m^2].
struct TexelNumbers {
  TexelReal x, y, z, nx, ny, nz, softening;
};

/// A texel as seen from a point.
struct TexelSight {
  Real x, y, z;      ///< The vector to the texel [m].
  Real above_texel;  ///< Height of the point over the texel's plane [m].
  Real numerator;    ///< Pi times the numerator of bounded_geometry_term() [m^2].
  Real inverse;      ///< One over its denominator, the fourth power of the softened distance
                     ///< [1/m^4]; 0 where one is behind the other's plane.
};

/// k of texel_light.h, given the cosine between the two normals.
LAMBENT_REAL_FN Real softening_compensation(Real cosine) {
  Real c = -cosine;
  return kSofteningCorner + c * (kSofteningLinear + c * (kSofteningSquare + c * kSofteningCube));
}

LAMBENT_REAL_FN TexelSight see_texel(PointNumbers point, TexelNumbers texel) {
  TexelSight sight;
  sight.x = texel.x - point.x;
  sight.y = texel.y - point.y;
  sight.z = texel.z - point.z;
  sight.above_texel = -(texel.nx * sight.x + texel.ny * sight.y + texel.nz * sight.z);
  Real above_point = point.nx * sight.x + point.ny * sight.y + point.nz * sight.z;
  Real cosine = point.nx * texel.nx + point.ny * texel.ny + point.nz * texel.nz;
  sight.numerator =
      sight.above_texel * above_point + texel.softening * softening_compensation(cosine);

  Real square = sight.x * sight.x + sight.y * sight.y + sight.z * sight.z + texel.softening;
  Real lower = min(sight.above_texel, above_point);
  sight.inverse = lower > 0.0f ? 1.0f / (square * square) : 0.0f;
  return sight;
}
