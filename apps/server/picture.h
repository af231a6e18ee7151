// GET /picture: a client's view at full quality, to be saved.
#pragma once

#include "server/answer.h"
#include "server/connection.h"
#include "server/target.h"

namespace motes::server {

asio::awaitable<Answer> make_picture(const Target& target, Site& site);

}  // namespace motes::server
