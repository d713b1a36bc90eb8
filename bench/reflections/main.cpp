// SPDX-License-Identifier: Apache-2.0
#include "bench/reflections/subject.h"
#include "bench/rows.h"

int main(int argc, char** argv) {
  using namespace lambent::reflections;
  return lambent::bench::run_rows("lambent_reflections",
                                  {{"spheres", measure_spheres},
                                   {"ramp", measure_ramps},
                                   {"cells", measure_cells},
                                   {"moved", measure_moved}},
                                  argc, argv);
}
