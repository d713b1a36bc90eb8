// SPDX-License-Identifier: Apache-2.0
// Unoccluded light of a light without extent at a pixel, as the pixel reflects it to the camera.
#include "raytracing/coat_share.h"
#include "rsm/shaders/direct_place.glsl"
#include "shared/demodulate.h"
#include "shared/phase.h"
#include "shared/sampling.h"

layout(push_constant, scalar) uniform Push {
  DirectRaysArguments args;
};

/// Required by direct_light.glsl for random draws of lights; here, lights are chosen by index.
struct AskingReceiver {
  LitPointRecord point;
};
#define ReceiverRef AskingReceiver

#include "raytracing/shaders/direct_light.glsl"

float target_of(AskingReceiver receiver, LightCandidate light) {
  return luminance(unoccluded_irradiance(receiver.point, seen_shape(receiver.point), light));
}
PickLobe lobe_of(AskingReceiver receiver) {
  return no_pick_lobe();
}

#define MediaRef DirectRaysArguments
uint media_count(DirectRaysArguments of) {
  return of.media_count;
}
MediumRecord fetch_medium(DirectRaysArguments of, uint medium) {
  return of.media.at[medium];
}

#include "scene/media/media.inl.h"

/// A pixel that receives direct light.
struct AskingPixel {
  LitPointRecord point;
  Reflectance reflectance;
  Frame frame;
  vec3 to_viewer;  ///< Unit, in the frame.
};

/// The pixel at a place of the band; false where that is outside, or shows nothing.
bool find_pixel(ivec2 at, out AskingPixel pixel) {
  if (at.x >= args.width || at.y >= args.rows) return false;
  int i = at.y * args.width + at.x;
  pixel.point = args.points.at[i];
  if (pixel.point.random_index == kNoDirectLight) return false;
  PixelSurfaceRecord surface = args.surfaces.at[i];
  pixel.reflectance = surface.reflectance;
  pixel.frame = make_frame(pixel.point.normal_ws);
  pixel.to_viewer = to_local(pixel.frame, surface.to_viewer_ws);
  return true;
}

/// Unoccluded light of a light; diffuse light is divided by filtered_albedo().
ReflectedPair sent_light(AskingPixel pixel, uint light, out LightCandidate candidate) {
  LightRecord record = args.scene.at[0].lights.at[light];
  candidate = punctual_candidate(record, pixel.point);
  ReflectedPair pair = sampled_reflection(pixel.reflectance, pixel.frame, pixel.to_viewer,
                                          pixel.point, candidate, CoatShares(0.0f, 0.0f), 0.0f);
  float passed =
      transmittance(args, pixel.point.position_ws, candidate.to_light, candidate.distance);
  pair.diffuse = pair.diffuse * passed / filtered_albedo(pixel.reflectance);
  pair.specular *= passed;
  return pair;
}
