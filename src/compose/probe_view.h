// SPDX-License-Identifier: Apache-2.0
// Draws the probes of a field as spheres into the picture, to show what they store.
#pragma once

#include <cstdint>

#include "field/probes/probe_status.h"
#include "lambent/field.h"
#include "lambent/image.h"
#include "lambent/scene.h"
#include "lambent/world.h"

namespace lambent {

/// The quantity of a probe that its sphere shows.
enum class ProbeAspect : std::uint8_t {
  irradiance,  ///< Irradiance along the sphere's normal, reflected by a white surface.
  distance,    ///< Distance stored along the sphere's normal: sequential_color, the longest that a
               ///< probe stores brightest.
  state,       ///< probe_state_color.
  age,         ///< Updates since the probe was traced, logarithmic: dark for new, pale for the
               ///< oldest that the schedule allows.
};

struct ProbeViewSettings {
  ProbeAspect aspect = ProbeAspect::irradiance;
  /// Radius of a sphere, relative to the smallest distance between probes, above 0 to 0.5.
  float radius = 0.08f;
};

/// Linear colour of a state: grey off, blue sleeping, yellow newly awake, red awake, turquoise
/// newly vigilant, green vigilant.
glm::vec3 probe_state_color(ProbeState state);

/// Draws the field's probes into a rendered frame, occluding and occluded by the scene, and adds
/// the layer "probes": their colour and coverage, premultiplied. Irradiance is drawn at its true
/// brightness; the other aspects are scaled so that automatic exposure shows their colour.
void draw_probes(const World& world, const IrradianceField& field, const Camera& camera,
                 const ProbeViewSettings& settings, LayeredImage& frame);

}  // namespace lambent
