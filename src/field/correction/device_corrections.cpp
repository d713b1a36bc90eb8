// SPDX-License-Identifier: Apache-2.0
#include "field/correction/device_corrections.h"

#include <algorithm>
#include <vector>

#include "shaders/correction_items_comp.h"
#include "shaders/correction_mean_comp.h"
#include "shaders/forget_corrections_comp.h"
#include "shaders/merge_corrections_comp.h"
#include "shaders/refine_corrections_comp.h"
#include "vulkan/device.h"
#include "vulkan/device_memory.h"

namespace lambent {
namespace {

using Cells = CorrectionTable::Cells;
using LearnedCells = CorrectionTable::LearnedCells;

static_assert(sizeof(CorrectionKey) == 8 && sizeof(CorrectionItem) == 24);
static_assert(sizeof(LearnedCells) == kCellCorners * sizeof(LearnedCorrection));

/// Runs a kernel with `count` invocations, in rows of kCorrectionRow.
template <class Arguments>
void run_in_rows(vulkan::Recorder& to, const vulkan::Kernel& kernel, const Arguments& arguments,
                 std::uint32_t count) {
  to.run(kernel, arguments, std::min(count, kCorrectionRow),
         (count + kCorrectionRow - 1) / kCorrectionRow);
  to.barrier();
}

}  // namespace

CorrectionKernels::CorrectionKernels(const vulkan::Device& device)
    : mean(device, shaders::correction_mean_comp(), "correction_mean"),
      items(device, shaders::correction_items_comp(), "correction_items"),
      merge(device, shaders::merge_corrections_comp(), "merge_corrections"),
      refine(device, shaders::refine_corrections_comp(), "refine_corrections"),
      forget(device, shaders::forget_corrections_comp(), "forget_corrections") {}

DeviceCorrections::DeviceCorrections(const vulkan::Device& device, int probes)
    : device_(device),
      kernels_(device.kept<CorrectionKernels>()),
      probes_(probes),
      buckets_(kCorrectionBucketsPerProbe * static_cast<uint>(probes)) {}

CorrectionArrays DeviceCorrections::arrays(CorrectionUse use) const {
  if (empty() || use == CorrectionUse::none) return {};
  return {
      {keys_.address()}, {refined_.address()}, buckets_, use == CorrectionUse::picked ? 1u : 0u};
}

std::size_t DeviceCorrections::bytes() const {
  return bytes_of({&keys_, &learned_, &refined_, &items_, &first_items_, &summary_});
}

void DeviceCorrections::make_room() {
  lambent::reserve<CorrectionKey>(device_, slots(), "keys of corrections", keys_);
  lambent::reserve<LearnedCells>(device_, slots(), "learned corrections", learned_);
  lambent::reserve<Cells>(device_, slots(), "corrections", refined_);
  lambent::reserve<uint>(device_, buckets_, "lists of samples", first_items_);
  lambent::reserve<float>(device_, kCorrectionSummary, "summary of samples", summary_);
  device_.run([&](vulkan::Recorder& to) {
    for (const vulkan::Buffer* buffer : {&keys_, &learned_, &refined_, &first_items_}) {
      to.fill(*buffer, 0u);
    }
  });
}

void DeviceCorrections::reserve(std::size_t samples) {
  if (empty()) make_room();
  lambent::reserve<CorrectionItem>(device_, kCorrectionLevels * samples, "samples of cells",
                                   items_);
}

void DeviceCorrections::write(const CorrectionTable& table) {
  if (table.empty()) return;
  make_room();
  vulkan::write(device_, table.keys(), keys_);
  vulkan::write(device_, table.learned(), learned_);
  vulkan::write(device_, table.refined(), refined_);
}

CorrectionTable DeviceCorrections::read() const {
  CorrectionTable table(probes_);
  if (empty()) return table;
  const auto keys = vulkan::download<CorrectionKey>(device_, keys_);
  const auto learned = vulkan::download<LearnedCells>(device_, learned_);
  std::vector<CorrectionBlock> blocks;
  for (uint slot = 0; slot < slots(); ++slot) {
    if (keys[slot].rest != 0) blocks.push_back({keys[slot], learned[slot]});
  }
  table.restore(blocks, 1.0f);
  return table;
}

void DeviceCorrections::record_learn(vulkan::Recorder& to, GridArray grids,
                                     CorrectionSampleArray samples, std::uint32_t count,
                                     uint number) const {
  const FloatArray summary{summary_.address()};
  const CorrectionItemArray items{items_.address()};
  const UintArray first_items{first_items_.address()};
  to.run(kernels_.mean, CorrectionMeanArguments{samples, summary, count, 0u}, 1);
  to.barrier();
  run_in_rows(
      to, kernels_.items,
      CorrectionItemsArguments{samples, summary, grids, items, first_items, buckets_, count},
      count);
  run_in_rows(to, kernels_.merge,
              MergeCorrectionsArguments{{keys_.address()},
                                        {learned_.address()},
                                        summary,
                                        items,
                                        first_items,
                                        buckets_,
                                        kept_corrections(number)},
              buckets_);
  record_refine(to);
}

/// Refines all levels, the coarsest first.
void DeviceCorrections::record_refine(vulkan::Recorder& to) const {
  for (int level = kCorrectionLevels - 1; level >= 0; --level) {
    run_in_rows(
        to, kernels_.refine,
        RefineCorrectionsArguments{
            arrays(CorrectionUse::smooth), {learned_.address()}, static_cast<uint>(level), 0u},
        slots() * kCellCorners);
  }
}

void DeviceCorrections::record_forget(vulkan::Recorder& to, GridArray grids,
                                      FloatArray kept) const {
  if (empty()) return;
  run_in_rows(
      to, kernels_.forget,
      ForgetCorrectionsArguments{{keys_.address()}, {learned_.address()}, grids, kept, slots(), 0u},
      slots());
  record_refine(to);
}

}  // namespace lambent
