// SPDX-License-Identifier: Apache-2.0
// usage: browser_write_stream FILE
// Writes the light of a box in cascades, with corrections, while its lamp swells and fades and the
// viewer walks, so that all kinds of messages occur; and what the library decodes of it.
#include <array>
#include <cstdio>
#include <exception>
#include <stdexcept>

#include "bench/stream/recording.h"
#include "support/light_box.h"

namespace lambent {
namespace {

constexpr int kUpdates = 24, kLateJoin = 16;

void write(const char* path) {
  FieldSettings settings = test::Box::small_field();
  settings.cascades = 2;
  settings.corrections = true;
  test::Box box(settings);
  stream::LightEncoder encoder = test::made_encoder();
  light_stream::Recording recording;
  std::array<int, 4> kinds{};
  const auto add = [&](const test::Messages& messages) {
    recording.add(messages);
    for (const stream::LightMessage& message : messages) ++kinds.at(static_cast<int>(message.kind));
  };
  for (int update = 0; update < kUpdates; ++update) {
    add(test::encoded(encoder, box));
    // As to a client that has lost something
    if (update == kLateJoin) add(encoder.join().value());
    box.advance();
    if (update % 4 == 3) box.look_from({0.4f * static_cast<float>(update), 2.0f, 2.0f});
  }
  for (int kind = 1; kind < 4; ++kind) {
    if (kinds.at(kind) == 0) throw std::runtime_error("a kind of message does not occur");
  }
  recording.write(path);
  std::printf("%d messages of geometry, %d keys, %d deltas\n", kinds[1], kinds[2], kinds[3]);
}

}  // namespace
}  // namespace lambent

int main(int argc, char** argv) try {
  if (argc != 2) return std::fprintf(stderr, "usage: browser_write_stream FILE\n"), 2;
  lambent::write(argv[1]);
  return 0;
} catch (const std::exception& error) {
  return std::fprintf(stderr, "browser_write_stream: %s\n", error.what()), 1;
}
