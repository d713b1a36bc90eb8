// SPDX-License-Identifier: Apache-2.0
// The processes that a launcher of MPI programs (mpirun, srun) started together with this one.
#pragma once

namespace lambent {

/// The number of processes, from the launcher's environment variables; 1 without a launcher.
int launched_processes();
/// The rank of this process, from 0.
int launched_rank();

}  // namespace lambent
