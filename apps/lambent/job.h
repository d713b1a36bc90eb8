// SPDX-License-Identifier: Apache-2.0
// Subcommands that several processes, started by an MPI launcher, execute together.
#pragma once

#include <functional>
#include <string>

#include "core/ranks.h"
#include "lambent/error.h"

namespace lambent::cli {

/// The processes of a job.
struct Job {
  Ranks& ranks;
  int on_this_machine = 1;  ///< Number of processes on this one's machine.

  /// Whether this is the process that writes files and prints messages.
  bool leads() const { return ranks.own() == 0; }
};

/// Calls work(job), with the processes that were launched together with this one, or with this one
/// alone. Only the first process prints success, warnings and progress. If the work fails, all
/// processes must have agreed on it (agree); one of them prints the cause. An exception in one
/// process ends all. Fails where there are several and the program was built without MPI.
Expected<void> run_job(const std::function<Expected<void>(const Job&)>& work);

/// Returns `own` if it has failed; otherwise fails, without a cause, if that of another process
/// has. All processes must call it.
Expected<void> agree(const Job& job, const Expected<void>& own);

}  // namespace lambent::cli
