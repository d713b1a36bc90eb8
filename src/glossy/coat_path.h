// SPDX-License-Identifier: Apache-2.0
// Rays of the specular lobes of pixels ("coats": the GGX layer of a surface), rays through
// transmissive surfaces, and their paths through the scene.
#ifndef LAMBENT_GLOSSY_COAT_PATH_H
#define LAMBENT_GLOSSY_COAT_PATH_H

#include "raytracing/ray_records.h"
#include "shared/reservoir.h"

LAMBENT_BEGIN

/// The ray that a pixel's coat, or a pixel's transmissive surface, sends out, and the light that
/// its path gathers.
struct CoatRay {
  vec3 direction_ws;  ///< Unit.
  float distance;     ///< See distance_met() [m]; infinite: it left the scene; below 0: see pdf.
  vec3 radiance;      ///< Light of the path without `apart` [W/(m^2 sr)].
  float pdf;          ///< Density with which it was drawn [1/sr]; 0: there is no ray; below 0: the
                      ///< direction drawn points into the surface, and no light comes from there.
                      ///< Rays through surfaces have 0; where there is no such ray, `distance` is
                      ///< below 0.
  vec3 apart;         ///< Light that is stored apart, see CoatPath::stage [W/(m^2 sr)].
  /// Of kStageOwnCoat and kStageOwnMirror: emission_luminance() of the emitter that it found
  /// [W/(m^2 sr)]; of the sky, minus the density with which samples find it [1/sr]. See
  /// sampled_density().
  float apart_luminance;
  /// Light that the coat of what a mirror shows reflects, see MirroredCoat; of rays through
  /// surfaces, light of long ways, see kStageLongWay [W/(m^2 sr)]. `radiance` does not include it.
  vec3 mirrored;
};
LAMBENT_DEVICE_ARRAY(CoatRayArray, CoatRay, 4)

// Values of CoatPath::stage: what a path has hit so far, and hence which light of its next hits is
// stored in CoatRay::apart or CoatRay::mirrored.
/// It left the pixel's surface, or a coat that it hit. Nothing is stored apart.
const uint kStageOther = 0u;
/// It left the pixel's coat, and no other coat has reflected it. The emission that it hits, or the
/// bright part of the sky, is stored apart, as the pixel's direct light samples it, too.
const uint kStageOwnCoat = 1u;
/// It does what kStageOwnCoat says, and that coat is a mirror, see MirroredCoat.
const uint kStageOwnMirror = 2u;
/// It does what kStageOwnMirror says, and is at a MirroredCoat. What that reflects of direct light
/// is stored in CoatRay::mirrored.
const uint kStageAtMirroredCoat = 3u;
/// It left the pixel's mirror, and sharp coats of surfaces without a base alone have reflected it
/// since. Where it ends, a ShownBase is stored, as of the two stages above.
const uint kStageFurtherMirror = 4u;
/// It came through surfaces alone. Nothing is stored apart. Where one is rough, it samples lights
/// behind it.
const uint kStageThroughGlass = 5u;
/// It left the clearcoat of the first opaque surface behind glass. Nothing is stored apart.
const uint kStageBeyondClearcoat = 6u;
/// It came through glass to that surface. Nothing is stored apart.
const uint kStageBehindGlass = 7u;
/// It left the coat of that surface, and has hit nothing but glass since. All light is stored
/// apart.
const uint kStageCoatBehindGlass = 8u;
/// It left the coat of that surface, and has hit something else than glass. All light is stored
/// apart.
const uint kStageBeyondCoat = 9u;
/// It left a MirroredCoat. All light is stored in CoatRay::mirrored.
const uint kStageBeyondMirroredCoat = 10u;
/// It came through surfaces alone, more than kMaxPathVertices of them, or is a branch within a
/// volume of a pixel with few samples, see split(). All light is stored in CoatRay::mirrored.
const uint kStageLongWay = 11u;

// Values of CoatPath::fork: whether a path splits where glass both transmits and reflects.
/// It does not split: at each surface one of the two directions is chosen, see go_on().
const uint kForksNowhere = 0u;
/// It splits at each smooth surface of glass, see forks(), and goes on as the main part of the
/// light, see extend_split(). The rest is a branch, of which each pixel keeps one, see
/// keeps_branch().
const uint kForks = 1u;
/// It does what kForks says, and has just split.
const uint kHasForked = 2u;
/// It is the branch that the pixel has kept. These paths are traced after all others have ended.
const uint kForkBranch = 3u;

/// Bounce from which branches count: distances are found on bounce 1, which none has. A branch
/// counts from here wherever its path split.
const uint kFirstBounceOfForks = 2u;

/// The state of a path through the scene.
struct CoatPath {
  vec3 throughput;  ///< Factor from the radiance of the next hit to that of the pixel's ray.
  float pdf;        ///< Density with which the direction was drawn in which it left the last coat
                    ///< or, if it came through surfaces alone, the last that bent it; 0: the path
                    ///< has ended.
  float alpha;      ///< GGX width of the widest lobe on the path.
  uint stage;       ///< kStageOther, ...
  uint fork;        ///< kForksNowhere, ...
  /// emitter_density_scale() of the surface that `pdf` belongs to [m^2/W]; 0 where no samples are
  /// taken there.
  float density_scale;
  Reservoir branches;  ///< Of paths that fork: the draw among their branches.
  uint branch_slot;    ///< Index of the branch kept, in lists on devices; valid if there is one.
};
LAMBENT_DEVICE_ARRAY(CoatPathArray, CoatPath, 4)

// Widest lobe of a pixel that counts as a mirror here, that of roughness 0.1. The filter cannot
// spread what such a coat reflects over more than a pixel or two: the picture in it would blur.
// Rays that meet mirrors later on their way count wider ones, see is_mirror().
const float kMirrorAlpha = 0.01f;

// Widest lobe of a mirror behind which the light of emitters is filtered, that of roughness 0.05.
// Rays of wider ones end too far apart to show one picture, and each pixel reflects several.
const float kSharpMirrorAlpha = 0.0025f;

/// A coat that a pixel's mirror shows. A mirrored picture of it is as noisy as the coat itself:
/// what it reflects is filtered over its own lobe, as if the surface stood behind the mirror.
struct MirroredCoat {
  vec3 position_ws;     ///< Of the surface. After all rays were traced, of its mirror image.
  vec3 normal_ws;       ///< As position_ws.
  float alpha;          ///< GGX width of its lobe; 0: the mirror shows no such coat.
  vec3 albedo;          ///< filtered_coat_albedo(). After all rays were traced, times the mirror's.
  float seen_distance;  ///< From it to what it reflects [m]; infinite: the sky; below 0: unknown.
  // These are filled in after all rays of the pixel were traced
  vec3 light;                   ///< What it reflects by rays, as the mirror shows it [W/(m^2 sr)].
  float inverse_seen_distance;  ///< See seen_inverse_distance() [1/m].
  vec3 mirror_share;  ///< Share of its ray's radiance that the pixel reflects, for any alpha.
};
LAMBENT_DEVICE_ARRAY(MirroredCoatArray, MirroredCoat, 4)

/// The record of a pixel whose mirror shows no such coat.
LAMBENT_FN MirroredCoat no_mirrored_coat() {
  MirroredCoat none = {vec3(0.0f), vec3(0.0f), 0.0f, vec3(0.0f),
                       -1.0f,      vec3(0.0f), 0.0f, vec3(0.0f)};
  return none;
}

/// The first opaque surface with a base that a pixel's mirror shows, in other mirrors or not, or
/// the first opaque surface that it shows behind glass. Diffuse light from emitters there has
/// noise, as has that which rays from it gather: both are filtered over that surface, like the
/// light of surfaces that the camera sees. Behind glass, emitters' light is stored in SeenThrough
/// instead.
struct ShownBase {
  vec3 position_ws;
  float level;  ///< FilteredEmitter::level.
  vec3 normal_ws;
  float variance;       ///< Of the luminance of `light`.
  vec3 light;           ///< Of emitters: FilteredEmitter::light [W/(m^2 sr)].
  uint shown;           ///< 1: the pixel shows such a surface; 0: it does not.
  vec3 emitter_albedo;  ///< Factor from filtered `light` to the radiance of the pixel's ray.
  float gi_share;       ///< See Surface.
  vec3 geometric_normal_ws;
  float viewer_distance;  ///< Length of the last segment of the pixel's path to it [m].
  vec3 to_viewer_ws;      ///< Unit; back along that segment.
  /// Factor from the irradiance that it gathers to the radiance of the pixel's ray [1/sr]; 0: it
  /// gathers none.
  vec3 indirect_albedo;
};
LAMBENT_DEVICE_ARRAY(ShownBaseArray, ShownBase, 4)

/// The record of a pixel that shows no such surface.
LAMBENT_FN ShownBase no_shown_base() {
  ShownBase none = {vec3(0.0f), 0.0f, vec3(0.0f), 0.0f, vec3(0.0f), 0u,
                    vec3(0.0f), 0.0f, vec3(0.0f), 0.0f, vec3(0.0f), vec3(0.0f)};
  return none;
}

/// The distance to what the coat of this width in a pixel's mirror reflects [m], or below 0.
LAMBENT_FN float seen_distance(float mirrored_alpha, float seen_distance) {
  return mirrored_alpha > 0.0f ? seen_distance : -1.0f;
}

/// CoatPath::pdf of paths through surfaces behind which no lights are sampled: no other estimator
/// finds the emitters that they meet.
const float kNoLightSampling = 1e30f;

/// A path at its start, which does not split.
LAMBENT_FN CoatPath begin_path(float pdf, float alpha, uint stage, float density_scale) {
  CoatPath path = {
      vec3(1.0f), pdf, alpha, stage, kForksNowhere, density_scale, begin_reservoir(0.0f), 0u};
  return path;
}

/// A path at its start through glass of this GGX width, which splits there; `u`: the uniform number
/// that draws its branch.
LAMBENT_FN CoatPath begin_path_through_glass(float alpha, float u) {
  CoatPath path = begin_path(kNoLightSampling, alpha, kStageThroughGlass, 0.0f);
  path.fork = kForks;
  path.branches = begin_reservoir(u);
  return path;
}

/// Least distance to hits [m], so that its reciprocal is finite.
const float kLeastSeenDistance = 1e-4f;

/// A ray that was not drawn; see CoatRay::distance.
LAMBENT_FN CoatRay no_coat_ray(float distance) {
  CoatRay none = {vec3(0.0f, 0.0f, 1.0f), distance, vec3(0.0f), 0.0f, vec3(0.0f), 0.0f, vec3(0.0f)};
  return none;
}

/// The distance to the hit of a pixel's ray [m]; below 0 where there is no ray.
LAMBENT_FN float seen_distance(CoatRay ray) {
  return ray.pdf > 0.0f ? ray.distance : -1.0f;
}

/// Whether a ray of this distance left the scene.
LAMBENT_FN bool left_scene(float distance) {
  return floatBitsToUint(distance) == kMissedDistanceBits;
}

/// One over the distance to a ray's hit [1/m]; 0 where it left the scene.
LAMBENT_FN float inverse_seen_distance(float distance) {
  return left_scene(distance) ? 0.0f : 1.0f / max(distance, kLeastSeenDistance);
}

/// The part of a coat's light that the pixel's own ray supplies alone, as no ray around fits its
/// lobe.
struct OwnRayLight {
  vec3 light;   ///< The estimate of that ray [W/(m^2 sr)].
  float share;  ///< Its share of the coat's light.
};
LAMBENT_DEVICE_ARRAY(OwnRayLightArray, OwnRayLight, 4)

/// What the filter is told of the light that a pixel's coat reflects from rays.
struct CoatGuide {
  vec3 excess;             ///< Part of the light, see kMaxShareOfOthers [W/(m^2 sr)].
  float inverse_distance;  ///< One over the distance to what the coat reflects [1/m].
  float ray_variance;      ///< See ReflectedRays::ray_variance.
};
LAMBENT_DEVICE_ARRAY(CoatGuideArray, CoatGuide, 4)

LAMBENT_END
#endif
