// SPDX-License-Identifier: Apache-2.0
#include "bake/mpi_ranks.h"

// Skip Open MPI's C++ bindings, which were removed from the standard
#define OMPI_SKIP_MPICXX 1
#include <mpi.h>

#include <algorithm>
#include <climits>
#include <cstdlib>

namespace lambent {
namespace {

// MPI's counts are ints, so larger data is sent in pieces of this size [bytes].
constexpr std::size_t kPiece = std::size_t{1} << 30;

}  // namespace

MpiRanks::MpiRanks() {
  // Only this thread calls MPI
  int provided = 0;
  MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided);
  MPI_Comm_size(MPI_COMM_WORLD, &count_);
  MPI_Comm_rank(MPI_COMM_WORLD, &own_);
  MPI_Comm here = MPI_COMM_NULL;
  MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &here);
  MPI_Comm_size(here, &on_this_machine_);
  MPI_Comm_free(&here);
}

void MpiRanks::gather_bytes(std::span<std::byte> bytes, std::span<const std::size_t> firsts) {
  if (bytes.size() <= INT_MAX) {
    std::vector<int> counts, places;
    for (std::size_t r = 0; r + 1 < firsts.size(); ++r) {
      places.push_back(static_cast<int>(firsts[r]));
      counts.push_back(static_cast<int>(firsts[r + 1] - firsts[r]));
    }
    MPI_Allgatherv(MPI_IN_PLACE, 0, MPI_DATATYPE_NULL, bytes.data(), counts.data(), places.data(),
                   MPI_BYTE, MPI_COMM_WORLD);
    return;
  }
  for (int rank = 0; rank < count_; ++rank) {
    const auto r = static_cast<std::size_t>(rank);
    for (std::size_t first = firsts[r]; first < firsts[r + 1]; first += kPiece) {
      const auto size = static_cast<int>(std::min(kPiece, firsts[r + 1] - first));
      MPI_Bcast(bytes.data() + first, size, MPI_BYTE, rank, MPI_COMM_WORLD);
    }
  }
}

void MpiRanks::leave() {
  MPI_Finalize();
}

void MpiRanks::end_job(int status) {
  MPI_Abort(MPI_COMM_WORLD, status);
  std::abort();
}

}  // namespace lambent
