// SPDX-License-Identifier: Apache-2.0
#include "stream/broker/broker.h"

namespace lambent::stream {
namespace {

tl::unexpected<Error> no_broker(const BrokerAddress& address) {
  return fail("", address.url, "brokers are not in this build (LAMBENT_STREAM_NATS)");
}

}  // namespace

bool has_broker() {
  return false;
}

Expected<void> BrokerPublisher::check(const BrokerAddress& address) {
  return no_broker(address);
}

Expected<std::unique_ptr<BrokerPublisher>> BrokerPublisher::open(
    const BrokerAddress& address, Hub& /*hub*/, std::function<void(const std::string&)> /*log*/) {
  return no_broker(address);
}

Expected<Joined> join_through_broker(const ConnectSettings& settings, const Hello& /*hello*/) {
  return no_broker(settings.broker);
}

}  // namespace lambent::stream
