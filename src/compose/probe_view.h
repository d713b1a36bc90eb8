// SPDX-License-Identifier: Apache-2.0
// The probes of a field as spheres in the picture, for people who wonder what they see.
#pragma once

#include <cstdint>

#include "field/probes/probe_status.h"
#include "lambent/field.h"
#include "lambent/image.h"
#include "lambent/scene.h"
#include "lambent/world.h"

namespace lambent {

/// What the spheres show of their probes.
enum class ProbeAspect : std::uint8_t {
  irradiance,  ///< Of a surface that faces as the sphere does there, reflected by white.
  distance,    ///< That the probe sees along the sphere's normal: sequential_color, the longest
               ///< that a probe holds brightest.
  state,       ///< probe_state_color.
  age,         ///< Updates since it was traced, logarithmic: dark for new, pale for the oldest
               ///< that the schedule lets one become.
};

struct ProbeViewSettings {
  ProbeAspect aspect = ProbeAspect::irradiance;
  /// Of a sphere, in shares of the smallest distance between probes, above 0 to 0.5.
  float radius = 0.08f;
};

/// Linear colour of a state: grey off, blue sleeping, yellow newly awake, red awake, turquoise
/// newly vigilant, green vigilant.
glm::vec3 probe_state_color(ProbeState state);

/// Draws the field's probes into a rendered frame, behind and in front of the scene as they
/// stand, and adds the layer "probes": colour and coverage, premultiplied, of what was drawn.
/// Irradiance is drawn as bright as it is, all else so that automatic exposure shows its colour.
void draw_probes(const World& world, const IrradianceField& field, const Camera& camera,
                 const ProbeViewSettings& settings, LayeredImage& frame);

}  // namespace lambent
