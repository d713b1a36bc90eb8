// SPDX-License-Identifier: Apache-2.0
// The table of corrections on a device: the twin of CorrectionTable.
#pragma once

#include <cstddef>
#include <cstdint>

#include "field/correction/correction_records.h"
#include "field/correction/correction_table.h"
#include "vulkan/buffer.h"
#include "vulkan/kernel.h"
#include "vulkan/recorder.h"

namespace lambent {

/// Kept by the device (Device::kept).
struct CorrectionKernels {
  explicit CorrectionKernels(const vulkan::Device& device);
  vulkan::Kernel mean, items, merge, refine, forget;
};

class DeviceCorrections {
 public:
  /// An empty table for a field of so many probes. It takes memory once there is something to know.
  /// The device must outlive it.
  DeviceCorrections(const vulkan::Device& device, int probes);

  /// What lookups read; none while the table is empty.
  CorrectionArrays arrays(CorrectionUse use) const;
  bool empty() const { return keys_.empty(); }
  std::size_t bytes() const;

  // Transfers. None may be called while the device uses the table.

  /// Takes over what the processor's table knows.
  void write(const CorrectionTable& table);
  /// The table as one of the processor.
  CorrectionTable read() const;
  /// Makes room for what `samples` samples teach. Must be called before that is recorded.
  void reserve(std::size_t samples);

  // Passes. What they read must be visible before them, and what they write is visible after them.

  /// Records CorrectionTable::learn() of as many samples as there is room for.
  void record_learn(vulkan::Recorder& to, GridArray grids, CorrectionSampleArray samples,
                    std::uint32_t count, uint number) const;
  /// Records CorrectionTable::forget(). `kept` has an entry per probe.
  void record_forget(vulkan::Recorder& to, GridArray grids, FloatArray kept) const;

 private:
  void make_room();
  uint slots() const { return buckets_ * kCorrectionBucket; }
  void record_refine(vulkan::Recorder& to) const;

  const vulkan::Device& device_;
  const CorrectionKernels& kernels_;
  int probes_;
  uint buckets_;
  // By slot; none until something is known
  vulkan::Buffer keys_, learned_, refined_;
  vulkan::Buffer items_, first_items_, summary_;  // while it learns
};

}  // namespace lambent
