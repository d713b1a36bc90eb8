// SPDX-License-Identifier: Apache-2.0
// Temporal anti-aliasing of a pixel.
// Based on: Karis, "High Quality Temporal Supersampling", SIGGRAPH 2014; Salvi, "An Excursion in
// Temporal Supersampling", GDC 2016.
#ifndef LAMBENT_TEMPORAL_TAA_MATH_H
#define LAMBENT_TEMPORAL_TAA_MATH_H

#include "shared/color.h"
#include "shared/lang.h"
#include "shared/packing.h"
#include "shared/random.h"

LAMBENT_BEGIN

// Most frames that the history counts for where it is interpolated between pixels. Each
// interpolation blurs a little, while each frame makes edges smoother: with four the errors of the
// two were equal (lambent_motion walk).
const float kMovingHistoryFrames = 4.0f;

// Most frames for a pixel at rest in a picture in which other things move. Nothing is interpolated
// there, so that more frames do not blur.
const float kRestingHistoryFrames = 9.0f;

// Most frames of a picture in which nothing moves. Noise falls with each of them.
const float kStillHistoryFrames = 63.0f;

// Number of frames after the last edit of the world until its light has settled. From then on the
// history is clipped loosely, and not at all once the camera has rested as long: thin things that
// single frames miss would flicker for ever.
const uint kFramesUntilStill = 8u;

// Standard deviations of the neighbourhood by which the history may differ from its mean. Salvi
// 2016 takes 1 to 1.5; at 1, lines a pixel or two wide lose a third of their contrast while they
// move.
const float kClipDeviations = 1.25f;

// The same where nothing but the camera has moved for some frames. Motion vectors then lead to the
// same surface in the same light; only reflections have changed. With kClipDeviations, edges in the
// atrium had one and a half times the error.
const float kLooseClipDeviations = 4.0f;

// Least half side of the box to clip to, as a share of the neighbourhood's mean: a step of eight
// bits.
const float kLeastClipExtent = 1.0f / 256.0f;

// Luminance over the mean of a pixel's neighbourhood at which radiance has half its weight.
// Displays show five times the mean as white; lamps and suns are hundreds of times as bright, and
// an edge against them would never be smooth. Much lower values would dim what is merely bright: at
// white itself a fortieth of the atrium's light was lost.
const float kHalfWeightOverMean = 64.0f;

// A point was hidden in the previous frame where it lay behind the samples at its place by more
// than this share of its depth. Rounding is far less; things in contact are nearer.
const float kHiddenDepthShare = 0.01f;

// Further tolerance of depth, in changes of depth from a pixel to the next: a half for rounding the
// place to a pixel, and a half each for the positions of both frames' samples in their pixels.
const float kDepthSteps = 1.5f;

// How far the interpolated history may lie outside the range of the nearest four pixels, as a share
// of its ends. What negative weights of pixels farther out take off keeps edges sharp, but beside a
// lamp it would be black dashes.
const float kMaxOvershoot = 1.0f / 8.0f;

// Samples of one pixel met different surfaces where their depths differ by more than this share: of
// a thin thing and of what is behind it.
const float kOtherSurfaceShare = 0.02f;

// Most frames for which the last sample that met another surface is remembered: jitter has then
// visited each sixteenth of the pixel twice.
const uint kMostFramesOfOther = 32u;

// Greatest radiance of the other sample over the present one's luminance: far above that of a lamp
// before a wall, and small enough to be multiplied.
const float kMostOverPresent = 1e6f;

// What is two pixels away on either side of a pixel differs in depth by four steps from a pixel to
// the next. Half as much again is for slopes that are not even.
const float kAcrossSlack = 1.5f;

// Makes the random numbers of jitter independent of those of other passes.
const uint kJitterSalt = 0x4A495454u;

// Least divisor in expand_radiance: limits how bright interpolation that overshoots can become.
const float kLeastExpandDivisor = 1e-4f;

/// The history of a pixel.
struct TaaPixel {
  vec3 radiance;  ///< Filtered [W/(m^2 sr)].
  float depth;    ///< Depth of the frame's sample [m]; infinite: the sky.
  /// Largest depth of the samples of that frame and the previous one, and of those before while the
  /// other sample is remembered [m].
  float farthest_depth;
  uint moved;    ///< 1: the nearest surface in it and beside it moved itself.
  float frames;  ///< Number of frames that the radiance is a mean of, >= 1.
  /// Radiance of the frame's sample [W/(m^2 sr)] in the upper half of each word. In the lower, that
  /// of the last sample that met another surface, over the luminance of the first one after it.
  uvec3 samples;
  uint other_age;  ///< Frames since that other sample, up to kMostFramesOfOther; then it is void.
};

/// The last sample of a pixel that met another surface than its present one does. The light of both
/// is taken to change alike.
struct OtherSample {
  vec3 ratio;  ///< Its radiance over the present one's luminance.
  uint age;    ///< Frames since it was taken; kMostFramesOfOther: there is none.
};

LAMBENT_FN uvec3 pack_samples(vec3 radiance, vec3 ratio) {
  return uvec3(pack_upper_halves(radiance.x, ratio.x), pack_upper_halves(radiance.y, ratio.y),
               pack_upper_halves(radiance.z, ratio.z));
}
LAMBENT_FN vec3 latest_sample(TaaPixel pixel) {
  return vec3(unpack_upper_half(pixel.samples.x), unpack_upper_half(pixel.samples.y),
              unpack_upper_half(pixel.samples.z));
}
LAMBENT_FN vec3 other_ratio(TaaPixel pixel) {
  return vec3(unpack_lower_half(pixel.samples.x), unpack_lower_half(pixel.samples.y),
              unpack_lower_half(pixel.samples.z));
}

/// Whether samples at two depths met different surfaces. Depths of one surface may differ by
/// `slack` [m].
LAMBENT_FN bool is_other_surface(float depth, float depth_before, float slack) {
  float nearer = min(depth, depth_before);
  return max(depth, depth_before) > nearer * (1.0f + kOtherSurfaceShare) + slack;
}

/// How far depths of one surface may differ from frame to frame in a pixel [m].
struct DepthSlack {
  float slope;  ///< By the slope of the surface.
  float edge;   ///< At an edge: of surfaces whose depths differ by no more, none is a thin thing.
};

/// Follows the other sample from a pixel's previous frame to one whose sample has this luminance
/// and depth.
LAMBENT_FN OtherSample follow_other(TaaPixel before, float brightness, float depth,
                                    DepthSlack slack) {
  OtherSample none = {vec3(0.0f), kMostFramesOfOther};
  if (!is_other_surface(depth, before.depth, slack.edge)) {
    // The other sample is known relative to the surface that the last sample met. Relative to one
    // beyond an edge, as a lamp's to its own, it would have the square of the lamp's brightness
    if (is_other_surface(depth, before.depth, slack.slope)) return none;
    OtherSample kept = {other_ratio(before), min(before.other_age + 1u, kMostFramesOfOther)};
    return kept;
  }
  // Beside a black sample, nothing tells how its light changes
  float most = kMostOverPresent * brightness;
  vec3 latest = latest_sample(before);
  if (!(max(latest.x, max(latest.y, latest.z)) < most)) return none;
  OtherSample fresh = {latest / brightness, 0u};
  return fresh;
}

/// Element k, 0 to 3, of the permutation of 0 to 3 that a random number selects.
LAMBENT_FN uint shuffled_quadrant(uint k, uint random) {
  uint order = 0x3210u;
  for (uint last = 3u; last > 0u; --last) {
    uint other = random % (last + 1u);
    random /= last + 1u;
    // Exchange the two digits
    uint difference = ((order >> (4u * last)) ^ (order >> (4u * other))) & 3u;
    order ^= (difference << (4u * last)) ^ (difference << (4u * other));
  }
  return (order >> (4u * k)) & 3u;
}

/// Position of a frame's samples in their pixels, 0 to 1 each: the same in all pixels, so that a
/// frame is a regular picture that is shifted by less than a pixel. Each four successive frames
/// visit the four quadrants, each sixteen the sixteen cells, in random orders and at random points:
/// a (0,2)-sequence as scrambled by Owen, "Monte Carlo variance of scrambled net quadrature", 1997.
/// A regular order would be in step with some speed: a thing that moves by half a pixel a frame
/// would be sampled by every other point of Halton's sequence, always at the same places.
LAMBENT_FN vec2 jitter_position(uint index) {
  uint quadrant = shuffled_quadrant(index & 3u, hash_pcg3d(uvec3(index >> 2u, 0u, kJitterSalt)).x);
  uvec3 cell_order = hash_pcg3d(uvec3(index >> 4u, 1u + quadrant, kJitterSalt));
  uint cell = shuffled_quadrant((index >> 2u) & 3u, cell_order.x);
  RandomStream random = make_random_stream(index, 0u, kJitterSalt);
  vec2 corner = vec2(0.5f * float(quadrant & 1u) + 0.25f * float(cell & 1u),
                     0.5f * float(quadrant >> 1u) + 0.25f * float(cell >> 1u));
  return corner + 0.25f * next_uniform2(random);
}

/// Radiance over the mean luminance of its neighbourhood, compressed where it is far brighter: a
/// mean of these is a mean of radiance that weights each by 1 / (1 + luminance / (mean * k)), so
/// that edges against lamps look smooth and fireflies have little weight (Karis 2014).
LAMBENT_FN vec3 compress_radiance(vec3 radiance, float mean) {
  return radiance / (mean + luminance(radiance) / kHalfWeightOverMean);
}

/// The inverse of compress_radiance. A luminance of kHalfWeightOverMean or more, which compression
/// cannot yield but interpolation may overshoot to, becomes large and finite.
LAMBENT_FN vec3 expand_radiance(vec3 compressed, float mean) {
  float share = luminance(compressed) / kHalfWeightOverMean;
  return compressed * (mean / max(1.0f - share, kLeastExpandDivisor));
}

/// Luma and two chroma differences, which are less correlated than primaries are: boxes along these
/// axes are tighter (Karis 2014).
LAMBENT_FN vec3 ycocg_from_rgb(vec3 c) {
  return vec3(0.25f * c.x + 0.5f * c.y + 0.25f * c.z, 0.5f * c.x - 0.5f * c.z,
              -0.25f * c.x + 0.5f * c.y - 0.25f * c.z);
}
LAMBENT_FN vec3 rgb_from_ycocg(vec3 c) {
  return vec3(c.x + c.y - c.z, c.x + c.z, c.x - c.y - c.z);
}

/// Weights of four successive pixels for a place at `t`, 0 to 1, between the middle two.
/// Catmull and Rom, "A Class of Local Interpolating Splines", 1974.
LAMBENT_FN vec4 catmull_rom_weights(float t) {
  float t2 = t * t;
  float t3 = t2 * t;
  return vec4(-0.5f * t3 + t2 - 0.5f * t, 1.5f * t3 - 2.5f * t2 + 1.0f,
              -1.5f * t3 + 2.0f * t2 + 0.5f * t, 0.5f * t3 - 0.5f * t2);
}

/// Statistics of a pixel's neighbourhood in this frame, compressed, as luma and chroma.
struct TaaNeighbourhood {
  vec3 mean;
  vec3 extent;  ///< Half the sides of the box around the mean that the history must lie in.
};

/// The neighbourhood from sums over `count` pixels, of which the middle one shows `now`. The box
/// always includes `now`, however unlike its neighbours it is.
LAMBENT_FN TaaNeighbourhood taa_neighbourhood(vec3 sum, vec3 sum_of_squares, float count, vec3 now,
                                              float deviations) {
  vec3 mean = sum / count;
  vec3 variance = max(sum_of_squares / count - mean * mean, vec3(0.0f));
  vec3 extent = max(deviations * sqrt(variance), abs(now - mean));
  TaaNeighbourhood around = {mean, max(extent, vec3(kLeastClipExtent))};
  return around;
}

/// The neighbourhood, widened until the box includes a colour.
LAMBENT_FN TaaNeighbourhood include_color(TaaNeighbourhood around, vec3 color) {
  vec3 low = min(around.mean - around.extent, color);
  vec3 high = max(around.mean + around.extent, color);
  TaaNeighbourhood wider = {0.5f * (low + high), 0.5f * (high - low)};
  return wider;
}

/// Distance of a colour from the neighbourhood's mean, relative to the box: above 1 it is outside.
LAMBENT_FN float distance_over_box(TaaNeighbourhood around, vec3 color) {
  vec3 share = abs(color - around.mean) / around.extent;
  return max(share.x, max(share.y, share.z));
}

/// The history, moved towards the mean until it is in the box (Salvi 2016).
LAMBENT_FN vec3 clip_history(TaaNeighbourhood around, vec3 history, float distance) {
  return around.mean + (history - around.mean) / max(distance, 1.0f);
}

/// Change of depth from a pixel to the next along a surface [m]: the smaller of both sides, as the
/// neighbour beyond an edge belongs to another surface.
LAMBENT_FN float depth_step(float before, float depth, float after) {
  return min(abs(before - depth), abs(after - depth));
}

/// Whether a point at this depth was hidden in the previous frame. Depths of one surface may differ
/// by `slack` [m].
LAMBENT_FN bool was_hidden(float depth_before, float farthest_depth, float slack) {
  // Of two infinite depths neither is behind the other
  return depth_before > farthest_depth * (1.0f + kHiddenDepthShare) + slack;
}

LAMBENT_END
#endif
