// SPDX-License-Identifier: Apache-2.0
// The choice of levels, so that decoded light is within the target error of a field's. Decoders do
// not depend on it.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "lambent/stream.h"
#include "stream/light/light_state.h"
#include "stream/light/tile_basis.h"

namespace lambent::stream {

/// A field's light.
struct FieldLight {
  std::span<const glm::vec4> tiles;  ///< One tile per probe.
  double mean = 0.0;                 ///< Over lit probes, their texels and channels [W/m^2].
};

/// Fails where light is not finite, or not within 0 to 1e14 W/m^2.
Expected<void> check_light(std::span<const glm::vec4> tiles);

/// The light of a field, which check_light accepts.
FieldLight measure_light(const LightLayout& layout, std::span<const glm::vec4> tiles);

/// The coefficients of a field's light, in units.
std::vector<float> coefficients_of(const LightLayout& layout, const TileBasis& basis,
                                   const FieldLight& light, float unit);

/// The errors of a state's light, relative to a field's.
LightErrors errors_of(const LightLayout& layout, const TileBasis& basis, const FieldLight& light,
                      float unit, std::span<const std::int32_t> coefficients);

/// The unit with which light of this mean, rounded to whole units, is well within the target.
float choose_unit(const FieldLight& light, float target_error);

/// The state with rounded coefficients.
LightState rounded_state(const LightLayout& layout, std::span<const float> coefficients,
                         float unit);

/// The levels that bring a state close to coefficients. Among errors below about a unit, those are
/// ignored whose correction would cost more bits than it is worth: with a thrift of 0 none, with 1
/// as many as is best where errors are half a unit, with 2 twice as many.
std::vector<std::int32_t> choose_levels(const LightLayout& layout, const LightState& state,
                                        std::span<const float> coefficients, float thrift);

}  // namespace lambent::stream
