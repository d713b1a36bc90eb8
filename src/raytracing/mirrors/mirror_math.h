// SPDX-License-Identifier: Apache-2.0
// Rays go on at mirrors: at coats so smooth that the field's light cannot stand for what they
// show, on surfaces that reflect little else. What such a ray finds next is merged into its hit.
// Without it, metal would reflect the field's light to all sides, and light would stay inside of
// lamp shades and leave mirrors towards places that they do not face.
//
// A mirror's own direct light stays with the hit, reflected by a lobe of at least kMinAlphaOfHits:
// rays that go on do not collect emission, so that no light counts twice.
#ifndef LAMBENT_RAYTRACING_MIRRORS_MIRROR_MATH_H
#define LAMBENT_RAYTRACING_MIRRORS_MIRROR_MATH_H

#include "raytracing/shaded_hit.h"
#include "shared/color.h"
#include "shared/random.h"
#include "shared/sampling.h"

LAMBENT_BEGIN

// The coat of a mirror reflects at least the first share of what base and coat reflect together,
// and at least the second share of all light: the reflections of darker coats matter too little to
// be worth a ray.
const float kMinCoatOfMirror = 0.75f, kMinMirrorReflectance = 0.1f;

// The most mirrors that a ray follows one after the other. The last one reflects the field's light.
const uint kMaxMirrors = 3u;

// Multiples of this salt give the directions of rays from mirrors, and the light on what these
// show, random numbers of their own.
const uint kMirrorSalt = 0x9E3779B9u;

// Channels in which a mirror shows black keep this albedo, so that the mirror's own direct light
// can be stored as light on what it shows.
const float kMinShownAlbedo = 1e-4f;

/// Whether a surface of this shape (encode_albedo_shape()) is a mirror.
LAMBENT_FN bool is_mirror(uint shape) {
  // Lambert surfaces, and those with layers
  if ((shape >> 24u) == 0u) return false;
  Reflectance gray = gray_of_shape(shape);
  float coat = gray.f0.x;
  return gray.alpha < kMinAlphaOfHits && coat >= kMinMirrorReflectance &&
         coat >= kMinCoatOfMirror * (coat + gray.diffuse.x);
}

/// Whether a ray goes on at its hit, whose shape this is and which is seen along `to_viewer_ws`.
LAMBENT_FN bool goes_on(ShadedHitRecord hit, uint shape, vec3 normal_ws, vec3 to_viewer_ws) {
  return (hit.flags & (kSurfaceMissed | kSurfaceDiscounted)) == 0u && hit.gi_share > 0.0f &&
         hit.albedo_over_pi != vec3(0.0f) && is_mirror(shape) &&
         dot(normal_ws, to_viewer_ws) > 0.0f;
}

/// The salt of the direction in which a ray goes on that has met so many mirrors before.
LAMBENT_FN uint salt_of_mirror(uint salt, uint mirrors) {
  return salt ^ ((2u * mirrors + 1u) * kMirrorSalt);
}

/// The salt of the light on what a ray finds behind so many mirrors; `salt` itself for 0.
LAMBENT_FN uint salt_behind(uint salt, uint mirrors) {
  return salt ^ (2u * mirrors * kMirrorSalt);
}

/// Direction of a ray that a mirror of this shape reflects. Vectors are unit; `u` is uniform.
LAMBENT_FN vec3 sample_mirror(uint shape, vec3 normal_ws, vec3 geometric_normal_ws,
                              vec3 to_viewer_ws, vec2 u) {
  Frame frame = make_frame(normal_ws);
  vec3 v = to_local(frame, to_viewer_ws);
  vec3 h = sample_ggx_visible_normal(v, gray_of_shape(shape).alpha, u);
  vec3 direction_ws = to_world(frame, reflect(-v, h));
  // The albedo counts all light as reflected: directions into the surface are turned out of it
  float into = min(dot(direction_ws, geometric_normal_ws), 0.0f);
  return direction_ws - 2.0f * into * geometric_normal_ws;
}

/// A hit and the direct irradiance there [W/m^2].
struct LitHit {
  ShadedHitRecord hit;
  vec3 irradiance;
};

/// Merges what a mirror shows into the mirror's hit: the result reflects the direct light of both,
/// and the field's light at the place that the mirror shows. `distance` is that of the mirror from
/// the origin of the ray that hit it [m].
LAMBENT_FN LitHit shown_by_mirror(LitHit mirror, LitHit shown, float distance) {
  LitHit both = mirror;
  if (both.hit.mirror_distance <= 0.0f) both.hit.mirror_distance = distance;
  both.hit.gi_share = 0.0f;
  vec3 reflectance = kPi * mirror.hit.gi_share * mirror.hit.albedo_over_pi;
  if ((shown.hit.flags & kSurfaceMissed) != 0u) {
    both.irradiance += kPi * mirror.hit.gi_share * shown.hit.radiance;
  } else if ((shown.hit.flags & kSurfaceDiscounted) == 0u) {
    vec3 seen = reflectance * shown.hit.albedo_over_pi;
    both.hit.albedo_over_pi = max(seen, vec3(kMinShownAlbedo * kInvPi));
    both.irradiance = (mirror.hit.albedo_over_pi * mirror.irradiance + seen * shown.irradiance) /
                      both.hit.albedo_over_pi;
    both.hit.gi_share = shown.hit.gi_share;
    both.hit.material = shown.hit.material;
  }
  return both;
}

LAMBENT_END
#endif
