// SPDX-License-Identifier: Apache-2.0
// The hash table of corrections of a field on the processor.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/ranks.h"
#include "field/correction/correction_math.h"
#include "field/correction/correction_use.h"

namespace lambent {

/// A sample of a correction: the irradiance at a point by a gather and by the lookup in a volume.
struct CorrectionSample {
  vec3 position_ws;  ///< [m]
  vec3 normal_ws;    ///< Unit.
  int volume;        ///< Index of the volume of the lookup.
  float gathered;    ///< Luminance of the irradiance that the gather estimates [W/m^2].
  float variance;    ///< Variance of `gathered`, estimated from its rays [(W/m^2)^2].
  float looked_up;   ///< Luminance of the irradiance that the lookup finds [W/m^2], > 0.
  float pick;        ///< Uniform in [0, 1): picks an axis of the normal.
};

/// A point at which a correction is read.
struct CorrectionPoint {
  const ProbeGrid* grid;  ///< Of the volume.
  int volume;             ///< Index of the volume of the lookup.
  vec3 position_ws;       ///< [m]
  vec3 normal_ws;         ///< Unit.
};

// The most points that picked_at() takes at once: memory answers about this many reads at a time.
inline constexpr std::size_t kMostPicked = 16;

/// A block as files store it.
struct CorrectionBlock {
  CorrectionKey key;
  std::array<LearnedCorrection, kCellCorners> cells;
};

/// A cache of the slots in which blocks were found last, since neighbouring points read the same
/// blocks. It is valid for one table, as long as the table does not change.
class RecentBlocks {
 public:
  struct Block {
    CorrectionKey key;  ///< rest 0: the entry is empty.
    uint slot;
  };
  /// The entry of a block, which it shares with some others.
  Block& place_of(const CorrectionKey& key) {
    // Multiplicative hashing: the upper bits depend on all bits of the key
    const uint mixed = key.xy * 0x9E3779B1u + key.rest * 0x85EBCA6Bu;
    return places_[mixed >> (32u - kBits)];
  }

 private:
  static constexpr uint kBits = 9;  // 6 kB, which fit into the first-level cache
  std::array<Block, 1u << kBits> places_{};
};

/// A hash table of blocks of cells on surfaces.
///
/// Where ranks share a field, each rank holds the values that lookups read from all blocks, but the
/// sums over samples of its own part of the buckets only. All ranks call the functions that change
/// the table together.
class CorrectionTable {
 public:
  /// Makes an empty table for a field of this many probes. It allocates memory with the first
  /// samples.
  explicit CorrectionTable(int probes);
  /// Divides the buckets of an empty table among ranks, which must outlive it.
  void part_among(Ranks& ranks);

  /// Memory that a table takes for each probe of its field, once it has learned something.
  static std::uint64_t bytes_per_probe();
  /// The part of bytes_per_probe() that every rank takes for all probes, where ranks share a field.
  static std::uint64_t bytes_per_probe_on_all();

  /// Whether nothing has been learned.
  bool empty() const { return empty_; }
  /// The factor that corrects the lookup in a volume at a point, see correction_at() and
  /// picked_correction(). `recent` is the caller's cache for calls with many points, or null.
  float at(const ProbeGrid& grid, int volume, const vec3& position_ws, const vec3& normal_ws,
           CorrectionUse use, RecentBlocks* recent = nullptr) const;

  /// The factors of at() for CorrectionUse::picked at several points, at most kMostPicked. Reads of
  /// one point overlap with those of the others.
  void picked_at(std::span<const CorrectionPoint> points, std::span<float> ratios) const;

  /// Adds the samples of update `number`, each to a cell of every level. Samples of blocks for
  /// which there is no room are discarded. The order of samples does not matter.
  void learn(std::span<const ProbeGrid> grids, std::span<const CorrectionSample> samples,
             uint number);
  /// Multiplies the weights of a block's samples by the smallest entry of `kept` among the eight
  /// probes around the block. `kept` has one entry per probe of the field, 0 to 1.
  void forget(std::span<const ProbeGrid> grids, std::span<const float> kept);

  /// The blocks of this rank's part of the table, as restore() takes them. The blocks of all ranks,
  /// one after the other, are those of the table.
  std::vector<CorrectionBlock> blocks() const;
  /// Fills an empty table with the blocks of another, so that lookups read the same values from
  /// both. The weights of their samples are multiplied by `weight`.
  void restore(std::span<const CorrectionBlock> blocks, float weight);

  // The table's arrays, by slot, as devices store them. They are empty until something is learned.
  // Only tables that are not divided among ranks are copied to devices.
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
  void refine(std::size_t slot, RecentBlocks& recent);
  void refine_all();
  void share_refined(uint level);
  bool has_slot(std::size_t slot) const {
    return slot >= first_slot_ && slot - first_slot_ < learned_.size();
  }
  std::vector<std::size_t> first_slots() const;

  int probes_;
  Ranks* ranks_ = &one_rank();
  std::size_t first_slot_ = 0;  // the first slot of this rank's part
  // By slot; empty until something is learned
  std::vector<CorrectionKey> keys_;
  std::vector<LearnedCells> learned_;  // for this rank's part only
  std::vector<Cells> refined_;         // encode_correction()
  // Used by learn(), for this rank's part only: the new samples, and for each bucket the place of
  // its first one, from 1; 0: none
  std::vector<CorrectionItem> items_;
  std::vector<std::uint32_t> first_items_;
  bool empty_ = true;
};

}  // namespace lambent
