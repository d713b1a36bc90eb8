// SPDX-License-Identifier: Apache-2.0
// Field files that are written part after part, without ever being in memory as a whole.
#pragma once

#include <cstdint>
#include <span>

#include "core/files/atomic_file.h"
#include "field/file/field_file.h"

namespace lambent {

/// Writes what encode_field() encodes, in this order: write_front(), all blocks of corrections,
/// finish().
class FieldStream {
 public:
  /// Begins at the file's current position, `begin`. `file` must outlive it.
  FieldStream(AtomicFile& file, std::uint64_t begin) : file_(file), begin_(begin) {}

  /// Writes all but the corrections, of which there will be so many; those of `field` are not
  /// looked at.
  Expected<void> write_front(const FieldFile& field, std::uint32_t corrections);
  Expected<void> write(std::span<const CorrectionBlock> blocks);
  /// Leaves the file's position somewhere.
  Expected<void> finish();

 private:
  AtomicFile& file_;
  std::uint64_t begin_;
  std::uint32_t checksum_ = 0;
};

/// What a field of ranks writes: rank 0 opens the file and writes `before`, the field follows, and
/// the file comes to be. All ranks call it together; on the others `field` holds nothing. Fails on
/// all of them where rank 0 cannot write.
Expected<void> write_shared_field(const std::string& path, std::span<const std::byte> before,
                                  const FieldFile& field, const CorrectionTable& corrections,
                                  Ranks& ranks);

}  // namespace lambent
