// SPDX-License-Identifier: Apache-2.0
#include <benchmark/benchmark.h>

#include <cstdio>
#include <exception>

#include "bench/workload.h"

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  try {
    const lambent::bench::Workload& work = lambent::bench::workload();
    benchmark::AddCustomContext("scene", work.name);
    benchmark::AddCustomContext("probes", std::to_string(work.field.probes()));
    benchmark::AddCustomContext("rays_per_probe",
                                std::to_string(work.field.settings().rays_per_probe));
    benchmark::RunSpecifiedBenchmarks();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "lambent_bench: %s\n", error.what());
    return 2;
  }
  return 0;
}
