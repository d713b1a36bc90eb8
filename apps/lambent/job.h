// SPDX-License-Identifier: Apache-2.0
// Subcommands that several processes, started by an MPI launcher, carry out together.
#pragma once

#include <functional>
#include <string>

#include "core/ranks.h"
#include "lambent/error.h"

namespace lambent::cli {

/// The processes of a job.
struct Job {
  Ranks& ranks;
  int on_this_machine = 1;  ///< How many of them share this one's memory.

  /// Whether this is the process that writes files and tells how things go.
  bool leads() const { return ranks.own() == 0; }
};

/// Calls work(job), with the processes that were launched together with this one, or with this one
/// alone. Only the first of them tells of success, warnings and progress. Where the work fails, all
/// processes must have agreed on it (agree); one of them says why. An exception in one of them
/// ends them all. Fails where there are several and the program was built without MPI.
Expected<void> run_job(const std::function<Expected<void>(const Job&)>& work);

/// Returns `own` where it has failed; else fails, without a cause, where that of another process
/// has. All of them call it.
Expected<void> agree(const Job& job, const Expected<void>& own);

}  // namespace lambent::cli
