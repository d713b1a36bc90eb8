// SPDX-License-Identifier: Apache-2.0
#include "bench/dynamics/subject.h"
#include "bench/rows.h"

int main(int argc, char** argv) {
  using namespace lambent::dynamics;
  return lambent::bench::run_rows("lambent_dynamics",
                                  {{"step", measure_step},
                                   {"cost", measure_cost},
                                   {"curve", measure_curve},
                                   {"rest", measure_rest},
                                   {"moving", measure_moving},
                                   {"adaptive", measure_adaptive},
                                   {"house", measure_house},
                                   {"growth", measure_growth},
                                   {"scroll", measure_scroll}},
                                  argc, argv);
}
