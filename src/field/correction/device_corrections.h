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

/// The kernels of the table. The device owns one set (Device::kept).
struct CorrectionKernels {
  explicit CorrectionKernels(const vulkan::Device& device);
  vulkan::Kernel mean, items, merge, refine, forget;
};

class DeviceCorrections {
 public:
  /// Makes an empty table for a field of this many probes. It allocates memory when it is first
  /// written or reserved. The device must outlive it.
  DeviceCorrections(const vulkan::Device& device, int probes);

  /// The arrays that lookups read; none while the table is empty.
  CorrectionArrays arrays(CorrectionUse use) const;
  bool empty() const { return keys_.empty(); }
  std::size_t bytes() const;

  // Transfers. None may be called while the device uses the table.

  /// Uploads a table of the processor.
  void write(const CorrectionTable& table);
  /// Reads the table back.
  CorrectionTable read() const;
  /// Reserves memory to learn from this many samples. Must be called before that is recorded.
  void reserve(std::size_t samples);

  // Passes. What they read must be visible before them, and what they write is visible after them.

  /// Records CorrectionTable::learn() of `count` samples, at most as many as reserve() was given.
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
  // By slot; empty until something is learned
  vulkan::Buffer keys_, learned_, refined_;
  vulkan::Buffer items_, first_items_, summary_;  // used while the table learns
};

}  // namespace lambent
