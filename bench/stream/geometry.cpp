// SPDX-License-Identifier: Apache-2.0
// What a client gets first.
#include <cstdio>

#include "bench/stage.h"
#include "bench/stream/scenes.h"

namespace lambent::light_stream {

void measure_geometry() {
  constexpr int kRepetitions = 5, kUpdates = 24;
  const Scene scene = bench::open_stage("atrium");
  const World world(scene);
  IrradianceField field = bench::value_or_throw(IrradianceField::make({}, open_bounds(world)));
  for (int i = 0; i < kUpdates; ++i) field.update(world);
  stream::LightEncoder encoder = bench::value_or_throw(stream::LightEncoder::create());
  ProcessorTime watch;
  bench::value_or_throw(encoder.encode(field));
  const double begin_ms = watch.lap();
  bench::Median join_ms, receive_ms;
  std::size_t geometry = 0, key = 0;
  for (int i = 0; i < kRepetitions; ++i) {
    watch.lap();
    const auto messages = bench::value_or_throw(encoder.join());
    join_ms.add(watch.lap());
    stream::StreamedField client;
    for (const stream::LightMessage& message : messages) {
      bench::value_or_throw(client.receive(message.bytes));
    }
    receive_ms.add(watch.lap());
    geometry = messages.front().bytes.size();
    key = messages.back().bytes.size();
  }
  std::printf("### What a client gets first, atrium, with corrections\n");
  std::printf(
      "| probes | raw store [kB] | geometry [kB] | key [kB] | first encode, join, receive "
      "[ms of one core] |\n");
  std::printf("|---|---|---|---|---|\n");
  std::printf("| %d | %.0f | %.0f | %.0f | %.0f, %.0f, %.0f |\n", field.probes(),
              1e-3 * static_cast<double>(field.store_bytes()), 1e-3 * static_cast<double>(geometry),
              1e-3 * static_cast<double>(key), begin_ms, join_ms.value(), receive_ms.value());
}

}  // namespace lambent::light_stream
