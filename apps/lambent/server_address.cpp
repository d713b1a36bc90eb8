// SPDX-License-Identifier: Apache-2.0
#include "lambent/server_address.h"

#include <fstream>

#include "lambent/validators.h"
#include "stream/broker/broker.h"

namespace lambent::cli {

Expected<void> parse_server_address(const std::string& option, const std::string& address,
                                    stream::ConnectSettings& to) {
  if (stream::is_broker_address(address)) {
    auto broker = stream::parse_broker_address(option, address);
    if (!broker) return tl::unexpected(broker.error());
    if (!stream::has_broker()) {
      return fail(option, address, "brokers are not in this build (LAMBENT_STREAM_NATS)");
    }
    to.broker = std::move(*broker);
    return {};
  }
  std::string text = address;
  const std::string https = "https://", http = "http://";
  if (text.starts_with(https)) {
    to.tls = true;
    text = text.substr(https.size());
  } else if (text.starts_with(http)) {
    text = text.substr(http.size());
  }
  if (text.find("://") != std::string::npos) {
    return fail(option, address, "begins with neither http:// nor https:// nor nats://");
  }
  if (text.ends_with("/")) text.pop_back();
  if (text.find('/') != std::string::npos) {
    return fail(option, address, "has a path: name the host and its port alone");
  }
  const std::size_t colon = text.rfind(':');
  // Colons within brackets belong to an IPv6 address
  if (colon != std::string::npos && text.find(']', colon) == std::string::npos) {
    const auto port = finite_number(text.substr(colon + 1));
    const auto number = static_cast<std::uint16_t>(port.value_or(0.0));
    if (!port || static_cast<double>(number) != *port || number == 0) {
      return fail(option, address, "has no port that can be: 1 to 65535");
    }
    to.port = number;
    text = text.substr(0, colon);
  }
  if (text.starts_with("[") && text.ends_with("]")) text = text.substr(1, text.size() - 2);
  if (text.empty()) return fail(option, address, "names no host");
  to.host = text;
  return {};
}

Expected<std::string> read_token(const std::string& path) {
  std::string token;
  if (path.empty()) return token;
  std::ifstream file(path);
  if (!file) return fail(path, "", "no such file, or none that may be read");
  if (!(file >> token) || token.size() > stream::kMaxTokenBytes) {
    return fail(path, "", "holds no token");
  }
  return token;
}

}  // namespace lambent::cli
