// SPDX-License-Identifier: Apache-2.0
#include "bake/launch.h"

#include <algorithm>
#include <cstdlib>

namespace lambent {
namespace {

/// A launcher's environment variables with the number of processes, and with the rank of this one.
struct LauncherVariables {
  const char* count;
  const char* rank;
};

/// Open MPI's mpirun; launchers with PMI, such as MPICH's mpiexec; srun, with PMIx for Open MPI.
/// Slurm sets its own variables in the script of a job, too, but PMIX_RANK only in processes that
/// srun starts for MPI.
constexpr LauncherVariables kLaunchers[] = {{"OMPI_COMM_WORLD_SIZE", "OMPI_COMM_WORLD_RANK"},
                                            {"PMI_SIZE", "PMI_RANK"},
                                            {"SLURM_STEP_NUM_TASKS", "PMIX_RANK"}};

struct Launch {
  int processes = 1;
  int rank = 0;
};

Launch launch() {
  for (const LauncherVariables& names : kLaunchers) {
    const char* count = std::getenv(names.count);
    const char* rank = std::getenv(names.rank);
    if (count == nullptr || rank == nullptr) continue;
    return {std::max(1, std::atoi(count)), std::max(0, std::atoi(rank))};
  }
  return {};
}

}  // namespace

int launched_processes() {
  return launch().processes;
}

int launched_rank() {
  return launch().rank;
}

}  // namespace lambent
