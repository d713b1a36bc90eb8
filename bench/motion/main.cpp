// SPDX-License-Identifier: Apache-2.0
#include "bench/motion/sequence.h"
#include "bench/rows.h"

int main(int argc, char** argv) {
  using namespace lambent::motion;
  return lambent::bench::run_rows(
      "lambent_motion",
      {{"walk", measure_walk}, {"still", measure_still}, {"ghosts", measure_ghosts}}, argc, argv);
}
