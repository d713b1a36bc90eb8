// SPDX-License-Identifier: Apache-2.0
// Reads of the table of corrections, in the common subset of C++ and GLSL. The includer provides
// the type
//   CorrectionsRef  the table
// and
//   uint find_block(CorrectionsRef table, CorrectionKey key)
//       search_block() of search_block.inl.h
//   uint fetch_refined(CorrectionsRef table, uint slot, int cell)
//       encode_correction() of a cell's refined ratio and its number of samples

/// The term of a cell in a weighted mean: its ratio times its weight, and the weight.
LAMBENT_FN vec2 weighed_cell(CorrectionsRef table, uint slot, int cell, float weight) {
  CorrectionCell held = decode_correction(fetch_refined(table, slot, cell));
  float samples = weight * (held.samples + kLeastCorrectionSamples);
  return vec2(samples * held.ratio, samples);
}

/// The sum of the terms (weighed_cell()) of the eight cells around a point, which is given in cells
/// of a level. It is 0 where the table has none of them.
LAMBENT_FN vec2 interpolated_cells(CorrectionsRef table, vec3 coords, uint axis, uint level,
                                   uint volume) {
  vec3 base = floor(coords - vec3(0.5f));
  vec3 fraction = coords - vec3(0.5f) - base;
  ivec3 lowest = ivec3(base);
  ivec3 block = ivec3(lowest.x >> 1, lowest.y >> 1, lowest.z >> 1);
  // Along a direction in which the lowest cell is the second of its block, the others are in the
  // next block
  int next = cell_of_block(lowest);
  int within = (kCellCorners - 1) & ~next;
  vec2 sum = vec2(0.0f);
  // Visit the blocks, where `b` has the directions in which a block is the next one, and of each
  // block the cells `b | rest`. (s - m) & m is the subset of the bits of m that follows the subset
  // s, and 0 after the last one
  int b = 0;
  do {
    uint slot = find_block(table, correction_key(block + cell_corner(b), axis, level, volume));
    if (slot != kNoCorrectionBlock) {
      int rest = 0;
      do {
        int k = b | rest;
        sum += weighed_cell(table, slot, k ^ next, trilinear_weight(fraction, cell_corner(k)));
        rest = (rest - within) & within;
      } while (rest != 0);
    }
    b = (b - next) & next;
  } while (b != 0);
  return sum;
}

/// The factor that corrects the lookup in a volume at a point with a normal; 1 where none is known.
/// It varies smoothly: the fewer samples a level has around the point, the larger is the weight of
/// the coarser ones.
LAMBENT_FN float correction_at(CorrectionsRef table, ProbeGrid grid, uint volume, vec3 position_ws,
                               vec3 normal_ws) {
  vec3 normal = normal_ws * grid.axes;
  vec3 share = normal * normal;
  vec3 coords = correction_coords(grid, position_ws);
  float ratio = 0.0f;
  float left = 1.0f;
  float last = 1.0f;
  for (uint level = 0u; level < uint(kCorrectionLevels) && left > kSmoothRest; ++level) {
    vec2 sum = vec2(0.0f);
    for (int a = 0; a < 3; ++a) {
      if (share[a] < kMinAxisShare) continue;
      uint axis = normal[a] < 0.0f ? uint(a) + 3u : uint(a);
      sum += share[a] * interpolated_cells(table, coords, axis, level, volume);
    }
    coords *= 1.0f / kCorrectionGrowth;
    if (!(sum.y > 0.0f)) continue;
    last = sum.x / sum.y;
    float own = left * sum.y / (sum.y + kSmoothPrior);
    ratio += own * last;
    left -= own;
  }
  return ratio + left * last;
}

/// The ratio of the cell that `pick` picks around a point, of the finest of the levels from `first`
/// on that has samples there. `coords` are in cells of level `first`.
LAMBENT_FN float picked_from_level(CorrectionsRef table, vec3 coords, vec3 pick, uint axis,
                                   uint volume, uint first) {
  for (uint level = first; level < uint(kCorrectionLevels); ++level) {
    ivec3 cell = picked_cell(coords, pick);
    uint slot = find_block(table, correction_key(block_of_cell(cell), axis, level, volume));
    if (slot != kNoCorrectionBlock) {
      CorrectionCell held = decode_correction(fetch_refined(table, slot, cell_of_block(cell)));
      if (held.samples > 0.0f) return held.ratio;
    }
    coords *= 1.0f / kCorrectionGrowth;
  }
  return 1.0f;
}

/// Like correction_at(), but reads a single cell, which a hash of the position picks. For many
/// lookups of which only the mean matters. Its expectation is about the same.
LAMBENT_FN float picked_correction(CorrectionsRef table, ProbeGrid grid, uint volume,
                                   vec3 position_ws, vec3 normal_ws) {
  vec3 pick = correction_pick(grid, position_ws);
  uint axis = correction_axis(normal_ws * grid.axes, pick.x);
  return picked_from_level(table, correction_coords(grid, position_ws),
                           pick_along_surface(pick, axis), axis, volume, 0u);
}

/// The ratio of the level above `level` at the centre of one of its cells.
LAMBENT_FN float coarser_correction(CorrectionsRef table, ivec3 cell, uint axis, uint level,
                                    uint volume) {
  vec3 coords = coarser_coords(cell);
  for (uint above = level + 1u; above < uint(kCorrectionLevels); ++above) {
    vec2 sum = interpolated_cells(table, coords, axis, above, volume);
    if (sum.y > 0.0f) return sum.x / sum.y;
    coords *= 1.0f / kCorrectionGrowth;
  }
  return 1.0f;
}

/// The value that lookups read from a cell of a block. The cell has learned `own`. The cells of
/// coarser levels must be refined already.
LAMBENT_FN uint refined_cell(CorrectionsRef table, CorrectionKey key, int cell,
                             LearnedCorrection own) {
  float coarser = coarser_correction(table, 2 * block_of_key(key) + cell_corner(cell),
                                     axis_of_key(key), level_of_key(key), volume_of_key(key));
  return encode_correction(refined_correction(own, coarser));
}
