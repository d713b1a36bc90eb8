// SPDX-License-Identifier: Apache-2.0
// Picking lights for glossy surfaces, including their highlights.
#ifndef LAMBENT_SCENE_PICK_LOBE_H
#define LAMBENT_SCENE_PICK_LOBE_H

#include "scene/light_tree/light_tree_math.h"
#include "shared/brdf.h"
#include "shared/color.h"
#include "shared/sampling.h"

LAMBENT_BEGIN

/// For wider lobes [GGX alpha], lights are picked by the cosine alone, whose lobe is about as wide.
const float kWidestPickedLobe = 0.5f;

/// The lobe of a coat for picking lights: F * G1(v) * D / (4 * n_dot_v), where D is the lobe's
/// distribution; see PickLobe. `even` is the albedo of the base and of wide lobes.
LAMBENT_FN PickLobe pick_lobe_of_coat(Reflectance coat, float even, vec3 to_viewer_ws,
                                      float n_dot_v) {
  float masked = 1.0f / (1.0f + ggx_lambda(n_dot_v, coat.alpha));
  float reflected = luminance(fresnel(coat, n_dot_v));
  PickLobe lobe = {to_viewer_ws, coat.alpha * coat.alpha, max(even, reflected) * kInvPi,
                   reflected * masked * kInvPi / (4.0f * n_dot_v)};
  return lobe;
}

/// The lobe of a surface: that of its coat or its clearcoat, whichever reflects more. `to_viewer`
/// is in the frame of the shading normal, which is used for the clearcoat, too.
LAMBENT_FN PickLobe pick_lobe(Reflectance surface, Frame frame, vec3 to_viewer) {
  float n_dot_v = to_viewer.z;
  if (has_no_coat(surface) || n_dot_v <= 0.0f) return no_pick_lobe();
  Reflectance coat = surface;
  if (has_clearcoat(surface.layers)) {
    Reflectance clearcoat = clearcoat_alone(surface.layers);
    if (luminance(fresnel(clearcoat, n_dot_v)) > luminance(fresnel(surface, n_dot_v)) ||
        surface.alpha > kWidestPickedLobe) {
      coat = clearcoat;
    }
  }
  if (coat.alpha > kWidestPickedLobe) return no_pick_lobe();
  float even = luminance(effective_albedo(surface, n_dot_v));
  return pick_lobe_of_coat(coat, even, to_world(frame, to_viewer), n_dot_v);
}

LAMBENT_END
#endif
