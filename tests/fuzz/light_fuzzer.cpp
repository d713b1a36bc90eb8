// SPDX-License-Identifier: Apache-2.0
// Feeds arbitrary bytes to a client of a light stream: as they are, and as the body of a message
// whose header and checksum are right, which no fuzzer would find.
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include "support/light_fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string wrong =
      lambent::test::feed_light_decoder({reinterpret_cast<const std::byte*>(data), size});
  if (!wrong.empty()) {
    std::fprintf(stderr, "the client %s\n", wrong.c_str());
    std::abort();
  }
  return 0;
}
