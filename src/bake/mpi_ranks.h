// SPDX-License-Identifier: Apache-2.0
// The processes of an MPI job as Ranks. This is the only place that knows of MPI.
#pragma once

#include "core/ranks.h"

namespace lambent {

/// The job that a launcher started this process in. There may be one object of this class in the
/// life of a process, used by the thread that made it. The process must end through leave() or
/// end_job(): MPI takes any other end for a crash, and ends the job.
class MpiRanks final : public Ranks {
 public:
  /// Joins the other processes. Where MPI fails, it says why on stderr and ends the job, here and
  /// below.
  MpiRanks();
  MpiRanks(const MpiRanks&) = delete;
  MpiRanks& operator=(const MpiRanks&) = delete;

  int count() const override { return count_; }
  int own() const override { return own_; }
  /// How many of the processes share this one's memory.
  int on_this_machine() const { return on_this_machine_; }
  void gather_bytes(std::span<std::byte> bytes, std::span<const std::size_t> firsts) override;

  /// Waits until all processes are done, too.
  void leave();
  /// Ends all processes at once; the launcher's exit status is `status`.
  [[noreturn]] static void end_job(int status);

 private:
  int count_ = 1, own_ = 0, on_this_machine_ = 1;
};

}  // namespace lambent
