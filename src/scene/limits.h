// SPDX-License-Identifier: Apache-2.0
// The ranges of numbers from files, options and scenes made by hand. Within them every formula of
// the library stays finite in 32-bit arithmetic. Numbers outside are refused, or clamped with a
// warning, before anything is computed from them.
#pragma once

#include <glm/glm.hpp>

#include "scene/punctual_light.h"

namespace lambent {

/// Largest coordinate of geometry, lights and probes, and of cameras that files and people place,
/// in object and in world space [m]. The longest edge between two such corners is 3.5e9 m; its
/// fourth power, which is the squared length of a triangle's normal before that is normalized, is
/// still a float.
inline constexpr float kMaxCoordinate = 1e9f;

/// Largest coordinate of a camera that the program chooses [m]: from there the narrowest field of
/// view that can be requested, one degree, contains geometry of kMaxCoordinate. Its square is a
/// float.
inline constexpr float kMaxViewpoint = 1e12f;

/// Range of the largest factor by which a transform stretches: the determinant, its cube, and the
/// inverse are still normal floats, also where the transform flattens.
inline constexpr float kMinScale = 1e-10f;
inline constexpr float kMaxScale = 1e10f;

/// Largest radiance of skies and emissive surfaces [W/(m^2 sr)]: above that of the sun, 2e7, even
/// where the file is in candela, 1.6e9. The square of a sum of such samples is still a float.
inline constexpr float kMaxRadiance = 1e10f;

/// Largest irradiance of a directional light [W/m^2]: that of kMaxRadiance from some steradians.
inline const float kMaxIrradiance = kMaxPunctualIrradiance;

/// Largest radiant intensity of point and spot lights [W/sr]: the irradiance of the sun, 1e3 W/m^2,
/// from 30 km away. Irradiance nearby is clamped to kMaxIrradiance.
inline constexpr float kMaxIntensity = 1e12f;

/// Largest texture coordinate, and number in a transform of such [textures]. The square of a
/// tangent, an edge times a difference of coordinates, is still a float.
inline constexpr float kMaxTextureCoordinate = 1e8f;

/// Largest factor without unit: scale of a normal map, tint of reflection, vertex colour.
inline constexpr float kMaxFactor = 1e6f;

/// Range of vertical fields of view [rad]: the tangent of half of it is neither 0 nor infinite, and
/// the rays of a picture's rows differ.
inline constexpr float kMinFov = 1e-3f;
inline constexpr float kMaxFov = 3.1405926f;  // pi - 1e-3

/// Range of an orthographic view's height [m].
inline constexpr float kMinViewExtent = 1e-6f;
inline constexpr float kMaxViewExtent = 2.0f * kMaxCoordinate;

/// Largest ratio of a view's sides, and of its inverse: pictures are 1 to 16384 pixels wide.
inline constexpr float kMaxAspect = 16384.0f;

/// Ranges of fog. The densest, 1e6 / m, is opaque within a hair's breadth. Scattering with an
/// anisotropy above 0.95 is concentrated in a cone of three degrees, narrower than any froxel.
/// Below the least scale height [m] fog is a sheet; above the largest one it is constant within
/// kMaxCoordinate.
inline constexpr float kMaxFogDensity = 1e6f;
inline constexpr float kMaxFogAnisotropy = 0.95f;
inline constexpr float kMinFogScaleHeight = 1e-3f;
inline constexpr float kMaxFogScaleHeight = 1e9f;

/// Whether a place is one where things can be; false where a coordinate is not a number.
inline bool is_in_reach(const glm::vec3& position, float largest = kMaxCoordinate) {
  // Written so that NaN fails
  const auto fits = [largest](float x) { return x >= -largest && x <= largest; };
  return fits(position.x) && fits(position.y) && fits(position.z);
}

/// A color whose largest channel is not above `largest`, of the same hue. Channels are 0 or more;
/// in double, so that a product of any two floats can be limited.
inline glm::vec3 limited(const glm::dvec3& color, float largest) {
  const double brightest = glm::max(color.x, glm::max(color.y, color.z));
  const double factor = brightest > largest ? largest / brightest : 1.0;
  return glm::min(glm::vec3(color * factor), glm::vec3(largest));
}

}  // namespace lambent
