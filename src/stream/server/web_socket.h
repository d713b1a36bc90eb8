// SPDX-License-Identifier: Apache-2.0
// A client's WebSocket. Included only by files that use Boost.Beast.
#pragma once

#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/message.hpp>

#include "stream/server/connections.h"
#include "stream/transport/byte_stream.h"

namespace lambent::stream {

using WebSocketRequest = boost::beast::http::request<boost::beast::http::empty_body>;

/// Opens the WebSocket that a client asks for over `stream`. It lives until its connection ends.
void accept_web_socket(ConnectionContext& context, ByteStream&& stream, ConnectionCount&& count,
                       const WebSocketRequest& request);

}  // namespace lambent::stream
