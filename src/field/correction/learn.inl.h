// SPDX-License-Identifier: Apache-2.0
// Adds an update's samples to a bucket of the table of corrections, in the common subset of C++ and
// GLSL. Buckets are independent of each other, and the result does not depend on the order of a
// bucket's samples.
//
// The includer provides the type
//   LearningRef  the table and the samples
// and
//   CorrectionKey fetch_key(LearningRef table, uint slot)
//   void store_key(LearningRef table, uint slot, CorrectionKey key)
//   LearnedCorrection fetch_learned(LearningRef table, uint slot, int cell)
//   void store_learned(LearningRef table, uint slot, int cell, LearnedCorrection learned)
//   CorrectionItem fetch_item(LearningRef table, uint item)

/// Whether one of the first `used` slots of a bucket holds a block.
LAMBENT_FN bool holds_block(LearningRef table, uint first, uint used, CorrectionKey key) {
  for (uint slot = first; slot < first + used; ++slot) {
    if (is_same_block(fetch_key(table, slot), key)) return true;
  }
  return false;
}

/// Assigns free slots of a bucket to new blocks of its items, and returns the number of used slots.
/// Blocks that have a slot keep it. If there are not enough slots, is_block_before() decides which
/// new blocks get one.
LAMBENT_FN uint claim_slots(LearningRef table, uint first, uint items) {
  uint used = 0u;
  while (used < kCorrectionBucket && fetch_key(table, first + used).rest != 0u) ++used;
  while (used < kCorrectionBucket) {
    CorrectionKey next = {0u, 0u};
    for (uint i = items; i != 0u;) {
      CorrectionItem item = fetch_item(table, i - 1u);
      if (is_block_before(item.key, next) && !holds_block(table, first, used, item.key)) {
        next = item.key;
      }
      i = item.next;
    }
    if (next.rest == 0u) break;
    store_key(table, first + used, next);
    ++used;
  }
  return used;
}

/// Adds the new samples of a slot's block, each of which counts as `worth`, to the sums of its
/// cells, and stores the block in the slot `into`. Returns the block's number of samples.
LAMBENT_FN float merge_block(LearningRef table, uint slot, uint into, uint items, float keep,
                             float worth) {
  CorrectionKey key = fetch_key(table, slot);
  CorrectionSum sums[kCellCorners];
  uint counts[kCellCorners];
  for (int k = 0; k < kCellCorners; ++k) {
    sums[k].gathered = 0u;
    sums[k].looked_up = 0u;
    counts[k] = 0u;
  }
  for (uint i = items; i != 0u;) {
    CorrectionItem item = fetch_item(table, i - 1u);
    if (is_same_block(item.key, key)) {
      sums[item.cell].gathered += item.sum.gathered;
      sums[item.cell].looked_up += item.sum.looked_up;
      ++counts[item.cell];
    }
    i = item.next;
  }
  float samples = 0.0f;
  for (int k = 0; k < kCellCorners; ++k) {
    LearnedCorrection cell =
        updated_correction(fetch_learned(table, slot, k), keep, sums[k], worth * float(counts[k]));
    store_learned(table, into, k, cell);
    samples += cell.samples;
  }
  store_key(table, into, key);
  return samples;
}

/// Adds the items of the list that begins at `items` (0: the list is empty), each of which counts
/// as `worth` samples, to the blocks of the bucket that begins at the slot `first`. Removes blocks
/// that have no samples left.
LAMBENT_FN void merge_bucket(LearningRef table, uint first, uint items, float keep, float worth) {
  uint used = claim_slots(table, first, items);
  uint kept = 0u;
  for (uint place = 0u; place < used; ++place) {
    if (merge_block(table, first + place, first + kept, items, keep, worth) > 0.0f) ++kept;
  }
  CorrectionKey no_key = {0u, 0u};
  LearnedCorrection nothing = {0.0f, 0.0f, 0.0f};
  for (; kept < used; ++kept) {
    store_key(table, first + kept, no_key);
    for (int k = 0; k < kCellCorners; ++k) store_learned(table, first + kept, k, nothing);
  }
}
