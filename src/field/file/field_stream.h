// SPDX-License-Identifier: Apache-2.0
// Writing of field files in parts, so that the whole file need not fit into memory.
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
  /// `begin` is the file's current position, at which the field begins. `file` must outlive this
  /// object.
  FieldStream(AtomicFile& file, std::uint64_t begin) : file_(file), begin_(begin) {}

  /// Writes everything but the blocks of corrections. `corrections` is the number of blocks that
  /// will follow; those of `field` are ignored.
  Expected<void> write_front(const FieldFile& field, std::uint32_t corrections);
  Expected<void> write(std::span<const CorrectionBlock> blocks);
  /// Writes the size and the checksum. The file's position is unspecified afterwards.
  Expected<void> finish();

 private:
  AtomicFile& file_;
  std::uint64_t begin_;
  std::uint32_t checksum_ = 0;
};

/// Writes the file of a field that ranks share. Rank 0 opens the file, writes the bytes `before`,
/// then the field, and commits the file. All ranks must call the function together; on the others,
/// `field` is empty. Fails on all ranks where rank 0 cannot write.
Expected<void> write_shared_field(const std::string& path, std::span<const std::byte> before,
                                  const FieldFile& field, const CorrectionTable& corrections,
                                  Ranks& ranks);

}  // namespace lambent
