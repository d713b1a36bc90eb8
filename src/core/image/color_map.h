// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

namespace lambent {

/// sRGB-encoded colour for a value of [0, 1] (clamped): near-black violet over red to pale yellow.
/// Lightness rises evenly, so that the order of values is visible also in print and to colour-blind
/// people.
glm::vec3 sequential_color(float value);

/// sRGB-encoded colour for a value of [-1, 1] (clamped): blue below, near-white at zero, red above.
/// Lightness falls evenly with the magnitude.
glm::vec3 diverging_color(float value);

}  // namespace lambent
