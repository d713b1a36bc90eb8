// SPDX-License-Identifier: Apache-2.0
// Guided gathering: some of a pixel's rays go where most of the light comes from.
//
// A patch of sun or a window may be a hundredth of what a wall sees, and most of its light. Rays
// drawn by the cosine meet it rarely, and the wall is blotched. A pilot (guide.h) gathers light at
// the points of a small picture and keeps, for each of them, places that bright rays of its
// neighbourhood met. Pixels draw a part of their rays within cones around the directions to these
// places: Jensen, "Importance Driven Path Tracing using the Photon Map", 1995, with the pilot's
// rays for photons. Both kinds of rays are combined by the balance heuristic: Veach, "Robust Monte
// Carlo Methods for Light Transport Simulation", 1997, sec. 9.2.
#ifndef LAMBENT_GATHER_GUIDE_MATH_H
#define LAMBENT_GATHER_GUIDE_MATH_H

#include "shared/sampling.h"

LAMBENT_BEGIN

// Bright places of a point of the pilot. Each stands for the same share of the bright light: more
// of them tell more small lamps apart, and every ray is compared with all.
const int kBrightPlaces = 32;

// The largest share of rays that are guided. The others, at least half, find what the pilot missed:
// a ray counts at most twice as much as without guiding.
const float kMaxGuidedShare = 0.5f;

// Points of the pilot whose normals have a smaller cosine to a pixel's do not guide it: half of
// what they see would be below its horizon.
const float kGuidingCosine = 0.7f;

// Salts by which the choice of a guiding point and the directions of guided rays have random
// numbers of their own.
const uint kGuidingSalt = 0x27D4EB2Fu;
const uint kGuidedSalt = 0x165667B1u;

/// A point of the pilot.
struct GuidePoint {
  vec3 normal_ws;      ///< 0 where the pilot saw no surface.
  float least_cosine;  ///< Cosine of half the angle of the cones around the bright places.
  float share;         ///< Of rays that are guided, up to kMaxGuidedShare; 0: there are no places.
};

/// The sizes of a picture and of its pilot [pixels]. A width of 0: there is no pilot.
struct GuideSize {
  int picture_width, picture_height;
  int width, height;
};

/// The number of rays that are guided, of so many of a pixel.
LAMBENT_FN uint guided_rays(float share, uint rays) {
  return min(uint(share * float(rays) + 0.5f), rays / 2u);
}

/// Whether a direction is within the cone around the direction to a place.
LAMBENT_FN bool is_in_cone(vec3 direction_ws, vec3 to_place, float least_cosine) {
  float along = dot(direction_ws, to_place);
  return along > 0.0f && along * along >= least_cosine * least_cosine * dot(to_place, to_place);
}

/// Density of guided rays [1/sr] in a direction that is within so many of the cones.
LAMBENT_FN float guided_density(float cones, float least_cosine) {
  return cones / float(kBrightPlaces) * pdf_uniform_cone(least_cosine);
}

/// The factor of a ray's contribution, 1 where all rays are drawn by the cosine. This share of the
/// rays is drawn with `density` [1/sr], the others with cosine over pi.
LAMBENT_FN float guided_weight(float cosine, float density, float share) {
  float by_cosine = pdf_cosine_hemisphere(cosine);
  if (by_cosine <= 0.0f) return 0.0f;
  return by_cosine / ((1.0f - share) * by_cosine + share * density);
}

LAMBENT_END
#endif
