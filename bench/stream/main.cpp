// SPDX-License-Identifier: Apache-2.0
#include "bench/rows.h"
#include "bench/stream/scenes.h"

int main(int argc, char** argv) {
  using namespace lambent::light_stream;
  return lambent::bench::run_rows("lambent_light_stream",
                                  {{"rates", measure_rates},
                                   {"quality", measure_quality},
                                   {"textures", measure_textures},
                                   {"regions", measure_regions},
                                   {"geometry", measure_geometry},
                                   {"pictures", measure_pictures},
                                   {"record", record_stream}},
                                  argc, argv);
}
