// POST /upload: a file that was dropped on the page.
#pragma once

#include "server/answer.h"
#include "server/connection.h"
#include "server/target.h"

namespace motes::server {

/// Writes the request's body to a file of its own, as it comes.
asio::awaitable<Answer> take_upload(const Target& target,
                                    http::request_parser<http::empty_body>& header,
                                    beast::tcp_stream& stream, beast::flat_buffer& buffer,
                                    Site& site);

}  // namespace motes::server
