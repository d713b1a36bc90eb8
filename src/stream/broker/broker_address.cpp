// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <string_view>

#include "stream/broker/broker.h"

namespace lambent::stream {
namespace {

constexpr std::array<std::string_view, 2> kSchemes = {"nats://", "tls://"};
constexpr std::size_t kMaxNameBytes = 64;

bool may_be_in_a_name(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' ||
         c == '_';
}

}  // namespace

bool is_broker_address(const std::string& text) {
  return std::any_of(kSchemes.begin(), kSchemes.end(),
                     [&](std::string_view scheme) { return text.starts_with(scheme); });
}

Expected<BrokerAddress> parse_broker_address(const std::string& option, const std::string& text) {
  if (!is_broker_address(text)) {
    return fail(option, text, "is no broker's address: nats://HOST[:PORT]/NAME");
  }
  const std::size_t host = text.find("//") + 2, slash = text.find('/', host);
  if (slash == std::string::npos || slash == host) {
    return fail(option, text, "names no host or no stream: nats://HOST[:PORT]/NAME");
  }
  const std::string name = text.substr(slash + 1);
  if (name.empty() || name.size() > kMaxNameBytes ||
      !std::all_of(name.begin(), name.end(), may_be_in_a_name)) {
    return fail(option, text, "needs a name of 1 to 64 letters, digits, - and _ after the host");
  }
  return BrokerAddress{text.substr(0, slash), name};
}

}  // namespace lambent::stream
