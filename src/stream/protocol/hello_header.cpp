// SPDX-License-Identifier: Apache-2.0
#include "stream/protocol/hello_header.h"

#include <charconv>
#include <cstddef>
#include <vector>

namespace lambent::stream {
namespace {

constexpr std::string_view kDigits = "0123456789abcdef";
constexpr int kBase = 16;

}  // namespace

std::string hello_header(const Hello& hello) {
  std::string digits;
  for (const std::byte byte : write_message(hello)) {
    const auto value = std::to_integer<unsigned>(byte);
    digits += kDigits[value / kBase];
    digits += kDigits[value % kBase];
  }
  return digits;
}

Expected<Message> read_hello_header(std::string_view digits) {
  const auto none = [] { return fail("", kHelloField, "is no message"); };
  if (digits.size() % 2 != 0 || digits.size() > 2 * kMaxClientMessageBytes) return none();
  std::vector<std::byte> bytes;
  for (std::size_t i = 0; i < digits.size(); i += 2) {
    unsigned value = 0;
    const char* end = digits.data() + i + 2;
    const auto read = std::from_chars(digits.data() + i, end, value, kBase);
    if (read.ec != std::errc() || read.ptr != end) return none();
    bytes.push_back(static_cast<std::byte>(value));
  }
  return parse_message(bytes, Sender::client);
}

}  // namespace lambent::stream
