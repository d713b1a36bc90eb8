// SPDX-License-Identifier: Apache-2.0
#include "lambent/job.h"

#include <algorithm>
#include <exception>
#include <new>
#include <vector>

#include "bake/launch.h"
#include "lambent/console.h"
#include "lambent/step.h"

#if LAMBENT_MPI
#include "bake/mpi_ranks.h"
#endif

namespace lambent::cli {
namespace {

#if LAMBENT_MPI

// Exit status for the launcher when a process ends all others (docs/cli.md).
constexpr int kJobFailed = 1;

[[noreturn]] void end_job(const MpiRanks& ranks, const std::string& why) {
  tell_error("rank " + std::to_string(ranks.own()) + ": " + why);
  MpiRanks::end_job(kJobFailed);
}

/// Only the first process that has failed with a cause of its own prints it. It does so now, since
/// the launcher ends the others once the first one has ended.
void tell_why_once(Ranks& ranks, const Expected<void>& done) {
  const bool of_itself = !done && !done.error().cause.empty();
  const std::vector<std::uint8_t> failed = gather_each<std::uint8_t>(ranks, of_itself ? 1 : 0);
  const auto first = std::find(failed.begin(), failed.end(), std::uint8_t{1}) - failed.begin();
  if (first == ranks.own()) tell_error(done.error().message());
  set_mute();
}

Expected<void> run_together(const std::function<Expected<void>(const Job&)>& work) {
  MpiRanks ranks;
  if (ranks.count() != launched_processes()) {
    if (launched_rank() != 0) set_mute();
    ranks.leave();
    return fail("", "MPI",
                "the processes do not find each other: the launcher is of another MPI than this "
                "program was built with");
  }
  if (ranks.own() != 0) set_quiet(true);
  try {
    const Expected<void> done = work({ranks, ranks.on_this_machine()});
    tell_why_once(ranks, done);
    ranks.leave();
    return done;
  } catch (const std::bad_alloc&) {
    end_job(ranks, std::string("memory ran out while ") + current_step());
  } catch (const std::exception& error) {
    end_job(ranks, error.what());
  }
}

#else

Expected<void> run_together(const std::function<Expected<void>(const Job&)>&) {
  if (launched_rank() != 0) set_mute();
  return fail("", "MPI",
              "this program was built without it (LAMBENT_MPI), and " +
                  std::to_string(launched_processes()) + " processes were launched",
              Error::Kind::failed);
}

#endif

}  // namespace

Expected<void> run_job(const std::function<Expected<void>(const Job&)>& work) {
  if (launched_processes() > 1) return run_together(work);
  return work({one_rank()});
}

Expected<void> agree(const Job& job, const Expected<void>& own) {
  enum class State : std::uint8_t { fine, bad_input, failed };
  State state = State::fine;
  if (!own) state = own.error().kind == Error::Kind::bad_input ? State::bad_input : State::failed;
  const std::vector<State> all = gather_each(job.ranks, state);
  if (!own) return own;
  const auto first = std::find_if(all.begin(), all.end(), [](State s) { return s != State::fine; });
  if (first == all.end()) return {};
  // Without a cause, which the process that failed prints
  return fail("", "", "",
              *first == State::bad_input ? Error::Kind::bad_input : Error::Kind::failed);
}

}  // namespace lambent::cli
