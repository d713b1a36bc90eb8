// SPDX-License-Identifier: Apache-2.0
#include "bench/rows.h"

#include <cstdio>
#include <exception>

namespace lambent::bench {

int run_rows(const char* program, const Rows& rows, int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "usage: %s ROW...; rows:", program);
    for (const auto& [name, row] : rows) std::fprintf(stderr, " %s", name.c_str());
    std::fprintf(stderr, "\n");
    return 2;
  }
  // Flush each line, since rows take minutes
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  try {
    for (int i = 1; i < argc; ++i) {
      const auto row = rows.find(argv[i]);
      if (row == rows.end()) {
        std::fprintf(stderr, "%s: no row '%s'\n", program, argv[i]);
        return 2;
      }
      row->second();
      std::printf("\n");
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", program, error.what());
    return 1;
  }
  return 0;
}

}  // namespace lambent::bench
