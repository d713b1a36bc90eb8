// SPDX-License-Identifier: Apache-2.0
// Which processes a launcher of MPI programs (mpirun, srun) started together with this one.
#pragma once

namespace lambent {

/// The number of processes, as the launcher tells in the environment; 1 where there was none.
int launched_processes();
/// Which of them this one is, from 0.
int launched_rank();

}  // namespace lambent
