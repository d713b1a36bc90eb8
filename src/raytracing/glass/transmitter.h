// SPDX-License-Identifier: Apache-2.0
// Light of sources that reaches the viewer through rough surfaces. Rays through such surfaces find
// emitters and the sky, too: multiple importance sampling gives the samples what
// found_light_weight() leaves, with the density of a ray's direction, see draw_through().
#ifndef LAMBENT_RAYTRACING_TRANSMITTER_H
#define LAMBENT_RAYTRACING_TRANSMITTER_H

#include "raytracing/emitter_sampling.h"
#include "raytracing/transmission_math.h"
#include "scene/light_tree/pick_lobe.h"

LAMBENT_BEGIN

/// A surface that samples_lights_behind(), as a viewer sees it.
struct Transmitter {
  Transmission through;
  Reflectance reflectance;
  Frame frame;               ///< Frame of the shading normal on the viewer's side.
  vec3 to_viewer;            ///< Unit, in the frame.
  vec3 geometric_normal_ws;  ///< On the viewer's side; unit.
};

/// How it transmits the light of a direction.
LAMBENT_FN ThroughLobe through_lobe(Transmitter at, vec3 to_light_ws) {
  ThroughLobe none = {vec3(0.0f), 0.0f};
  if (dot(at.geometric_normal_ws, to_light_ws) >= 0.0f) return none;
  return evaluate_through(at.through, at.reflectance, at.to_viewer,
                          to_local(at.frame, to_light_ws));
}

/// Radiance that it transmits of an unoccluded candidate [W/(m^2 sr)]. The share of emitters' light
/// that rays supply is left out; `density_scale`: see emitter_density_scale().
LAMBENT_FN vec3 sampled_transmission(Transmitter at, LightCandidate light, float density_scale) {
  ThroughLobe lobe = through_lobe(at, light.to_light);
  vec3 transmitted = lobe.value * light.perpendicular_irradiance;
  if (light.emission_luminance > 0.0f) {
    transmitted *= 1.0f - found_light_weight(lobe.pdf, light.emission_luminance * density_scale);
  }
  return transmitted;
}

/// Its lobe for picking lights: that of a coat which faces away from the viewer, about the
/// direction in which a smooth surface would let the viewer's ray pass.
LAMBENT_FN PickLobe pick_lobe(Transmitter at) {
  if (at.through.alpha > kWidestPickedLobe) return no_pick_lobe();
  vec3 onwards = -at.to_viewer;
  vec3 passes = vec3(0.0f);
  if (at.through.kind == kCrossesPane) {
    passes = straight_share(at.through.tint, at.reflectance, at.to_viewer.z);
  } else {
    onwards = refract(onwards, vec3(0.0f, 0.0f, 1.0f), at.through.eta);
    passes = at.through.tint * (1.0f - inner_reflection(at.to_viewer.z, at.through.eta));
  }
  if (onwards.z >= 0.0f) return no_pick_lobe();  // total internal reflection
  Reflectance coat = {vec3(0.0f), at.through.alpha, passes, luminance(passes), no_layers(), 1.0f};
  vec3 mirrored = vec3(-onwards.x, -onwards.y, onwards.z);
  return pick_lobe_of_coat(coat, 0.0f, to_world(at.frame, mirrored), -onwards.z);
}

LAMBENT_END
#endif
