// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <exception>
#include <map>
#include <string>

#include "bench/dynamics/subject.h"

int main(int argc, char** argv) {
  using namespace lambent::dynamics;
  const std::map<std::string, void (*)()> rows = {
      {"step", measure_step},   {"cost", measure_cost},     {"curve", measure_curve},
      {"rest", measure_rest},   {"moving", measure_moving}, {"adaptive", measure_adaptive},
      {"house", measure_house}, {"growth", measure_growth}, {"scroll", measure_scroll},
  };
  if (argc < 2) {
    std::fprintf(stderr, "usage: lambent_dynamics ROW...; rows:");
    for (const auto& [name, row] : rows) std::fprintf(stderr, " %s", name.c_str());
    std::fprintf(stderr, "\n");
    return 2;
  }
  // Rows take minutes: each line is to be seen when it is there
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  try {
    for (int i = 1; i < argc; ++i) {
      const auto row = rows.find(argv[i]);
      if (row == rows.end()) {
        std::fprintf(stderr, "lambent_dynamics: no row '%s'\n", argv[i]);
        return 2;
      }
      row->second();
      std::printf("\n");
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "lambent_dynamics: %s\n", error.what());
    return 1;
  }
  return 0;
}
