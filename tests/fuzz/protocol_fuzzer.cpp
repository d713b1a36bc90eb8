// SPDX-License-Identifier: Apache-2.0
// Feeds arbitrary bytes to the parser of messages, as either side does. What is read must come out
// as it went in, but for bits that no number has.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "stream/protocol/messages.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace lambent;
  using namespace lambent::stream;
  const auto* first = reinterpret_cast<const std::byte*>(data);
  const std::vector<std::byte> bytes(first, first + size);
  for (const Sender sender : {Sender::client, Sender::server}) {
    const Expected<Message> message = parse_message(bytes, sender);
    if (!message) {
      if (message.error().cause.empty()) std::abort();
      continue;
    }
    if (write_message(*message) != bytes) std::abort();
  }
  return 0;
}
