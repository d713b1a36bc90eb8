// SPDX-License-Identifier: Apache-2.0
// Records a stream for measurements of other decoders.
#include <cstdio>

#include "bench/stage.h"
#include "bench/stream/recording.h"
#include "bench/stream/scenes.h"

namespace lambent::light_stream {

void record_stream() {
  constexpr int kRecordedStates = 60;
  constexpr const char* kFile = "atrium.stream";
  MovingAtrium atrium(fast_sun(), kRealTimeRays);
  stream::LightEncoder encoder = bench::value_or_throw(stream::LightEncoder::create());
  Recording recording;
  for (int state = 0; state <= kRecordedStates; ++state) {
    recording.add(bench::value_or_throw(encoder.encode(atrium.field())));
    atrium.advance();
  }
  recording.write(kFile);
  std::printf("wrote %s, %d states (node bench/stream/decode.mjs)\n", kFile, kRecordedStates);
}

}  // namespace lambent::light_stream
