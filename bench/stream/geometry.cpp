// SPDX-License-Identifier: Apache-2.0
// The messages that a client receives first.
#include <cmath>
#include <cstdio>
#include <optional>
#include <random>
#include <vector>

#include "bench/stage.h"
#include "bench/stream/scenes.h"

namespace lambent::light_stream {

/// Root mean square of the difference between lookups of two fields, over the mean of the first, at
/// places and in directions spread over a box [%]. The light differs by up to 1 %; distances
/// differ, too.
double difference_of_lookups(const IrradianceField& field, const IrradianceField& other,
                             const Bounds& bounds) {
  constexpr std::size_t kQueries = 20'000;
  std::mt19937 random(1);
  std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
  std::normal_distribution<float> normal;
  std::vector<FieldQuery> queries(kQueries);
  for (FieldQuery& query : queries) {
    const glm::vec3 share(uniform(random), uniform(random), uniform(random));
    query.position_ws = glm::mix(bounds.min, bounds.max, share);
    query.normal_ws = glm::normalize(glm::vec3(normal(random), normal(random), normal(random)));
    query.to_viewer_ws = query.normal_ws;
  }
  std::vector<glm::vec3> one(kQueries), two(kQueries);
  field.irradiance(queries, one);
  other.irradiance(queries, two);
  double squares = 0.0, sum = 0.0;
  for (std::size_t i = 0; i < kQueries; ++i) {
    const glm::dvec3 a(one[i]), difference = glm::dvec3(two[i]) - a;
    squares += glm::dot(difference, difference);
    sum += a.x + a.y + a.z;
  }
  const auto count = static_cast<double>(3 * kQueries);
  return 100.0 * std::sqrt(squares / count) / (sum / count);
}

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
  bench::Median join_ms, receive_ms, correct_ms;
  std::size_t geometry = 0, key = 0, corrections = 0;
  double difference = 0.0;
  for (int i = 0; i < kRepetitions; ++i) {
    watch.lap();
    const auto messages = bench::value_or_throw(encoder.join());
    join_ms.add(watch.lap());
    stream::StreamedField client;
    for (const stream::LightMessage& message : messages) {
      bench::value_or_throw(client.receive(message.bytes));
    }
    receive_ms.add(watch.lap());
    geometry = 0;
    for (const stream::LightMessage& message : messages) geometry += message.bytes.size();
    key = messages.back().bytes.size();
    geometry -= key;
    watch.lap();
    corrections = 0;
    for (const stream::LightMessage& message : encoder.corrections()) {
      bench::value_or_throw(client.receive(message.bytes));
      corrections += message.bytes.size();
    }
    correct_ms.add(watch.lap());
    if (i == 0) difference = difference_of_lookups(field, *client.field(), open_bounds(world));
  }
  std::printf("### What a client gets first, atrium, with corrections\n");
  std::printf(
      "| probes | raw store [kB] | geometry [kB] | key [kB] | corrections, later [kB] | first "
      "encode, "
      "join, receive [ms of one core] | corrections [ms of one core] | lookups differ by [%%] |\n");
  std::printf("|---|---|---|---|---|---|---|---|\n");
  std::printf("| %d | %.0f | %.0f | %.0f | %.0f | %.0f, %.0f, %.0f | %.0f | %.2f |\n",
              field.probes(), 1e-3 * static_cast<double>(field.store_bytes()),
              1e-3 * static_cast<double>(geometry), 1e-3 * static_cast<double>(key),
              1e-3 * static_cast<double>(corrections), begin_ms, join_ms.value(),
              receive_ms.value(), correct_ms.value(), difference);
}

}  // namespace lambent::light_stream
