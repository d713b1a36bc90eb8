// SPDX-License-Identifier: Apache-2.0
#include "field/correction/correction_table.h"

#include <algorithm>
#include <cassert>

#include "core/parallel.h"
#include "core/simd.h"

namespace lambent {
namespace {

constexpr std::size_t kBucketsPerTask = 4096;

/// The table, as correction.inl.h reads it.
struct Corrections {
  const CorrectionKey* keys;
  const std::array<uint, kCellCorners>* refined;
  uint buckets;
  RecentBlocks* recent = nullptr;  // null: there is no cache
};

using CorrectionsRef = const Corrections&;

LAMBENT_FORCE_INLINE uint bucket_count(const Corrections& table) {
  return table.buckets;
}
LAMBENT_FORCE_INLINE const CorrectionKey& fetch_key(const Corrections& table, uint slot) {
  return table.keys[slot];
}
LAMBENT_FORCE_INLINE uint fetch_refined(const Corrections& table, uint slot, int cell) {
  return table.refined[slot][cell];
}

#include "field/correction/search_block.inl.h"

LAMBENT_FORCE_INLINE uint find_block(const Corrections& table, const CorrectionKey& key) {
  if (table.recent == nullptr) return search_block(table, key);
  RecentBlocks::Block& held = table.recent->place_of(key);
  if (!is_same_block(held.key, key)) held = {key, search_block(table, key)};
  return held.slot;
}

#include "field/correction/correction.inl.h"

/// The table and the samples, as learn.inl.h uses them.
struct Learning {
  CorrectionKey* keys;
  std::size_t first_slot;  // the slot of the first entry of `learned`
  std::array<LearnedCorrection, kCellCorners>* learned;
  const CorrectionItem* items;
};

using LearningRef = const Learning&;

LAMBENT_FORCE_INLINE const CorrectionKey& fetch_key(const Learning& table, uint slot) {
  return table.keys[slot];
}
LAMBENT_FORCE_INLINE void store_key(const Learning& table, uint slot, const CorrectionKey& key) {
  table.keys[slot] = key;
}
LAMBENT_FORCE_INLINE const LearnedCorrection& fetch_learned(const Learning& table, uint slot,
                                                            int cell) {
  return table.learned[slot - table.first_slot][cell];
}
LAMBENT_FORCE_INLINE void store_learned(const Learning& table, uint slot, int cell,
                                        const LearnedCorrection& learned) {
  table.learned[slot - table.first_slot][cell] = learned;
}
LAMBENT_FORCE_INLINE const CorrectionItem& fetch_item(const Learning& table, uint item) {
  return table.items[item];
}

#include "field/correction/learn.inl.h"

/// The number of samples that each sample of an update counts as. `mean` is the mean irradiance of
/// all lookups.
float worth_of(std::span<const CorrectionSample> samples, float mean) {
  double variances = 0.0, squares = 0.0;
  for (const CorrectionSample& sample : samples) {
    const CorrectionNoise noise =
        correction_noise(sample.gathered, sample.variance, sample.looked_up, mean);
    variances += noise.variances;
    squares += noise.squares;
  }
  return sample_weight({static_cast<float>(variances), static_cast<float>(squares)});
}

}  // namespace

CorrectionTable::CorrectionTable(int probes) : probes_(probes) {}

std::uint64_t CorrectionTable::bytes_per_probe() {
  constexpr std::uint64_t kSlot =
      sizeof(CorrectionKey) + kCellCorners * sizeof(LearnedCorrection) + sizeof(Cells);
  return kCorrectionBucketsPerProbe * (kCorrectionBucket * kSlot + sizeof(std::uint32_t));
}

std::uint64_t CorrectionTable::bytes_per_probe_on_all() {
  return kCorrectionBucketsPerProbe * kCorrectionBucket * (sizeof(CorrectionKey) + sizeof(Cells));
}

void CorrectionTable::part_among(Ranks& ranks) {
  assert(empty_);
  ranks_ = &ranks;
}

/// The first slot of each rank's part, and the number of all slots.
std::vector<std::size_t> CorrectionTable::first_slots() const {
  const std::size_t buckets =
      std::size_t{kCorrectionBucketsPerProbe} * static_cast<std::size_t>(probes_);
  const auto count = static_cast<std::size_t>(ranks_->count());
  std::vector<std::size_t> firsts;
  for (std::size_t r = 0; r <= count; ++r)
    firsts.push_back(r * buckets / count * kCorrectionBucket);
  return firsts;
}

void CorrectionTable::make_room() {
  const std::vector<std::size_t> firsts = first_slots();
  const auto own = static_cast<std::size_t>(ranks_->own());
  const std::size_t own_slots = firsts[own + 1] - firsts[own];
  first_slot_ = firsts[own];
  keys_.resize(firsts.back());
  refined_.resize(firsts.back());
  learned_.resize(own_slots);
  first_items_.resize(own_slots / kCorrectionBucket);
}

__attribute__((flatten)) float CorrectionTable::at(const ProbeGrid& grid, int volume,
                                                   const vec3& position_ws, const vec3& normal_ws,
                                                   CorrectionUse use, RecentBlocks* recent) const {
  assert(use != CorrectionUse::none);
  if (empty_) return 1.0f;
  const Corrections table = {keys_.data(), refined_.data(),
                             static_cast<uint>(keys_.size() / kCorrectionBucket), recent};
  const uint of = static_cast<uint>(volume);
  if (use == CorrectionUse::smooth) return correction_at(table, grid, of, position_ws, normal_ws);
  return picked_correction(table, grid, of, position_ws, normal_ws);
}

__attribute__((flatten)) void CorrectionTable::picked_at(std::span<const CorrectionPoint> points,
                                                         std::span<float> ratios) const {
  assert(points.size() == ratios.size() && points.size() <= kMostPicked);
  std::fill(ratios.begin(), ratios.end(), 1.0f);
  if (empty_) return;
  struct Picked {
    vec3 coords, pick;
    uint axis;
    CorrectionKey key;
    int cell;
    uint slot;  // the first one of the bucket, then that of the block
  };
  std::array<Picked, kMostPicked> all;
  const Corrections table = {keys_.data(), refined_.data(),
                             static_cast<uint>(keys_.size() / kCorrectionBucket)};
  // Find the bucket of each point's finest cell
  for (std::size_t i = 0; i < points.size(); ++i) {
    const CorrectionPoint& point = points[i];
    Picked& picked = all[i];
    picked.pick = correction_pick(*point.grid, point.position_ws);
    picked.axis = correction_axis(point.normal_ws * point.grid->axes, picked.pick.x);
    picked.pick = pick_along_surface(picked.pick, picked.axis);
    picked.coords = correction_coords(*point.grid, point.position_ws);
    const ivec3 cell = picked_cell(picked.coords, picked.pick);
    picked.cell = cell_of_block(cell);
    picked.key =
        correction_key(block_of_cell(cell), picked.axis, 0u, static_cast<uint>(point.volume));
    picked.slot = correction_bucket(picked.key, table.buckets);
    __builtin_prefetch(&table.keys[picked.slot]);
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    Picked& picked = all[i];
    picked.slot = slot_in_bucket(table, picked.slot, picked.key);
    if (picked.slot != kNoCorrectionBlock) __builtin_prefetch(&table.refined[picked.slot]);
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Picked& picked = all[i];
    CorrectionCell held = {1.0f, 0.0f};
    if (picked.slot != kNoCorrectionBlock) {
      held = decode_correction(fetch_refined(table, picked.slot, picked.cell));
    }
    ratios[i] =
        held.samples > 0.0f
            ? held.ratio
            : picked_from_level(table, picked.coords * (1.0f / kCorrectionGrowth), picked.pick,
                                picked.axis, static_cast<uint>(points[i].volume), 1u);
  }
}

std::size_t CorrectionTable::claim(const CorrectionKey& key) {
  const std::size_t first =
      correction_bucket(key, static_cast<uint>(keys_.size() / kCorrectionBucket));
  for (std::size_t slot = first; slot < first + kCorrectionBucket; ++slot) {
    if (is_same_block(keys_[slot], key)) return slot;
    if (keys_[slot].rest == 0) {
      keys_[slot] = key;
      return slot;
    }
  }
  return kNoCorrectionBlock;
}

/// Computes the ratios that lookups read from a block. Those of coarser levels must be computed
/// already.
void CorrectionTable::refine(std::size_t slot, RecentBlocks& recent) {
  const Corrections table = {keys_.data(), refined_.data(),
                             static_cast<uint>(keys_.size() / kCorrectionBucket), &recent};
  const CorrectionKey key = keys_[slot];
  for (int k = 0; k < kCellCorners; ++k) {
    refined_[slot][k] = refined_cell(table, key, k, learned_[slot - first_slot_][k]);
  }
}

/// Adds each sample to the lists of its blocks' buckets. `mean` is the mean irradiance of all
/// lookups.
void CorrectionTable::list_items(std::span<const ProbeGrid> grids,
                                 std::span<const CorrectionSample> samples, float mean) {
  const auto buckets = static_cast<uint>(keys_.size() / kCorrectionBucket);
  items_.clear();
  for (const CorrectionSample& sample : samples) {
    const ProbeGrid& grid = grids[sample.volume];
    const CorrectionSum sum = correction_sum(sample.gathered, sample.looked_up, mean);
    const uint axis = correction_axis(sample.normal_ws * grid.axes, sample.pick);
    vec3 coords = correction_coords(grid, sample.position_ws);
    for (uint level = 0; level < kCorrectionLevels; ++level) {
      CorrectionItem item =
          correction_item(coords, axis, level, static_cast<uint>(sample.volume), sum);
      coords *= 1.0f / kCorrectionGrowth;
      const std::size_t slot = correction_bucket(item.key, buckets);
      if (!has_slot(slot)) continue;
      std::uint32_t& first = first_items_[(slot - first_slot_) / kCorrectionBucket];
      item.next = first;
      items_.push_back(item);
      first = static_cast<std::uint32_t>(items_.size());
    }
  }
}

void CorrectionTable::learn(std::span<const ProbeGrid> grids,
                            std::span<const CorrectionSample> samples, uint number) {
  double sum_of_lookups = 0.0;
  for (const CorrectionSample& sample : samples) sum_of_lookups += sample.looked_up;
  if (!(sum_of_lookups > 0.0)) return;
  const auto mean = static_cast<float>(sum_of_lookups / static_cast<double>(samples.size()));
  if (empty_) make_room();
  empty_ = false;
  list_items(grids, samples, mean);
  const Learning learning = {keys_.data(), first_slot_, learned_.data(), items_.data()};
  const float keep = kept_corrections(number), worth = worth_of(samples, mean);
  parallel_chunks(first_items_.size(), kBucketsPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) {
      merge_bucket(learning, static_cast<uint>(first_slot_ + b * kCorrectionBucket),
                   first_items_[b], keep, worth);
      first_items_[b] = 0;
    }
  });
  gather_parts(*ranks_, std::span(keys_), first_slots());
  refine_all();
}

/// Gives every rank the refined ratios of the others for a level, which the next level reads.
void CorrectionTable::share_refined(uint level) {
  if (ranks_->count() == 1) return;
  struct Refined {
    std::uint32_t slot;
    Cells cells;
  };
  std::vector<Refined> own;
  for (std::size_t slot = first_slot_; slot < first_slot_ + learned_.size(); ++slot) {
    if (keys_[slot].rest == 0 || level_of_key(keys_[slot]) != level) continue;
    own.push_back({static_cast<std::uint32_t>(slot), refined_[slot]});
  }
  for (const Refined& block : gather_all(*ranks_, std::move(own))) {
    refined_[block.slot] = block.cells;
  }
}

/// Refines all levels, the coarsest first.
void CorrectionTable::refine_all() {
  for (int level = kCorrectionLevels - 1; level >= 0; --level) {
    parallel_chunks(learned_.size(), kBucketsPerTask, [&](std::size_t begin, std::size_t end) {
      // The cells of a block have coarser blocks in common
      RecentBlocks recent;
      for (std::size_t slot = first_slot_ + begin; slot < first_slot_ + end; ++slot) {
        const bool used = keys_[slot].rest != 0;
        if (used && level_of_key(keys_[slot]) == static_cast<uint>(level)) refine(slot, recent);
      }
    });
    share_refined(static_cast<uint>(level));
  }
}

std::vector<CorrectionBlock> CorrectionTable::blocks() const {
  std::vector<CorrectionBlock> blocks;
  for (std::size_t own = 0; own < learned_.size(); ++own) {
    const CorrectionKey& key = keys_[first_slot_ + own];
    if (key.rest != 0) blocks.push_back({key, learned_[own]});
  }
  return blocks;
}

void CorrectionTable::restore(std::span<const CorrectionBlock> blocks, float weight) {
  if (blocks.empty()) return;
  make_room();
  empty_ = false;
  for (const CorrectionBlock& block : blocks) {
    const std::size_t slot = claim(block.key);
    if (slot == kNoCorrectionBlock || !has_slot(slot)) continue;
    for (int k = 0; k < kCellCorners; ++k) {
      const LearnedCorrection& cell = block.cells[k];
      learned_[slot - first_slot_][k] = {weight * cell.gathered, weight * cell.looked_up,
                                         weight * cell.samples};
    }
  }
  refine_all();
}

void CorrectionTable::forget(std::span<const ProbeGrid> grids, std::span<const float> kept) {
  // Refining takes long, and most edits of a world that is edited continually change little light
  if (std::all_of(kept.begin(), kept.end(), [](float share) { return share >= 1.0f; })) return;
  parallel_chunks(learned_.size(), kBucketsPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t slot = first_slot_ + begin; slot < first_slot_ + end; ++slot) {
      if (keys_[slot].rest == 0) continue;
      const ProbeGrid& grid = grids[volume_of_key(keys_[slot])];
      const ProbeCell cell = probe_cell(grid, block_centre(grid, keys_[slot]));
      float least = 1.0f;
      for (int k = 0; k < kCellCorners; ++k) {
        least = min(least, kept[probe_index(grid, cell.base + cell_corner(k))]);
      }
      if (least >= 1.0f) continue;
      for (LearnedCorrection& learned : learned_[slot - first_slot_]) {
        learned = updated_correction(learned, least, {0u, 0u}, 0.0f);
      }
    }
  });
  refine_all();
}

}  // namespace lambent
