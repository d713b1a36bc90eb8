// SPDX-License-Identifier: Apache-2.0
// What a field on the processor knows of how far its lookups are off.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/ranks.h"
#include "field/correction/correction_math.h"
#include "field/correction/correction_use.h"

namespace lambent {

/// How far the lookup in a volume is off at a point.
struct CorrectionSample {
  vec3 position_ws;  ///< [m]
  vec3 normal_ws;    ///< Unit.
  int volume;        ///< Index of the volume whose lookup it is.
  float gathered;    ///< Irradiance that a gather finds; its luminance [W/m^2].
  float variance;    ///< Of `gathered`, by the rays that it is the mean of [(W/m^2)^2].
  float looked_up;   ///< Irradiance that the lookup finds; its luminance [W/m^2], > 0.
  float pick;        ///< Uniform in [0, 1): picks an axis of the normal.
};

/// A block as files hold it.
struct CorrectionBlock {
  CorrectionKey key;
  std::array<LearnedCorrection, kCellCorners> cells;
};

/// Where blocks were found that were asked for last: points beside each other ask for the same
/// ones. Good for one table while it does not change.
class RecentBlocks {
 public:
  struct Block {
    CorrectionKey key;  ///< rest 0: none.
    uint slot;
  };
  /// The place that a block shares with some others.
  Block& place_of(const CorrectionKey& key) {
    // Multiplicative hashing: the upper bits hang on all bits of the key
    const uint mixed = key.xy * 0x9E3779B1u + key.rest * 0x85EBCA6Bu;
    return places_[mixed >> (32u - kBits)];
  }

 private:
  static constexpr uint kBits = 9;  // 6 kB: room in the first-level cache
  std::array<Block, 1u << kBits> places_{};
};

/// A hash table of blocks of cells on surfaces.
///
/// Where ranks share a field, each holds what lookups read of all blocks, but what was learned of
/// its own part of the buckets alone. They call the same functions that change the table, together.
class CorrectionTable {
 public:
  /// An empty table for a field of so many probes. It takes memory once there is something to
  /// learn.
  explicit CorrectionTable(int probes);
  /// Parts an empty table among ranks, which must outlive it.
  void part_among(Ranks& ranks);

  /// Memory that a table takes for each probe of its field, once it has learned something.
  static std::uint64_t bytes_per_probe();
  /// The part of it that every rank takes where the table is parted.
  static std::uint64_t bytes_per_probe_on_all();

  /// Whether nothing has been learned.
  bool empty() const { return empty_; }
  /// See correction_at() and picked_correction(). `recent` is kept by who asks for many points;
  /// null: nothing is.
  float at(const ProbeGrid& grid, int volume, const vec3& position_ws, const vec3& normal_ws,
           CorrectionUse use, RecentBlocks* recent = nullptr) const;

  /// Adds the samples of update `number`, each to a cell of every level. Samples of blocks for
  /// which there is no room are lost. The order of samples does not matter.
  void learn(std::span<const ProbeGrid> grids, std::span<const CorrectionSample> samples,
             uint number);
  /// Forgets a part of what was learned: around each probe of the field, samples count `kept` times
  /// as much as before, 0 to 1.
  void forget(std::span<const ProbeGrid> grids, std::span<const float> kept);

  /// All blocks, as restore() takes them: those of this rank's part, which come after those of the
  /// ranks before it.
  std::vector<CorrectionBlock> blocks() const;
  /// Fills an empty table with the blocks of another, so that lookups read the same from both.
  /// Their samples count `weight` times as much for what is learned later.
  void restore(std::span<const CorrectionBlock> blocks, float weight);

  // The table's arrays, by slot, as devices hold them; empty until something is learned. Tables of
  // devices are not parted.
  using Cells = std::array<uint, kCellCorners>;
  using LearnedCells = std::array<LearnedCorrection, kCellCorners>;
  std::span<const CorrectionKey> keys() const { return keys_; }
  std::span<const LearnedCells> learned() const { return learned_; }
  std::span<const Cells> refined() const { return refined_; }

 private:
  void make_room();
  std::size_t claim(const CorrectionKey& key);
  void list_items(std::span<const ProbeGrid> grids, std::span<const CorrectionSample> samples,
                  float mean);
  void refine(std::size_t slot);
  void refine_all();
  void share_refined(uint level);
  bool has_slot(std::size_t slot) const {
    return slot >= first_slot_ && slot - first_slot_ < learned_.size();
  }
  std::vector<std::size_t> first_slots() const;

  int probes_;
  Ranks* ranks_ = &one_rank();
  std::size_t first_slot_ = 0;  // of this rank's part
  // By slot; none until something is learned
  std::vector<CorrectionKey> keys_;
  std::vector<LearnedCells> learned_;  // of this rank's part alone
  std::vector<Cells> refined_;         // encode_correction()
  // While it learns: the new samples, and by bucket the place of the first one, from 1; 0: none.
  // Of this rank's part alone
  std::vector<CorrectionItem> items_;
  std::vector<std::uint32_t> first_items_;
  bool empty_ = true;
};

}  // namespace lambent
