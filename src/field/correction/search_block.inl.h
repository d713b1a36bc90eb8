// SPDX-License-Identifier: Apache-2.0
// The search for a block in the table of corrections, in the common subset of C++ and GLSL. The
// includer provides the type
//   CorrectionsRef  the table
// and
//   uint bucket_count(CorrectionsRef table)
//   CorrectionKey fetch_key(CorrectionsRef table, uint slot)

/// The slot of a block in the bucket that begins at the slot `first`; kNoCorrectionBlock where the
/// bucket does not have the block.
LAMBENT_FN uint slot_in_bucket(CorrectionsRef table, uint first, CorrectionKey key) {
  for (uint slot = first; slot < first + kCorrectionBucket; ++slot) {
    CorrectionKey held = fetch_key(table, slot);
    if (is_same_block(held, key)) return slot;
    if (held.rest == 0u) break;
  }
  return kNoCorrectionBlock;
}

/// The slot of a block; kNoCorrectionBlock where the table does not have the block.
LAMBENT_FN uint search_block(CorrectionsRef table, CorrectionKey key) {
  return slot_in_bucket(table, correction_bucket(key, bucket_count(table)), key);
}
