// SPDX-License-Identifier: Apache-2.0
// Included only by files that use Boost.Beast.
#pragma once

#include "stream/server/connections.h"
#include "stream/transport/byte_stream.h"

namespace lambent::stream {

/// Handles a connection's first request: answers it, or opens a WebSocket. Returns at once; what it
/// begins lives until the connection ends.
void answer_connection(ConnectionContext& context, ByteStream&& stream);

}  // namespace lambent::stream
