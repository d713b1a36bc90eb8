// SPDX-License-Identifier: Apache-2.0
// Rays that coats send out, or that go through surfaces, and their ways through the scene.
#ifndef LAMBENT_GLOSSY_COAT_PATH_H
#define LAMBENT_GLOSSY_COAT_PATH_H

#include "raytracing/ray_records.h"

LAMBENT_BEGIN

/// The ray that a pixel's coat sends out, or the pixel through its surface, and what it brings.
struct CoatRay {
  vec3 direction_ws;  ///< Unit.
  float distance;     ///< As of distance_met [m]; infinite: it left the scene; below 0: see pdf.
  vec3 radiance;      ///< But for `apart` [W/(m^2 sr)].
  float pdf;          ///< Density with which it was drawn [1/sr]; 0: there is no ray; less: it went
                      ///< into the surface and brings nothing. Of rays through surfaces 0, and
                      ///< their distance is below 0 where there is none.
  vec3 apart;         ///< Light that is kept apart, see CoatPath::stage [W/(m^2 sr)].
};
LAMBENT_DEVICE_ARRAY(CoatRayArray, CoatRay, 4)

// CoatPath::stage: where a way has come to, and which light that it meets CoatRay::apart keeps
// apart.
/// It left the pixel's surface, or a coat that it met. Nothing is kept apart.
const uint kStageOther = 0u;
/// It left the pixel's coat, and no other one has reflected it. What emissive surfaces send is kept
/// apart, for the pixel's direct light samples that, too.
const uint kStageOwnCoat = 1u;
/// It came through glass to the first surface that lets no light through. Nothing is kept apart.
const uint kStageBehindGlass = 2u;
/// It left the coat of that surface, and met nothing but glass since. All light is kept apart.
const uint kStageCoatBehindGlass = 3u;
/// It left the coat of that surface, and met something else than glass. All light is kept apart.
const uint kStageBeyondCoat = 4u;

// CoatPath::fork: whether a way is followed both through glass that it meets and back from there.
/// No: chance decides.
const uint kForksNowhere = 0u;
/// It will be, at the first sharp surface where light does both.
const uint kForksNext = 1u;
/// It is what goes on through the surface that it has met just now.
const uint kForkCrosses = 2u;
/// It is what was reflected there. These ways are followed once all others have ended.
const uint kForkReflected = 3u;

/// A ray's way through the scene.
struct CoatPath {
  vec3 throughput;  ///< Share of the light that the ray meets next which the pixel's ray brings.
  float pdf;        ///< Density with which the direction was drawn in which it left the last coat;
                    ///< 0: the way has ended.
  float alpha;      ///< GGX width of the widest lobe on the way.
  uint stage;       ///< kStageOther, ...
  uint fork;        ///< kForksNowhere, ...
};
LAMBENT_DEVICE_ARRAY(CoatPathArray, CoatPath, 4)

/// CoatPath::pdf of ways whose lights nobody else looks for: those that begin through a surface.
const float kFoundByNobodyElse = 1e30f;

/// Distances to what rays met count as this long at least [m], so that one over them is a number.
const float kLeastSeenDistance = 1e-4f;

/// The distance to what a pixel's ray met [m]; below 0 where there is no ray.
LAMBENT_FN float seen_distance(CoatRay ray) {
  return ray.pdf > 0.0f ? ray.distance : -1.0f;
}

/// One over the distance to what a ray met [1/m]; 0 where it met nothing.
LAMBENT_FN float inverse_seen_distance(float distance) {
  return floatBitsToUint(distance) == kMissedDistanceBits
             ? 0.0f
             : 1.0f / max(distance, kLeastSeenDistance);
}

LAMBENT_END
#endif
