// SPDX-License-Identifier: Apache-2.0
// Corrections of lookups: on small cells of the surfaces, the ratio of the irradiance that a gather
// finds to the irradiance that the lookup interpolates.
//
// Probes stand in the air and see more than a surface in a nook does. There the lookup is off by a
// factor that depends on the place and hardly changes from update to update, so that a few gathers
// in each update find it.
// docs/math.md derives the estimator.
#ifndef LAMBENT_FIELD_CORRECTION_CORRECTION_MATH_H
#define LAMBENT_FIELD_CORRECTION_CORRECTION_MATH_H

#include "field/probes/probe_grid.h"
#include "shared/random.h"

LAMBENT_BEGIN

// The edges of cells: the smallest spacing of the volume's probes over kCorrectionCells, and in
// each coarser level kCorrectionGrowth times as long. The finest cells resolve what a lookup blurs,
// the coarsest are about a spacing wide.
const float kCorrectionCells = 8.0f;
const float kCorrectionGrowth = 3.0f;
const int kCorrectionLevels = 3;

// Cells count as if they had this many samples more, all of the next coarser level's ratio. Four
// leave an 8x8 RMSE of 0.106 in the hotel room where two leave 0.097; fewer make lookups noisier.
const float kCorrectionPrior = 2.0f;

// Where lookups are shown, a level counts as if the coarser ones were so many samples: single cells
// must not stand out. Levels to which less than this share is left are not read.
const float kSmoothPrior = 8.0f;
const float kSmoothRest = 0.05f;

// The largest ratio, and the inverse of the smallest. Lookups are further off only where hardly any
// light is.
const float kMaxCorrection = 4.0f;

// A cell counts by the square of the normal's component along its axis. Components whose square is
// below this are left out.
const float kMinAxisShare = 0.04f;

/// The name of a block of 2 x 2 x 2 cells of one level.
struct CorrectionKey {
  uint xy;    ///< Of the block's coordinates, 16 bits each.
  uint rest;  ///< z, axis, level and volume; 0: none.
};

// The directions along the axes that surfaces may face.
const uint kCorrectionAxes = 6u;

const uint kCorrectionKeyUsed = 1u << 31u;
const uint kCorrectionKeyBits = 16u;
const uint kCorrectionAxisShift = 16u;
const uint kCorrectionLevelShift = 19u;
const uint kCorrectionVolumeShift = 21u;

// Volumes have 6 bits, since no field has more than 64; axes 3 and levels 2.
const uint kCorrectionVolumeMask = 63u;
const uint kCorrectionAxisMask = 7u;
const uint kCorrectionLevelMask = 3u;

/// `axis` is the axis that surfaces in the block face along, 0 to 2, or 3 to 5 where they face
/// against it. Coordinates that differ by a multiple of 65,536 blocks share a name.
LAMBENT_FN CorrectionKey correction_key(ivec3 block, uint axis, uint level, uint volume) {
  const uint mask = (1u << kCorrectionKeyBits) - 1u;
  CorrectionKey key = {(uint(block.x) & mask) | (uint(block.y) << kCorrectionKeyBits),
                       (uint(block.z) & mask) | (axis << kCorrectionAxisShift) |
                           (level << kCorrectionLevelShift) | (volume << kCorrectionVolumeShift) |
                           kCorrectionKeyUsed};
  return key;
}

/// The coordinates of a named block but for multiples of 65,536 blocks, which are taken to be
/// nearest to 0.
LAMBENT_FN ivec3 block_of_key(CorrectionKey key) {
  return ivec3(int(key.xy << 16u) >> 16, int(key.xy) >> 16, int(key.rest << 16u) >> 16);
}
LAMBENT_FN uint axis_of_key(CorrectionKey key) {
  return (key.rest >> kCorrectionAxisShift) & kCorrectionAxisMask;
}
LAMBENT_FN uint level_of_key(CorrectionKey key) {
  return (key.rest >> kCorrectionLevelShift) & kCorrectionLevelMask;
}
LAMBENT_FN uint volume_of_key(CorrectionKey key) {
  return (key.rest >> kCorrectionVolumeShift) & kCorrectionVolumeMask;
}

/// Whether a name is one of a block in a field of so many volumes.
LAMBENT_FN bool is_block_key(CorrectionKey key, uint volumes) {
  return (key.rest & kCorrectionKeyUsed) != 0u && axis_of_key(key) < kCorrectionAxes &&
         level_of_key(key) < uint(kCorrectionLevels) && volume_of_key(key) < volumes;
}

LAMBENT_FN bool is_same_block(CorrectionKey a, CorrectionKey b) {
  return a.rest == b.rest && a.xy == b.xy;
}

/// Whether a new block takes the place that is left before another one: coarser levels do. Any
/// block does before the name that is none.
LAMBENT_FN bool is_block_before(CorrectionKey a, CorrectionKey b) {
  return a.rest > b.rest || (a.rest == b.rest && a.xy > b.xy);
}

// Blocks are kept in buckets of a hash table: eight names fill a cache line.
const uint kCorrectionBucket = 8u;
const uint kNoCorrectionBlock = 0xFFFFFFFFu;

// Buckets a probe: room for 32 blocks. A wall through a probe's cell takes about twenty on each
// side, and not all probes stand at walls.
const uint kCorrectionBucketsPerProbe = 4u;

/// The first slot of a block's bucket.
LAMBENT_FN uint correction_bucket(CorrectionKey key, uint buckets) {
  return kCorrectionBucket * (hash_pcg3d(uvec3(key.xy, key.rest, 0u)).x % buckets);
}

// Coordinates of cells are bounded by this, so that they are integers in any scene.
const float kMaxCorrectionCoord = 1073741824.0f;

/// A point in the cells of the finest level. Those of each coarser one are kCorrectionGrowth times
/// as long.
LAMBENT_FN vec3 correction_coords(ProbeGrid grid, vec3 position_ws) {
  vec3 coords = (position_ws * grid.axes) * (kCorrectionCells / smallest_spacing(grid));
  return clamp(coords, vec3(-kMaxCorrectionCoord), vec3(kMaxCorrectionCoord));
}

// Lookups whose mean counts read a single cell, picked at random by where they are. Points within
// so small a part of a finest cell share their pick, so that it does not hang on how a backend
// rounds. No surface at a round coordinate is at the border of such parts.
const float kPickSteps = 64.0f;
const float kPickShift = 0.37f;

/// A random point of the unit cube for a point in space: picks a cell.
LAMBENT_FN vec3 correction_pick(ProbeGrid grid, vec3 position_ws) {
  vec3 part = floor(correction_coords(grid, position_ws) * kPickSteps + vec3(kPickShift));
  uvec3 mixed =
      hash_pcg3d(uvec3(floatBitsToUint(part.x), floatBitsToUint(part.y), floatBitsToUint(part.z)));
  return vec3(uniform_from_bits(mixed.x), uniform_from_bits(mixed.y), uniform_from_bits(mixed.z));
}

/// The centre of a cell, in cells of the next coarser level.
LAMBENT_FN vec3 coarser_coords(ivec3 cell) {
  return (vec3(cell) + vec3(0.5f)) / kCorrectionGrowth;
}

/// The centre of a named block.
LAMBENT_FN vec3 block_centre(ProbeGrid grid, CorrectionKey key) {
  vec3 coords = 2.0f * vec3(block_of_key(key)) + vec3(1.0f);
  for (uint level = level_of_key(key); level > 0u; --level) coords *= kCorrectionGrowth;
  return grid.axes * (coords * (smallest_spacing(grid) / kCorrectionCells));
}

/// Where a cell is within its block, as the bits of cell_corner().
LAMBENT_FN int cell_of_block(ivec3 cell) {
  return (cell.x & 1) | ((cell.y & 1) << 1) | ((cell.z & 1) << 2);
}

/// A cell's ratio, and on how many samples it rests, less what was forgotten.
struct CorrectionCell {
  float ratio;    ///< 1 / kMaxCorrection to kMaxCorrection.
  float samples;  ///< By their worth; below 256.
};

// Both numbers are stored as fixed-point numbers of 16 bits.
const float kCorrectionRatioSteps = 16383.0f;
const float kCorrectionSampleSteps = 256.0f;
const float kMaxCorrectionSamples = 255.0f;

/// A cell in a word, the number of samples above. That is rounded down, so that what is never
/// confirmed is forgotten in the end.
LAMBENT_FN uint encode_correction(CorrectionCell cell) {
  return uint(min(cell.ratio, kMaxCorrection) * kCorrectionRatioSteps + 0.5f) |
         (uint(min(cell.samples, kMaxCorrectionSamples) * kCorrectionSampleSteps) << 16u);
}

LAMBENT_FN CorrectionCell decode_correction(uint word) {
  CorrectionCell cell = {float(word & 0xFFFFu) * (1.0f / kCorrectionRatioSteps),
                         float(word >> 16u) * (1.0f / kCorrectionSampleSteps)};
  return cell;
}

// Cells count by their samples, and by so many more where they have none: a cell beside a surface
// rather than on it must not count there.
const float kLeastCorrectionSamples = 1.0f / 64.0f;

// New samples of a cell are summed up as integers, so that their order does not matter: 8,192 of
// the brightest in an update.
const float kCorrectionSumSteps = 16384.0f;

// Samples count in proportion to what the lookup finds, since the ratio of means is less noisy than
// the mean of ratios and bright places matter more; but none more than one at which the lookup
// finds so many times the mean.
const float kBrightestLookup = 8.0f;

// What is gathered counts as at most so many times the mean. Above are fireflies of the gather.
const float kBrightestGather = 32.0f;

// A sample counts as one where the variance of what it gathers, over the square of what the lookup
// finds, is this on average, and as less where it is more: kSmoothPrior then stands for a standard
// deviation of 11 % between cells and the level above them. Rooms with large lamps have this
// variance, those with small bright places ten times it.
const float kTypicalNoise = 0.1f;

// A sample counts as no less than this, so that a cell's number of samples does not round to none.
const float kLeastWorth = 1.0f / 32.0f;

/// Of the samples of an update: the sums of the variances of what they gather, and of the squares
/// of what lookups find.
struct CorrectionNoise {
  float variances;
  float squares;
};

/// What a sample scales with, as far as others are concerned. `mean` is the mean of what lookups
/// find, > 0.
LAMBENT_FN float correction_scale(float looked_up, float mean) {
  return 1.0f / max(mean, looked_up * (1.0f / kBrightestLookup));
}

/// What one sample adds to the noise of an update, from the variance of what it gathers.
LAMBENT_FN CorrectionNoise correction_noise(float variance, float looked_up, float mean) {
  float scale = correction_scale(looked_up, mean);
  float level = looked_up * scale;
  CorrectionNoise noise = {min(variance * (scale * scale), kBrightestGather * kBrightestGather),
                           level * level};
  return noise;
}

/// How many samples of typical noise one of an update counts as, at most 1.
LAMBENT_FN float worth_of_samples(CorrectionNoise noise) {
  float typical = kTypicalNoise * noise.squares;
  return noise.variances > typical ? max(typical / noise.variances, kLeastWorth) : 1.0f;
}

/// A sample as it is summed up.
struct CorrectionSum {
  uint gathered;
  uint looked_up;
};

/// The sample at a point where a gather and a lookup find these irradiances. `mean` is the mean of
/// what lookups find, > 0.
LAMBENT_FN CorrectionSum correction_sum(float gathered, float looked_up, float mean) {
  float steps = kCorrectionSumSteps * correction_scale(looked_up, mean);
  CorrectionSum sum = {uint(min(gathered * steps, kBrightestGather * kCorrectionSumSteps) + 0.5f),
                       uint(looked_up * steps + 0.5f)};
  return sum;
}

/// A sample for one cell, in the list of those for blocks of one bucket.
struct CorrectionItem {
  CorrectionKey key;  ///< Of the cell's block; rest 0: the item is none.
  CorrectionSum sum;
  uint cell;  ///< Within the block.
  uint next;  ///< The place of the list's next item, from 1; 0: this is the last one.
};

/// The item of a sample for the cell of a level around a point, which is given in cells of that
/// level. `axis` comes from correction_axis().
LAMBENT_FN CorrectionItem correction_item(vec3 coords, uint axis, uint level, uint volume,
                                          CorrectionSum sum) {
  ivec3 cell = ivec3(floor(coords));
  ivec3 block = ivec3(cell.x >> 1, cell.y >> 1, cell.z >> 1);
  CorrectionItem item = {correction_key(block, axis, level, volume), sum, uint(cell_of_block(cell)),
                         0u};
  return item;
}

/// What a cell has learned.
struct LearnedCorrection {
  float gathered;   ///< Sum of CorrectionSum::gathered, less what was forgotten.
  float looked_up;  ///< Sum of CorrectionSum::looked_up, less what was forgotten.
  float samples;    ///< Number of samples by their worth, less what was forgotten.
};

// A cell with fewer samples than this is forgotten.
const float kForgottenSamples = 1.0f / 64.0f;

/// A cell after an update: it keeps a share of what it had, and gets new samples, so many by their
/// worth.
LAMBENT_FN LearnedCorrection updated_correction(LearnedCorrection cell, float keep,
                                                CorrectionSum sum, float samples) {
  LearnedCorrection updated = {
      cell.gathered * keep + float(sum.gathered) * (1.0f / kCorrectionSumSteps),
      cell.looked_up * keep + float(sum.looked_up) * (1.0f / kCorrectionSumSteps),
      cell.samples * keep + samples};
  if (updated.samples < kForgottenSamples) {
    updated.gathered = 0.0f;
    updated.looked_up = 0.0f;
    updated.samples = 0.0f;
  }
  return updated;
}

// Samples of cells whose lookups find less than the inverse of this, in means of what all lookups
// find, count in proportion to that: what leaks into a dark place must not be taken for light that
// is there several times.
const float kTrustedLookup = 4.0f;

/// What lookups read from a cell, from what it has learned and the ratio of the next coarser level
/// there.
LAMBENT_FN CorrectionCell refined_correction(LearnedCorrection own, float coarser) {
  float ratio = own.looked_up > 0.0f ? own.gathered / own.looked_up : coarser;
  float trusted = min(own.samples, kTrustedLookup * own.looked_up);
  float refined = (trusted * min(ratio, kMaxCorrection) + kCorrectionPrior * coarser) /
                  (trusted + kCorrectionPrior);
  CorrectionCell cell = {clamp(refined, 1.0f / kMaxCorrection, kMaxCorrection), own.samples};
  return cell;
}

// An update of this number or a later one forgets no faster.
const float kCorrectionWindow = 256.0f;

/// The share of samples that update `number` (>= 1) keeps: samples count in proportion to the
/// number of their update, since the first ones see light that knows of no corrections yet.
LAMBENT_FN float kept_corrections(uint number) {
  return 1.0f - 2.0f / (min(float(number), kCorrectionWindow) + 2.0f);
}

/// The axis for which a sample on a surface with this normal (along the grid's axes) counts. `pick`
/// is uniform in [0, 1).
LAMBENT_FN uint correction_axis(vec3 normal, float pick) {
  vec3 share = normal * normal;
  uint axis = pick < share.x ? 0u : pick < share.x + share.y ? 1u : 2u;
  return normal[axis] < 0.0f ? axis + 3u : axis;
}

LAMBENT_END
#endif
