// SPDX-License-Identifier: Apache-2.0
// Corrections of lookups: on small cells of the surfaces, the ratio of the irradiance that a gather
// (rays over the hemisphere of a point) estimates to the irradiance that the lookup interpolates.
//
// Probes stand in the air, and fewer of their rays are blocked than those of a surface in a nook.
// There the lookup is off by a factor that depends on the place and hardly changes from update to
// update, so that a few gathers in each update suffice to estimate it. docs/math.md derives the
// estimator.
#ifndef LAMBENT_FIELD_CORRECTION_CORRECTION_MATH_H
#define LAMBENT_FIELD_CORRECTION_CORRECTION_MATH_H

#include "field/probes/probe_grid.h"
#include "shared/place_hash.h"

LAMBENT_BEGIN

// The edge of the finest cells is the smallest spacing of the volume's probes, divided by
// kCorrectionCells. In each coarser level it is kCorrectionGrowth times as long. The finest cells
// resolve detail that a lookup blurs, and the coarsest are about a spacing wide.
const float kCorrectionCells = 8.0f;
const float kCorrectionGrowth = 3.0f;
const int kCorrectionLevels = 3;

// A cell's ratio is computed as if it had this many more samples, all with the ratio of the next
// coarser level. Four leave an 8x8 RMSE of 0.106 in the hotel room, and two leave 0.097; fewer make
// lookups noisier.
const float kCorrectionPrior = 2.0f;

// Where lookups are displayed, a level is blended with the coarser ones as if these were
// kSmoothPrior samples, so that single cells do not stand out. Levels of which the weight would be
// less than kSmoothRest are not read.
const float kSmoothPrior = 8.0f;
const float kSmoothRest = 0.05f;

// The largest ratio, and the inverse of the smallest. Lookups are further off only where there is
// hardly any light.
const float kMaxCorrection = 4.0f;

// The weight of cells of an axis is the square of the normal's component along it. Axes whose
// weight is below this are left out.
const float kMinAxisShare = 0.04f;

/// The key of a block of 2 x 2 x 2 cells of one level in the hash table.
struct CorrectionKey {
  uint xy;    ///< The block's x and y coordinates, 16 bits each.
  uint rest;  ///< The block's z coordinate, axis, level and volume; 0: the key of no block.
};

// The number of directions, along the axes and against them, that surfaces may face.
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

/// The key of a block. `axis` is the axis that surfaces in the block face along, 0 to 2, or 3 to 5
/// where they face against it. Coordinates that differ by a multiple of 65,536 blocks have the same
/// key.
LAMBENT_FN CorrectionKey correction_key(ivec3 block, uint axis, uint level, uint volume) {
  const uint mask = (1u << kCorrectionKeyBits) - 1u;
  CorrectionKey key = {(uint(block.x) & mask) | (uint(block.y) << kCorrectionKeyBits),
                       (uint(block.z) & mask) | (axis << kCorrectionAxisShift) |
                           (level << kCorrectionLevelShift) | (volume << kCorrectionVolumeShift) |
                           kCorrectionKeyUsed};
  return key;
}

/// The coordinates of a key's block: of all coordinates with this key, those that are nearest to 0.
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

/// Whether a key is that of a block in a field of this many volumes.
LAMBENT_FN bool is_block_key(CorrectionKey key, uint volumes) {
  return (key.rest & kCorrectionKeyUsed) != 0u && axis_of_key(key) < kCorrectionAxes &&
         level_of_key(key) < uint(kCorrectionLevels) && volume_of_key(key) < volumes;
}

LAMBENT_FN bool is_same_block(CorrectionKey a, CorrectionKey b) {
  return a.rest == b.rest && a.xy == b.xy;
}

/// Whether a new block has priority over another for the last slot of a bucket. Blocks of coarser
/// levels have priority over those of finer levels, and any block over the key of no block.
LAMBENT_FN bool is_block_before(CorrectionKey a, CorrectionKey b) {
  return a.rest > b.rest || (a.rest == b.rest && a.xy > b.xy);
}

// The number of slots of a bucket of the hash table: eight keys fill a cache line.
const uint kCorrectionBucket = 8u;
const uint kNoCorrectionBlock = 0xFFFFFFFFu;

// Buckets per probe, which have room for 32 blocks. A wall through a probe's cell takes about
// twenty on each side, and not all probes stand at walls.
const uint kCorrectionBucketsPerProbe = 4u;

/// The first slot of a block's bucket.
LAMBENT_FN uint correction_bucket(CorrectionKey key, uint buckets) {
  return kCorrectionBucket * (hash_pcg3d(uvec3(key.xy, key.rest, 0u)).x % buckets);
}

// The bound of cell coordinates, so that they can be converted to integers in any scene.
const float kMaxCorrectionCoord = 1073741824.0f;

/// The coordinates of a point in cells of the finest level. Cells of each coarser level are
/// kCorrectionGrowth times as long.
LAMBENT_FN vec3 correction_coords(ProbeGrid grid, vec3 position_ws) {
  vec3 coords = (position_ws * grid.axes) * (kCorrectionCells / smallest_spacing(grid));
  return clamp(coords, vec3(-kMaxCorrectionCoord), vec3(kMaxCorrectionCoord));
}

/// A random point of the unit cube that belongs to the part of a finest cell around a point. It
/// picks a cell for lookups of which only the mean matters.
LAMBENT_FN vec3 correction_pick(ProbeGrid grid, vec3 position_ws) {
  return hash_of_place(correction_coords(grid, position_ws));
}

/// `pick` that stays in the point's layer of cells along the axis (correction_axis()) which the
/// surface faces: unless the surface is slanted, the next layers are in the air or in the wall, and
/// have learned nothing.
LAMBENT_FN vec3 pick_along_surface(vec3 pick, uint axis) {
  pick[axis % 3u] = 0.5f;
  return pick;
}

/// The cell that `pick` picks around a point, which is given in cells of the same level.
LAMBENT_FN ivec3 picked_cell(vec3 coords, vec3 pick) {
  return ivec3(floor(coords + pick - vec3(0.5f)));
}

/// The block of a cell.
LAMBENT_FN ivec3 block_of_cell(ivec3 cell) {
  return ivec3(cell.x >> 1, cell.y >> 1, cell.z >> 1);
}

/// The centre of a cell, in cells of the next coarser level.
LAMBENT_FN vec3 coarser_coords(ivec3 cell) {
  return (vec3(cell) + vec3(0.5f)) / kCorrectionGrowth;
}

/// The centre of a key's block.
LAMBENT_FN vec3 block_centre(ProbeGrid grid, CorrectionKey key) {
  vec3 coords = 2.0f * vec3(block_of_key(key)) + vec3(1.0f);
  for (uint level = level_of_key(key); level > 0u; --level) coords *= kCorrectionGrowth;
  return grid.axes * (coords * (smallest_spacing(grid) / kCorrectionCells));
}

/// Where a cell is within its block, as the bits of cell_corner().
LAMBENT_FN int cell_of_block(ivec3 cell) {
  return (cell.x & 1) | ((cell.y & 1) << 1) | ((cell.z & 1) << 2);
}

/// A cell's ratio, and the number of samples that it was computed from.
struct CorrectionCell {
  float ratio;    ///< 1 / kMaxCorrection to kMaxCorrection.
  float samples;  ///< LearnedCorrection::samples, below 256.
};

// Both numbers are stored as fixed-point numbers of 16 bits.
const float kCorrectionRatioSteps = 16383.0f;
const float kCorrectionSampleSteps = 256.0f;
const float kMaxCorrectionSamples = 255.0f;

/// A cell as one word. The upper 16 bits have the number of samples, rounded down, so that a cell
/// that gets no new samples is forgotten eventually.
LAMBENT_FN uint encode_correction(CorrectionCell cell) {
  return uint(min(cell.ratio, kMaxCorrection) * kCorrectionRatioSteps + 0.5f) |
         (uint(min(cell.samples, kMaxCorrectionSamples) * kCorrectionSampleSteps) << 16u);
}

LAMBENT_FN CorrectionCell decode_correction(uint word) {
  CorrectionCell cell = {float(word & 0xFFFFu) * (1.0f / kCorrectionRatioSteps),
                         float(word >> 16u) * (1.0f / kCorrectionSampleSteps)};
  return cell;
}

// The weight of a cell in an interpolation is its number of samples plus this. The number is small,
// because a cell beside a surface, which has no samples, must have hardly any weight.
const float kLeastCorrectionSamples = 1.0f / 64.0f;

// New samples of a cell are summed as integers, so that their order does not matter. This many
// steps are 1; there is room for 2,000 of the brightest samples of a cell in an update.
const float kCorrectionSumSteps = 8192.0f;

// The weight of a sample is in proportion to the irradiance that the lookup finds, since the ratio
// of means is less noisy than the mean of ratios, and bright places matter more. It does not grow
// beyond this many times the mean of all lookups.
const float kBrightestLookup = 8.0f;

// Gathered irradiance is clamped to this many times the mean. Larger values are fireflies; within a
// lampshade irradiance is hundreds of times the mean, and much of a room's light comes from there.
const float kBrightestGather = 256.0f;

// A sample counts as one sample where the mean variance of gathers, divided by the square of the
// larger of the irradiance that they find and that of lookups, is this, and as a smaller number
// where that is larger. kSmoothPrior then stands for a standard deviation of 11 % between cells and
// the level above them. Rooms with large lamps have this variance, and those with small bright
// places ten times it.
const float kTypicalNoise = 0.1f;

// The smallest number that a sample counts as, so that a cell's number of samples does not round to
// 0.
const float kLeastWorth = 1.0f / 32.0f;

/// Sums over the samples of an update: of the variances of their gathers, and of the squares of
/// what their gathers or lookups find, whichever is more. Within a lampshade a gather finds
/// hundreds of times as much as a lookup: over the lookup's square alone, the variances of a few
/// such gathers would outweigh those of all others.
struct CorrectionNoise {
  float variances;
  float squares;
};

/// The factor by which a sample's irradiances are multiplied before samples are summed. `mean` is
/// the mean irradiance of all lookups, > 0.
LAMBENT_FN float correction_scale(float looked_up, float mean) {
  return 1.0f / max(mean, looked_up * (1.0f / kBrightestLookup));
}

/// The terms of one sample in the sums of CorrectionNoise, from what its gather finds and the
/// variance of that.
LAMBENT_FN CorrectionNoise correction_noise(float gathered, float variance, float looked_up,
                                            float mean) {
  float scale = correction_scale(looked_up, mean);
  float level = max(looked_up * scale, min(gathered * scale, kBrightestGather));
  CorrectionNoise noise = {min(variance * (scale * scale), kBrightestGather * kBrightestGather),
                           level * level};
  return noise;
}

/// The number of samples of typical noise that each sample of an update counts as, at most 1.
LAMBENT_FN float sample_weight(CorrectionNoise noise) {
  float typical = kTypicalNoise * noise.squares;
  return noise.variances > typical ? max(typical / noise.variances, kLeastWorth) : 1.0f;
}

/// A sample, or a sum of samples: irradiances in fixed-point numbers of kCorrectionSumSteps.
struct CorrectionSum {
  uint gathered;
  uint looked_up;
};

/// The sample at a point where a gather and a lookup find these irradiances. `mean` is the mean
/// irradiance of all lookups, > 0.
LAMBENT_FN CorrectionSum correction_sum(float gathered, float looked_up, float mean) {
  float steps = kCorrectionSumSteps * correction_scale(looked_up, mean);
  CorrectionSum sum = {uint(min(gathered * steps, kBrightestGather * kCorrectionSumSteps) + 0.5f),
                       uint(looked_up * steps + 0.5f)};
  return sum;
}

/// A sample of one cell, in the linked list of the samples for blocks of one bucket.
struct CorrectionItem {
  CorrectionKey key;  ///< The key of the cell's block; rest 0: the item is empty.
  CorrectionSum sum;
  uint cell;  ///< Index of the cell within the block.
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

/// The sums over the samples of a cell. Every update multiplies the weights of older samples by the
/// share that it keeps.
struct LearnedCorrection {
  float gathered;   ///< Weighted sum of CorrectionSum::gathered.
  float looked_up;  ///< Weighted sum of CorrectionSum::looked_up.
  float samples;    ///< Weighted number of samples, each counted as sample_weight().
};

// A cell with fewer samples than this is reset.
const float kForgottenSamples = 1.0f / 64.0f;

/// A cell after an update: its sums are multiplied by `keep`, and then the new samples are added.
/// `sum` is their sum, and `samples` the number that they count as.
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

// Where a cell's lookups find less than 1 / kTrustedLookup of the mean of all lookups, its samples
// count less, in proportion to what they find. Otherwise a high ratio in a dark place would also
// multiply light that leaks into it.
const float kTrustedLookup = 4.0f;

/// The value that lookups read from a cell, from its sums and the ratio of the next coarser level
/// at its centre.
LAMBENT_FN CorrectionCell refined_correction(LearnedCorrection own, float coarser) {
  float ratio = own.looked_up > 0.0f ? own.gathered / own.looked_up : coarser;
  float trusted = min(own.samples, kTrustedLookup * own.looked_up);
  float refined = (trusted * min(ratio, kMaxCorrection) + kCorrectionPrior * coarser) /
                  (trusted + kCorrectionPrior);
  CorrectionCell cell = {clamp(refined, 1.0f / kMaxCorrection, kMaxCorrection), own.samples};
  return cell;
}

// From the update of this number on, all updates keep the same share of older samples.
const float kCorrectionWindow = 256.0f;

/// The factor by which update `number` (>= 1) multiplies older samples. It makes the weight of a
/// sample proportional to the number of its update, since the first ones gather light that is not
/// corrected yet.
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
