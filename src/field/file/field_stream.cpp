// SPDX-License-Identifier: Apache-2.0
#include "field/file/field_stream.h"

#include <algorithm>
#include <optional>
#include <vector>

namespace lambent {
namespace {

// The number of blocks that ranks exchange at a time.
constexpr std::size_t kBlocksOfPart = 1 << 14;

/// Calls body(blocks) with the blocks of all ranks, in the order of their slots, part after part.
template <class Body>
void for_blocks_of_ranks(std::span<const CorrectionBlock> own,
                         std::span<const std::uint64_t> counts, Ranks& ranks, Body body) {
  const auto count = static_cast<std::size_t>(ranks.count());
  const auto own_rank = static_cast<std::size_t>(ranks.own());
  std::vector<CorrectionBlock> part;
  for (std::size_t rank = 0; rank < count; ++rank) {
    for (std::size_t first = 0; first < counts[rank]; first += kBlocksOfPart) {
      part.resize(std::min<std::size_t>(kBlocksOfPart, counts[rank] - first));
      if (rank == own_rank) std::copy_n(own.begin() + first, part.size(), part.begin());
      std::vector<std::size_t> firsts(count + 1, 0);
      std::fill(firsts.begin() + static_cast<std::ptrdiff_t>(rank) + 1, firsts.end(), part.size());
      gather_parts(ranks, std::span(part), firsts);
      body(std::span<const CorrectionBlock>(part));
    }
  }
}

Expected<void> write_beginning(AtomicFile& file, std::span<const std::byte> before,
                               const FieldFile& field, std::uint64_t corrections,
                               FieldStream& stream) {
  if (const auto written = file.write(before); !written) return written;
  return stream.write_front(field, static_cast<std::uint32_t>(corrections));
}

}  // namespace

Expected<void> write_shared_field(const std::string& path, std::span<const std::byte> before,
                                  const FieldFile& field, const CorrectionTable& corrections,
                                  Ranks& ranks) {
  const std::vector<CorrectionBlock> own = corrections.blocks();
  const std::vector<std::uint64_t> counts = gather_each<std::uint64_t>(ranks, own.size());
  Expected<void> result;
  std::optional<AtomicFile> file;
  std::optional<FieldStream> stream;
  if (ranks.own() == 0) {
    if (Expected<AtomicFile> opened = AtomicFile::open(path)) {
      file.emplace(std::move(*opened));
      stream.emplace(*file, before.size());
      std::uint64_t all = 0;
      for (const std::uint64_t count : counts) all += count;
      result = write_beginning(*file, before, field, all, *stream);
    } else {
      result = tl::unexpected(opened.error());
    }
  }
  // If rank 0 has failed, the others do not know yet, and still send their blocks
  for_blocks_of_ranks(own, counts, ranks, [&](std::span<const CorrectionBlock> blocks) {
    if (stream && result) result = stream->write(blocks);
  });
  if (stream && result) result = stream->finish();
  if (file && result) result = file->commit();
  const std::vector<std::uint8_t> written = gather_each<std::uint8_t>(ranks, result ? 1 : 0);
  if (result && written.front() == 0) {
    return fail(path, "", "rank 0 could not write it", Error::Kind::failed);
  }
  return result;
}

}  // namespace lambent
