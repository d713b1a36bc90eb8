// SPDX-License-Identifier: Apache-2.0
// The processes of an MPI job as Ranks. Only these files use MPI.
#pragma once

#include "core/ranks.h"

namespace lambent {

/// The job in which a launcher started this process. A process may create only one object of this
/// class, which must be used by the thread that created it. The process must end through leave() or
/// end_job(): MPI treats any other end as a crash, and ends the job.
class MpiRanks final : public Ranks {
 public:
  /// Joins the other processes. If MPI fails, here and below, it prints the cause on stderr and
  /// ends the job.
  MpiRanks();
  MpiRanks(const MpiRanks&) = delete;
  MpiRanks& operator=(const MpiRanks&) = delete;

  int count() const override { return count_; }
  int own() const override { return own_; }
  /// Number of processes on this machine.
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
