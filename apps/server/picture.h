// GET /picture: a client's view at full quality, to be saved.
#pragma once

#include "server/answer.h"
#include "server/connection.h"
#include "server/target.h"

namespace motes::server {

/// Gives up where the client on `socket` goes away.
asio::awaitable<Answer> make_picture(const Target& target, asio::ip::tcp::socket& socket,
                                     Site& site);

}  // namespace motes::server
